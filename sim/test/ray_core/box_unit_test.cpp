// Compares box_unit with its reference model, bit for bit, with a node in every clock.
#include <gtest/gtest.h>

#include <bit>
#include <deque>

#include "Vbox_unit.h"
#include "host/intersect/core/test/box_cases.h"
#include "sim/model.h"

namespace raygate {
namespace {

constexpr std::size_t kLatency = 21;  // ray_core_pkg::BoxLatency

/// Returns `width` bits of a port, from bit `first`.
template <class Port>
std::uint32_t bits(const Port& port, unsigned first, unsigned width) {
  std::uint64_t two = port[first / 32];
  if (first % 32 + width > 32) two |= std::uint64_t{port[first / 32 + 1]} << 32;
  return static_cast<std::uint32_t>(two >> first % 32 & ((std::uint64_t{1} << width) - 1));
}

/// Returns enter * 2^(exponent - 127 - 12) in the unit's format: the upper 19 bits of the magnitude
/// of a binary32 number, or all ones if the exponent field would exceed 255.
std::uint32_t ordered_word(std::uint32_t enter, std::uint32_t exponent) {
  if (enter == 0) return 0;
  const auto top = static_cast<std::uint32_t>(std::bit_width(enter)) - 1;
  const std::uint32_t field = exponent - 12 + top, fraction = (enter << (11 - top)) & 0x7FF;
  return field > 255 ? 0x7FFFF : field << 11 | fraction;
}

TEST(BoxUnitTest, EqualsItsReference) {
  constexpr std::uint32_t kSeed = 20261123;
  BoxCases cases(kSeed);
  Model<Vbox_unit> model;
  model.reset();
  std::deque<BoxCase> taken;  // the latest first
  int entered = 0;
  BoxRay before;  // the previous node's ray: the unit takes a ray one clock after its node
  for (int clock = 0; clock < 400'000; ++clock) {
    const BoxCase box = cases.next();
    const BoxRay ray = box.read();
    const MemoryLine line = box.node.line();
    std::memcpy(&model->node_i, &line, sizeof line);
    model->node_i[16] = 2;  // ray_core_pkg::node_line_t: valid, no error
    model->ctx_i = clock % 64;
    std::memcpy(&model->origin_i, &before.origin, sizeof ray.origin);
    std::memcpy(&model->inverse_i, &before.inverse, sizeof ray.inverse);
    model->t_max_i = std::bit_cast<std::uint32_t>(before.t_max);
    before = ray;
    taken.push_front(box);
    model.clock();
    if (taken.size() < kLatency) continue;
    taken.resize(kLatency);
    const BoxGroup expected = enter_boxes(taken.back().node, taken.back().read());
    const auto& boxes = model->boxes_o;  // ray_core_pkg::boxes_t
    const unsigned leaf = bits(boxes, 0, 7), inner = bits(boxes, 7, 7);
    BoxGroup group{.base = bits(boxes, 14 + 196, 28), .exponent = expected.exponent, .size = 0};
    ASSERT_EQ(bits(boxes, 14 + 224, 1), 1u);
    ASSERT_EQ(model->ctx_o, (clock + 1 - kLatency) % 64);
    ASSERT_EQ(inner & leaf, 0u);
    for (unsigned n = 0; n < 7; ++n) {
      if (((inner | leaf) >> n & 1) == 0) continue;
      ASSERT_EQ(group.size, static_cast<int>(n)) << "no gaps";
      const unsigned at = 14 + 28 * n;
      ASSERT_EQ(bits(boxes, at + 9, 19), ordered_word(expected.entry[n].enter, expected.exponent));
      group.entry[n] = {expected.entry[n].enter, bits(boxes, at + 3, 6), bits(boxes, at, 3)};
      ASSERT_EQ(inner >> n & 1, group.entry[n].count == 0);
      ++group.size;
    }
    entered += group.size;
    ASSERT_EQ(group, expected) << "seed " << kSeed << ", clock " << clock;
  }
  EXPECT_GT(entered, 200'000);
}

}  // namespace
}  // namespace raygate
