#include "sim/random_bursts.h"

#include <bit>
#include <cmath>
#include <limits>

namespace raygate {
namespace {

/// Returns the float whose bit pattern is that of `x` plus `steps`.
float stepped(float x, int steps) {
  return std::bit_cast<float>(std::bit_cast<std::uint32_t>(x) + static_cast<std::uint32_t>(steps));
}

float* words(PolygonRecord& record) { return &record.normal.x; }

PolygonRecord record_of(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  PolygonRecord record;
  const glm::dvec3 normal = glm::cross(b - a, c - a);
  record.normal = normal;
  record.d = static_cast<float>(glm::dot(normal, a));
  record.edges = {glm::vec3(glm::cross(a, b)), glm::vec3(glm::cross(b, c)),
                  glm::vec3(glm::cross(c, a))};
  for (int k = 0; k < 3; ++k) {
    const glm::dvec3 e = glm::abs(glm::dvec3(record.edges[k]));
    record.bounds[k] = static_cast<float>(8.1 * 0x1p-24 * (e.x + e.y + e.z));
  }
  return record;
}

}  // namespace

double RandomBursts::uniform(double low, double high) {
  return low + (high - low) * std::ldexp(static_cast<double>(random_() >> 11), -53);
}

float RandomBursts::random_bits() {
  return std::bit_cast<float>(static_cast<std::uint32_t>(random_() >> 32));
}

float RandomBursts::special() {
  static constexpr std::uint32_t kSpecials[] = {
      0x00000000, 0x00000001, 0x00400000, 0x007FFFFF, 0x00800000, 0x00800001, 0x34000000,
      0x3F7FFFFF, 0x3F800000, 0x3F800001, 0x3FFFFFFF, 0x40000000, 0x4B800000, 0x7F000000,
      0x7F7FFFFF, 0x7F800000, 0x7F800001, 0x7FC00000, 0x7FFFFFFF};
  return std::bit_cast<float>(kSpecials[below(std::size(kSpecials))] | below(2) << 31);
}

glm::vec3 RandomBursts::random_direction() {
  glm::vec3 direction;
  for (int k = 0; k < 3; ++k) direction[k] = static_cast<float>(uniform(-2.0, 2.0));
  direction[static_cast<int>(below(3))] = static_cast<float>(uniform(1.0, 2.0));
  if (one_in(16)) direction[static_cast<int>(below(3))] = special();
  if (one_in(64)) direction = {random_bits(), random_bits(), random_bits()};
  return direction;
}

/// Returns a triangle with corners around a random point of the ray. The ray may hit or miss it.
PolygonRecord RandomBursts::triangle(const glm::vec3& direction) {
  const double size = std::exp2(uniform(-6.0, 3.0));
  const glm::dvec3 center = glm::dvec3(direction) * std::exp2(uniform(-4.0, 6.0));
  glm::dvec3 corners[3];
  for (glm::dvec3& corner : corners) {
    for (int k = 0; k < 3; ++k) corner[k] = center[k] + size * uniform(-1.0, 1.0);
  }
  if (one_in(8)) corners[1] = center;                     // aimed at a vertex
  if (one_in(8)) corners[1] = 2.0 * center - corners[0];  // aimed at an edge
  if (one_in(8)) {                                        // nearly parallel to the ray
    corners[0] = center * uniform(0.5, 0.9);
    corners[1] = center * uniform(1.1, 2.0) + size * uniform(-0x1p-9, 0x1p-9);
  }
  for (glm::dvec3& corner : corners) corner = glm::dvec3(glm::vec3(corner));
  return record_of(corners[0], corners[1], corners[2]);
}

void RandomBursts::spoil(PolygonRecord& record, const glm::vec3& direction) {
  switch (below(6)) {
    case 0:
      words(record)[below(16)] = special();
      break;
    case 1:  // bounds equal to |U|, or one float off
      for (int k = 0; k < 3; ++k) {
        const glm::vec3& e = record.edges[k];
        const float u = (e.x * direction.x + e.y * direction.y) + e.z * direction.z;
        record.bounds[k] = stepped(std::abs(u), static_cast<int>(below(3)) - 1);
      }
      break;
    case 2:  // t much larger or smaller
      record.d = std::ldexp(record.d, static_cast<int>(below(300)) - 150);
      break;
    case 3: {  // V much larger or smaller, also too small a divisor beside the largest of N
      const int shift = static_cast<int>(below(40)) - 20;
      for (int k = 0; k < 3; ++k) record.normal[k] = std::ldexp(record.normal[k], shift);
      if (one_in(2)) record.normal[static_cast<int>(below(3))] *= std::exp2(13.0f);
      break;
    }
    case 4:
      record.bounds[below(3)] = one_in(2) ? std::numeric_limits<float>::infinity() : special();
      break;
    default:
      words(record)[below(16)] = random_bits();
      break;
  }
}

PolygonRecord RandomBursts::any_record(const glm::vec3& direction, const PolygonRecord& before) {
  const std::uint32_t kind = below(8);
  if (kind == 0) {
    PolygonRecord record;
    for (int k = 0; k < 16; ++k) words(record)[k] = random_bits();
    return record;
  }
  PolygonRecord record = before;
  if (kind == 1) {  // nearly as far as the record before: near ties are within 64 + 64 floats
    const int reach = 1 << below(12);
    record.d = stepped(record.d, static_cast<int>(below(2 * reach + 1)) - reach);
    return record;
  }
  record = triangle(direction);
  if (kind < 4) spoil(record, direction);
  return record;
}

BurstBatch RandomBursts::make(std::uint64_t tests) {
  BurstBatch batch;
  std::vector<std::size_t> first;
  while (batch.tests < tests) {
    RayBundle bundle;
    bundle.lanes = one_in(3) ? 0xFF : below(256);
    bundle.record_count = below(7);
    glm::vec3 direction{1.0f};
    for (int lane = 0; lane < kLanes; ++lane) {
      // Three of four rays are neighbours of the ray before.
      if (lane == 0 || one_in(4)) direction = random_direction();
      for (int k = 0; k < 3; ++k) {
        bundle.direction[k][lane] = stepped(direction[k], static_cast<int>(below(5)) - 2);
      }
    }
    first.push_back(batch.records.size());
    PolygonRecord record = triangle(direction);
    for (std::uint32_t i = 0; i < bundle.record_count; ++i) {
      record = any_record(bundle.lane_direction(static_cast<int>(below(kLanes))), record);
      batch.records.push_back(record);
    }
    batch.tests += static_cast<std::uint64_t>(std::popcount(bundle.lanes)) * bundle.record_count;
    batch.bundles.push_back(bundle);
  }
  for (std::size_t i = 0; i < first.size(); ++i) {
    batch.bundles[i].records = batch.records.data() + first[i];
  }
  return batch;
}

}  // namespace raygate
