// Compares ray_generator with its reference model under random pauses: each pixel comes once.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <tuple>
#include <utility>

#include "Vray_generator.h"
#include "sim/model.h"
#include "sim/test/ray_core/pixel_grid.h"

namespace raygate {
namespace {

constexpr std::uint32_t kSeed = 20261122;

TEST(RayGeneratorTest, EqualsItsReference) {
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  Model<Vray_generator> model;
  std::mt19937 random(kSeed);
  model->start_i = model->stop_i = 0;
  model->ready_i = 0;
  model.reset();
  long rays = 0, zeros = 0, infinities = 0;
  for (int frame = 0; frame < 60; ++frame) {
    // Ordinary pictures, and some with numbers of all magnitudes.
    std::uniform_real_distribution<float> number(-1.0f, 1.0f);
    const auto vector = [&](int spread) {
      glm::vec3 vector;
      for (int k = 0; k < 3; ++k) {
        vector[k] = std::ldexp(number(random), -static_cast<int>(random() % spread));
      }
      return vector;
    };
    const int spread = frame % 3 == 0 ? 140 : 8;
    PixelGrid grid{vector(spread), 0.01f * vector(spread), 0.01f * vector(spread)};
    for (glm::vec3* vector : {&grid.first, &grid.right, &grid.down}) {
      if (frame % 5 == 0) vector->x = 0.0f;
      if (frame % 6 == 0) vector->z *= 0x1p-122f;
      if (frame % 12 == 0) vector->y *= 0x1p20f;
    }
    if (frame == 9) grid.first.x = std::numeric_limits<float>::infinity();
    const bool far = frame % 4 == 0;
    const unsigned x = far ? 65'000 + random() % 500 : random() % 3;
    const unsigned y = frame % 8 == 1 ? 0 : random() % 25'000;
    unsigned width = frame == 7 ? 0 : 1 + random() % 30, height = 1 + random() % 30;
    // Widths and heights of more than 15 bits.
    if (frame == 21) std::tie(width, height) = std::pair(40'000, 2);
    if (frame == 22) std::tie(width, height) = std::pair(1, 40'000);
    std::memcpy(&model->first_i, &grid.first, sizeof grid.first);
    std::memcpy(&model->right_i, &grid.right, sizeof grid.right);
    std::memcpy(&model->down_i, &grid.down, sizeof grid.down);
    model->x_i = x;
    model->y_i = y;
    model->width_i = width;
    model->height_i = height;
    model->start_i = 1;
    model.clock();
    model->start_i = 0;
    const unsigned ready_of_8 = 1 + random() % 8;
    unsigned given = 0;
    for (int clock = 0; model->busy_o != 0; ++clock) {
      ASSERT_LT(clock, 20'000 + 16 * static_cast<int>(width * height));
      model->ready_i = random() % 8 < ready_of_8;
      model->start_i = random() % 8 == 0;  // ignored while busy
      model->x_i = random() % 65'536;
      model->width_i = random() % 16;
      model.eval();
      if ((model->valid_o & model->ready_i) != 0) {
        ASSERT_LT(given, width * height);
        const unsigned column = x + given % width, row = y + given / width;
        ASSERT_EQ(model->pixel_o, row << 16 | column);
        const glm::vec3 expected =
            grid.direction(static_cast<std::uint16_t>(column), static_cast<std::uint16_t>(row));
        for (int k = 0; k < 3; ++k) {
          ASSERT_EQ(model->direction_o[k], std::bit_cast<std::uint32_t>(expected[k]))
              << "frame " << frame << ", pixel " << column << ", " << row;
          zeros += expected[k] == 0.0f;
          infinities += std::isinf(expected[k]);
        }
        ++given;
      }
      model.clock();
    }
    model->start_i = 0;
    ASSERT_EQ(given, width * height);
    for (int idle = 0; idle < 4; ++idle) {
      model.clock();
      ASSERT_EQ(model->busy_o | model->valid_o, 0);
    }
    rays += given;
  }
  EXPECT_GT(rays, 5'000);
  EXPECT_GT(zeros, 10);
  EXPECT_GT(infinities, 0) << "refused by the core, so not to be scaled";
}

/// After resets in mid-run, no ray of the old frame follows, and the next frame is complete.
TEST(RayGeneratorTest, ResetsInMidRunLeaveNothing) {
  Model<Vray_generator> model;
  std::mt19937 random(kSeed);
  model->start_i = model->stop_i = model->x_i = model->y_i = 0;
  const PixelGrid grid{{-1.0f, 1.0f, -2.0f}, {0.01f, 0.0f, 0.0f}, {0.0f, -0.01f, 0.0f}};
  std::memcpy(&model->first_i, &grid.first, sizeof grid.first);
  std::memcpy(&model->right_i, &grid.right, sizeof grid.right);
  std::memcpy(&model->down_i, &grid.down, sizeof grid.down);
  int broken_off = 0;
  for (int round = 0; round < 100; ++round) {
    model.reset();
    ASSERT_EQ(model->busy_o | model->valid_o, 0);
    model->width_i = 1 + random() % 8;
    model->height_i = 1 + random() % 8;
    model->start_i = 1;
    model.clock();
    model->start_i = 0;
    const bool whole = round % 2 != 0;
    const unsigned end = whole ? 2'000 : random() % 60;
    unsigned given = 0;
    for (unsigned clock = 0; clock < end && model->busy_o != 0; ++clock) {
      model->ready_i = random() % 2;
      model.eval();
      if ((model->valid_o & model->ready_i) != 0) {
        const unsigned column = given % model->width_i, row = given / model->width_i;
        ASSERT_EQ(model->pixel_o, row << 16 | column);
        ASSERT_EQ(model->direction_o[0],
                  std::bit_cast<std::uint32_t>(grid.direction(static_cast<std::uint16_t>(column),
                                                              static_cast<std::uint16_t>(row))
                                                   .x));
        ++given;
      }
      model.clock();
    }
    broken_off += model->busy_o;
    if (whole) {
      ASSERT_EQ(given, model->width_i * model->height_i);
    }
  }
  EXPECT_GT(broken_off, 20);
}

/// One ray comes per clock if the user is always ready.
TEST(RayGeneratorTest, GivesARayAClock) {
  Model<Vray_generator> model;
  model->start_i = model->stop_i = 0;
  model->ready_i = 1;
  model.reset();
  const PixelGrid grid{{-1.0f, 1.0f, -2.0f}, {0.01f, 0.0f, 0.0f}, {0.0f, -0.01f, 0.0f}};
  std::memcpy(&model->first_i, &grid.first, sizeof grid.first);
  std::memcpy(&model->right_i, &grid.right, sizeof grid.right);
  std::memcpy(&model->down_i, &grid.down, sizeof grid.down);
  model->x_i = model->y_i = 0;
  model->width_i = model->height_i = 32;
  model->start_i = 1;
  model.clock();
  model->start_i = 0;
  int clocks = 0;
  for (; model->busy_o != 0; ++clocks) model.clock();
  EXPECT_LT(clocks, 32 * 32 + 16);
}

}  // namespace
}  // namespace raygate
