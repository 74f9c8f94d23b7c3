#include "host/scene/view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "host/scene/camera.h"

namespace raygate {
namespace {

constexpr glm::dvec3 kX(1, 0, 0), kY(0, 1, 0), kZ(0, 0, 1);

/// Adds a box, its faces outwards, or inwards; without those whose number is in `without`
/// (-x, +x, -y, +y, -z, +z).
void add_box(Scene& scene, const glm::vec3& low, const glm::vec3& high, bool inwards = false,
             int without = -1) {
  const auto first = static_cast<std::uint32_t>(scene.positions.size());
  for (int corner = 0; corner < 8; ++corner) {
    scene.positions.emplace_back(corner & 1 ? high.x : low.x, corner & 2 ? high.y : low.y,
                                 corner & 4 ? high.z : low.z);
  }
  constexpr std::uint32_t kSides[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                          {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  for (int side = 0; side < 6; ++side) {
    if (side == without) continue;
    const auto& [a, b, c, d] = kSides[side];
    for (auto [p, q, r] : {std::array{a, b, c}, std::array{a, c, d}}) {
      if (inwards) std::swap(q, r);
      scene.triangles.emplace_back().vertices = {first + p, first + q, first + r};
    }
  }
}

Scene box(const glm::vec3& low, const glm::vec3& high) {
  Scene scene;
  add_box(scene, low, high);
  return scene;
}

glm::dvec3 towards_eye(const Scene& scene, const View& view) {
  const CameraSetting camera = frame_scene(scene, 1.5, 35, view);
  return glm::normalize(camera.eye - camera.target);
}

void expect_near(const glm::dvec3& a, const glm::dvec3& b) {
  EXPECT_LT(glm::length(a - b), 1e-12) << a.x << " " << a.y << " " << a.z;
}

TEST(View, StandsWhereItsAnglesSay) {
  const Scene scene = box({1, 2, 3}, {2, 5, 7});
  expect_near(towards_eye(scene, {0, 0, kY}), kZ);
  expect_near(towards_eye(scene, {90, 0, kY}), kX);
  expect_near(towards_eye(scene, {-90, 0, kY}), -kX);
  expect_near(towards_eye(scene, {180, 0, kY}), -kZ);
  expect_near(towards_eye(scene, {33, 90, kY}), kY);
  expect_near(towards_eye(scene, {0, -90, kY}), -kY);
  expect_near(towards_eye(scene, {0, 0, kZ}), -kY);
  expect_near(towards_eye(scene, {90, 0, kZ}), kX);
  expect_near(towards_eye(scene, {0, 90, kZ}), kZ);
  expect_near(towards_eye(scene, {0, 30, 1e-200 * kZ}), {0, -std::sqrt(0.75), 0.5});
  // Straight from above the front is below in the picture.
  expect_near(*frame_scene(scene, 1, 35, {0, 90, kY}).up, -kZ);
  expect_near(*frame_scene(scene, 1, 35, {0, 90, kZ}).up, kY);
}

/// How far from the middle of the picture the points of a box are seen: 1 at its edges.
double reach(const Camera& camera, double aspect, const glm::dvec3& low, const glm::dvec3& high) {
  double result = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 point(corner & 1 ? high.x : low.x, corner & 2 ? high.y : low.y,
                           corner & 4 ? high.z : low.z);
    const glm::dvec3 way = point - glm::dvec3(camera.eye());
    const double half = glm::dot(way, camera.forward()) * camera.half_height();
    EXPECT_GT(half, 0.0);
    result = std::max({result, std::abs(glm::dot(way, camera.right())) / (half * aspect),
                       std::abs(glm::dot(way, camera.up())) / half});
  }
  return result;
}

TEST(View, FillsThePictureFromAllSides) {
  const std::uint64_t seed = 20240811;
  RecordProperty("seed", std::to_string(seed));
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int round = 0; round < 300; ++round) {
    const glm::dvec3 low(uniform(random), uniform(random), uniform(random));
    const glm::dvec3 high =
        low + glm::exp(glm::dvec3(uniform(random), uniform(random), uniform(random)));
    const Scene scene = box(low, high);
    const View view = {360 * uniform(random), 90 * uniform(random),
                       round % 2 == 0   ? kY
                       : round % 4 == 1 ? kZ
                                        : -kX};
    const double aspect = std::exp(uniform(random));
    const Camera camera = Camera::look_at(
        frame_scene(scene, aspect, 35, view, round % 3 == 0 ? FrameFit::kBox : FrameFit::kVertices),
        aspect);
    EXPECT_NEAR(reach(camera, aspect, low, high), 0.96, 1e-4) << "round " << round;
  }
}

TEST(FirstView, ShowsThreeSidesOfAModel) {
  const View view = default_view(box({0, 0, 0}, {1, 2, 3}), kZ);
  EXPECT_EQ(view.azimuth, kDefaultAzimuth);
  EXPECT_EQ(view.elevation, kDefaultElevation);
  EXPECT_EQ(view.up, kZ);
}

TEST(FirstView, LooksIntoARoomFromItsFront) {
  Scene room;
  add_box(room, {0, 0, 0}, {1, 1, 1}, true, 5);
  EXPECT_EQ(default_view(room, kY).azimuth, 0.0);
  EXPECT_EQ(default_view(room, kY).elevation, 3.0);
  Scene open_crate;
  add_box(open_crate, {0, 0, 0}, {1, 1, 1}, false, 3);
  EXPECT_EQ(default_view(open_crate, kY).azimuth, kDefaultAzimuth);
}

// Whatever way a flat model is turned, some of it is seen: the default view shows a fifth of it, or
// another side does.
TEST(FirstView, DoesNotLookAlongAFlatModel) {
  std::mt19937_64 random(20261125);
  std::normal_distribution<double> normal;
  int turned = 0;
  for (int round = 0; round < 1000; ++round) {
    const glm::dvec3 across =
        glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
    const glm::dvec3 u = glm::normalize(glm::cross(across, glm::dvec3(0.6, 0.48, 0.64)));
    Scene scene;
    for (const glm::dvec3& corner : {glm::dvec3(0.0), u, glm::cross(across, u)}) {
      scene.positions.emplace_back(corner);
    }
    scene.triangles.emplace_back().vertices = {0, 1, 2};
    const View view = default_view(scene, kY);
    turned += view.azimuth != kDefaultAzimuth;
    EXPECT_EQ(view.elevation, kDefaultElevation);
    EXPECT_GT(std::abs(glm::dot(towards_eye(scene, view), across)), 0.19) << "round " << round;
  }
  EXPECT_GT(turned, 150);
  EXPECT_LT(turned, 250);
}

TEST(GuessedUp, IsWhereTheSceneDoesNotStand) {
  EXPECT_EQ(guess_up_axis(box({0, 0, 0}, {1, 1, 1})), kY) << "nothing speaks for z";
  Scene table;  // a broad foot and a column on it
  add_box(table, {0, 0, 0}, {1, 1, 0.1});
  add_box(table, {0.4f, 0.4f, 0.1f}, {0.6f, 0.6f, 1});
  EXPECT_EQ(guess_up_axis(table), kZ);
  for (glm::vec3& position : table.positions) std::swap(position.y, position.z);
  EXPECT_EQ(guess_up_axis(table), kY);
  table.up = kZ;
  EXPECT_EQ(guess_up_axis(table), kZ) << "the format has the last word";
}

/// y becomes z, in the same handedness.
Scene lain_down(Scene scene) {
  for (glm::vec3& position : scene.positions) position = {position.x, -position.z, position.y};
  return scene;
}

TEST(GuessedUp, IsWhereTheSceneWouldNotFallOver) {
  Scene motorcycle;  // y is up; two wheels, nothing flat below; a handlebar on one side
  add_box(motorcycle, {0, 0.4f, -0.1f}, {2, 1, 0.1f});
  add_box(motorcycle, {0, 0, -0.08f}, {0.4f, 0.4f, 0.08f});
  add_box(motorcycle, {1.6f, 0, -0.08f}, {2, 0.4f, 0.08f});
  add_box(motorcycle, {0.3f, 0.9f, -0.4f}, {0.4f, 1, 0.4f});
  Scene animal;  // y is up; z ends in its nose and in its tail
  add_box(animal, {-0.3f, 0.5f, 0}, {0.3f, 1, 2});
  for (const float x : {-0.3f, 0.2f}) {
    for (const float z : {0.0f, 1.9f}) add_box(animal, {x, 0, z}, {x + 0.1f, 0.5f, z + 0.1f});
  }
  add_box(animal, {-0.05f, 1.4f, -0.4f}, {0.05f, 1.5f, 0.2f});
  add_box(animal, {-0.05f, 0.9f, 2}, {0.05f, 1, 2.5f});
  const Scene plate = box({0, 0, 0}, {200, 3, 200});
  for (const Scene& upright : {motorcycle, animal, plate}) {
    for (const bool is_usually_z_up : {false, true}) {
      Scene scene = upright;
      scene.is_usually_z_up = is_usually_z_up;
      EXPECT_EQ(guess_up_axis(scene), kY);
      scene = lain_down(scene);
      EXPECT_EQ(guess_up_axis(scene), kZ);
    }
  }
}

TEST(GuessedUp, IsAsUsualOfWhatSaysNothing) {
  Scene square;
  square.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  square.triangles.emplace_back().vertices = {0, 1, 2};
  for (Scene scene : {square, lain_down(square), box({0, 0, 0}, {1, 1, 1})}) {
    EXPECT_EQ(guess_up_axis(scene), kY);
    scene.is_usually_z_up = true;
    EXPECT_EQ(guess_up_axis(scene), kZ);
  }
}

}  // namespace
}  // namespace raygate
