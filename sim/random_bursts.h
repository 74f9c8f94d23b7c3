// Bursts of hit tests to compare pipelined units: typical and adversarial bursts.
#pragma once

#include <random>
#include <vector>

#include "host/intersect/unit/burst_unit.h"

namespace raygate {

/// A batch, with the records to which its bundles point.
struct BurstBatch {
  std::vector<PolygonRecord> records;
  std::vector<RayBundle> bundles;
  std::uint64_t tests = 0;
};

/// Makes random batches from a seed. Of the records, about
/// * 1/2 are triangles that some of the rays hit, also at vertices, at edges and at grazing angles;
/// * 1/4 are such triangles with changed words: random bits, special values (zeros, subnormals,
///   infinities, NaN, extremes), bounds at most one float from a ray's |U|, d or N times 2^k;
/// * 1/8 are copies of the preceding record, with d moved by at most 2,048 floats: near ties;
/// * 1/8 are random bits.
class RandomBursts {
 public:
  explicit RandomBursts(std::uint64_t seed) : random_(seed) {}

  /// Makes at least `tests` tests, in bundles of 0 to 8 rays and 0 to 6 records.
  BurstBatch make(std::uint64_t tests);

 private:
  std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>(random_() >> 32) % n; }
  bool one_in(std::uint32_t n) { return below(n) == 0; }
  double uniform(double low, double high);
  float random_bits();
  float special();
  glm::vec3 random_direction();
  PolygonRecord triangle(const glm::vec3& direction);
  void spoil(PolygonRecord& record, const glm::vec3& direction);
  PolygonRecord any_record(const glm::vec3& direction, const PolygonRecord& before);

  std::mt19937_64 random_;
};

}  // namespace raygate
