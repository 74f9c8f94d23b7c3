// The box unit's promise against rationals: no box that a ray exactly enters is left out.
#include <gmpxx.h>
#include <gtest/gtest.h>

#include "host/intersect/core/reference_units.h"
#include "host/intersect/core/test/box_cases.h"

namespace raygate {
namespace {

/// Where the ray, 0 <= t <= limit, is in the child's box; `first` becomes the smallest such t.
bool enters(const BoxCase& box, const NodeLine::Child& child, mpq_class& first) {
  mpq_class low = 0, high = -1;  // -1: no end
  if (std::isfinite(box.limit)) high = mpq_class(box.limit);
  for (int k = 0; k < 3; ++k) {
    const auto at = static_cast<std::size_t>(k);
    const mpq_class cell(std::ldexp(1.0, box.node.exponent[at] - 127));
    const mpq_class origin(box.ray.origin[k]), direction(box.ray.direction[k]);
    mpq_class near = mpq_class(box.node.origin[k]) + child.low[at] * cell - origin;
    mpq_class far = mpq_class(box.node.origin[k]) + child.high[at] * cell - origin;
    if (direction == 0) {
      if (near > 0 || far < 0) return false;
      continue;
    }
    near /= direction;
    far /= direction;
    if (near > far) std::swap(near, far);
    if (near > low) low = near;
    if (high < 0 || far < high) {
      if (far < 0) return false;
      high = far;
    }
  }
  first = low;
  return low <= high;
}

TEST(ReferenceBoxUnit, LeavesOutNoBoxThatARayEnters) {
  const std::uint32_t seed = 20261122;
  BoxCases cases(seed);
  std::uint64_t entered = 0, given = 0, boxes = 0, most = 0;
  for (int i = 0; i < 100'000; ++i) {
    const BoxCase box = cases.next();
    const BoxGroup group = enter_boxes(box.node, box.read());
    std::uint32_t offset = 0;
    for (const NodeLine::Child& child : box.node.child) {
      const std::uint32_t here = offset;
      offset += child.size();
      if (child.kind == NodeLine::kAbsent) continue;
      ++boxes;
      const auto* const end = group.entry.begin() + group.size;
      const auto* const entry = std::find_if(
          group.entry.begin(), end, [&](const BoxGroup::Entry& e) { return e.offset == here; });
      given += entry != end && !box.no_cull;
      mpq_class first;
      if (!enters(box, child, first)) continue;
      ++entered;
      ASSERT_NE(entry, end) << "seed " << seed << ", case " << i << ", child at " << here;
      mpq_class enter(entry->enter);
      const int unit = static_cast<int>(group.exponent) - 127 - 12;
      if (unit >= 0)
        mpq_mul_2exp(enter.get_mpq_t(), enter.get_mpq_t(), static_cast<unsigned long>(unit));
      if (unit < 0)
        mpq_div_2exp(enter.get_mpq_t(), enter.get_mpq_t(), static_cast<unsigned long>(-unit));
      ASSERT_LE(enter, first) << "seed " << seed << ", case " << i << ", child at " << here;
      EXPECT_FALSE(is_beyond(group, *entry, box.limit));
    }
    most = std::max<std::uint64_t>(most, static_cast<std::uint64_t>(group.size));
    for (int n = 1; n < group.size; ++n) {
      ASSERT_LE(group.entry[static_cast<std::size_t>(n - 1)].enter,
                group.entry[static_cast<std::size_t>(n)].enter);
    }
  }
  EXPECT_EQ(most, 7u);
  EXPECT_GT(entered, boxes / 16);
  EXPECT_LT(given, entered + boxes / 16);  // nor does it take in all that there are
}

}  // namespace
}  // namespace raygate
