#include "host/find/cpu/edge_test.h"

#include <cassert>
#include <limits>

namespace raygate {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

}  // namespace

RAYGATE_LANES void test_edges(const RayBundle& bundle, std::span<EdgeVerdict> verdicts) {
  assert(verdicts.size() == bundle.record_count);
  FloatLanes x, y, z;
  load_lanes(bundle.direction[0], x);
  load_lanes(bundle.direction[1], y);
  load_lanes(bundle.direction[2], z);
  for (std::uint32_t i = 0; i < bundle.record_count; ++i) {
    const PolygonRecord& record = bundle.records[i];
    if (record.d == 0.0f) {
      verdicts[i] = {0, bundle.lanes};
      continue;
    }
    const float side = record.d > 0.0f ? 1.0f : -1.0f;  // exact: changes signs alone
    IntLanes miss = {}, hit = IntLanes{} - 1;
    FloatLanes sum = {};
    for (int k = 0; k < 3; ++k) {
      const glm::vec3 edge = side * record.edges[k];
      const float bound = record.bounds[k];
      const FloatLanes u = (x * edge.x + y * edge.y) + z * edge.z;
      miss |= u < -bound;
      hit &= u > bound;
      sum += u;
    }
    hit &= sum < kInfinity;  // with infinity in a direction, nothing is sure, nor with a NaN
    const std::uint32_t masks = mask_of(miss, hit);
    verdicts[i] = {masks >> 8 & bundle.lanes, masks & bundle.lanes};
  }
}

}  // namespace raygate
