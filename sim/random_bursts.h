// Bursts of hit tests to compare pipelined units: typical ones and adversarial ones.
#pragma once

#include <random>
#include <vector>

#include "host/intersect/unit/burst_unit.h"

namespace raygate {

/// A batch with the records it points to.
struct BurstBatch {
  std::vector<PolygonRecord> records;
  std::vector<RayBundle> bundles;
  std::uint64_t tests = 0;
};

/// Makes batches from a seed. About half of the records are triangles that some of the rays hit,
///   edge-on and grazing ones among them; a quarter are such triangles with words replaced: by
///   specials (zeros, subnormals, infinities, NaN, the largest and smallest), bounds by |U| of a
///   ray or its neighbours, d by values that bring distances to near ties, to overflow and to
///   underflow; an eighth are copies of the record before, alike or with d a few units off; an
///   eighth are random bits.
class RandomBursts {
 public:
  explicit RandomBursts(std::uint64_t seed) : random_(seed) {}

  /// About `tests` tests, in bundles of 1 to 8 rays and 1 to 6 records.
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
