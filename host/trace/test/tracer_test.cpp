// Traces tables in limited memory.
#include "host/trace/tracer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "host/exact/test/meshes.h"

namespace raygate {
namespace {

// The rows of all hits of a block may exceed memory.
TEST(Trace, WritesTheRowsOfABlockBitByBit) {
  constexpr std::size_t kSheets = 200, kRays = 3000, kRow = 16;
  std::vector<Corners> sheets;
  for (std::size_t i = 0; i < kSheets; ++i) {
    const float z = -static_cast<float>(i);
    sheets.push_back({glm::vec3(-1, -1, z), glm::vec3(1, -1, z), glm::vec3(0, 1, z)});
  }
  const Scene scene = test::scene_of(sheets);
  const Bvh bvh(scene);
  const HitTable answers(scene, bvh, {HitColumn::kRay, HitColumn::kTriangle}, TableFormat::kBinary);
  std::size_t next = 0, most = 0;
  std::string rows;
  const TraceCounts counts = trace(
      [&](std::size_t room, RayTable& block) {
        block.clear(next);
        for (std::size_t i = 0; i < std::min<std::size_t>(room, 1000) && next < kRays;
             ++i, ++next) {
          (void)block.add({0.0, 0.0, 1.0}, {0.0, 0.0, -1.0},
                          std::numeric_limits<double>::infinity(), glm::dvec3(0.0));
        }
        return !block.rays.empty();
      },
      Hits::kAll, bvh, answers, nullptr, 2,
      [&](std::string_view bytes) {
        most = std::max(most, bytes.size());
        rows += bytes;
      });
  EXPECT_LE(most, (std::size_t{1} << 20) + kRow * kSheets);
  EXPECT_EQ(counts.rays, kRays);
  EXPECT_EQ(counts.hits, kRays * kSheets);
  ASSERT_EQ(rows.size(), kRow * kRays * kSheets);
  for (std::size_t i = 0; i < kRays * kSheets; ++i) {
    std::int64_t row[2];
    std::memcpy(row, rows.data() + kRow * i, kRow);
    ASSERT_EQ(row[0], static_cast<std::int64_t>(i / kSheets));
    ASSERT_EQ(row[1], static_cast<std::int64_t>(i % kSheets));
  }
}

}  // namespace
}  // namespace raygate
