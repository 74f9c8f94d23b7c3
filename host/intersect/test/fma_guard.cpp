// Fails if the compiler fuses multiplications and additions: computes sums that are 0 only if each
// operation rounds. The second build of this test allows fusing, and must fail.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <span>

#include "host/exact/ieee_floats.h"
#include "host/intersect/unit/burst_unit.h"

namespace raygate {
namespace {

// kA^2 = 1 + 2^-11 + 2^-24 does not fit a float.
constexpr float kA = 1.0f + 0x1p-12f;

bool failed = false;

void expect(bool holds, const char* what) {
  if (holds) return;
  std::printf("fused: %s\n", what);
  failed = true;
}

/// kDirection . kVector, (-kA kA + kA kA) + 0, is 0 if both products are rounded, else not 0.
const glm::vec3 kDirection(kA, kA, 0.0f), kVector(-kA, kA, 0.0f);

RayBundle bundle_of(const PolygonRecord& record) {
  RayBundle bundle;
  for (int lane = 0; lane < kLanes; ++lane) {
    for (int k = 0; k < 3; ++k) bundle.direction[k][lane] = kDirection[k];
  }
  bundle.records = &record;
  bundle.record_count = 1;
  bundle.lanes = 0xFF;
  return bundle;
}

void check_edges() {
  PolygonRecord record;  // bounds of 0: a sum of 0 is neither a hit nor a miss
  record.d = 1.0f;
  record.normal = glm::vec3(1.0f);
  record.edges = {kVector, kVector, kVector};
  const RayBundle bundle = bundle_of(record);
  BurstResults results;
  ReferenceBurstUnit().run(std::span(&bundle, 1), results);
  const auto is_doubt = [](const BurstResult& result) {
    return result.kind == BurstResult::Kind::kDoubt;
  };
  expect(results.size() == kLanes && std::ranges::all_of(results, is_doubt), "ReferenceBurstUnit");
}

void check_plane() {
  const PlaneTest test = {kDirection, kVector, 1.0f};
  glm::vec3 point;
  ReferencePlaneUnit().intersect(std::span(&test, 1), std::span(&point, 1));
  expect(std::isinf(point.x), "ReferencePlaneUnit");  // 1 / +0
}

void check_exact() {
  // The ray lies exactly in the edge's plane. exact.cpp must find a sum of exactly 0, so that the
  // tilt (towards +x) decides the sign.
  const Ray ray = {glm::vec3(0.0f), glm::vec3(1.0f, 1.0f, 1.0f / 3.0f)};
  const glm::vec3 a(1.0f, 1.0f, 0.1f), b(kA, kA, 0.7f);
  expect(edge_side(ray, a, b) == -edge_side(ray, b, a) && edge_side(ray, a, b) != 0, "edge_side");
}

}  // namespace
}  // namespace raygate

int main(int argc, char**) {
  if (argc > 1) {  // the check at the start of programs
    try {
      raygate::require_ieee_floats();
    } catch (const std::exception& error) {
      std::puts(error.what());
    }
    return 0;
  }
  raygate::check_edges();
  raygate::check_plane();
  raygate::check_exact();
  return raygate::failed ? 1 : 0;
}
