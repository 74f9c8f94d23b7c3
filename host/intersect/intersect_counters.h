// Counters of intersectors.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace raygate {

/// Adds the fields of a struct that consists of std::uint64_t only; its declaration is the only
/// list of the fields.
template <class Counters>
void add_counters(Counters& sum, const Counters& other) {
  using Words = std::array<std::uint64_t, sizeof(Counters) / sizeof(std::uint64_t)>;
  auto words = std::bit_cast<Words>(sum);
  const auto others = std::bit_cast<Words>(other);
  for (std::size_t i = 0; i < words.size(); ++i) words[i] += others[i];
  sum = std::bit_cast<Counters>(words);
}

/// Tests of rays against polygons, and the work of a hit-test unit.
struct HitCounters {
  std::uint64_t tests = 0;         ///< (ray, polygon) pairs: misses + hits + edge_doubts
  std::uint64_t misses = 0;        ///< sure misses
  std::uint64_t hits = 0;          ///< sure hits
  std::uint64_t edge_doubts = 0;   ///< neither sure misses nor sure hits
  std::uint64_t depth_doubts = 0;  ///< sure hits that binary32 cannot order
  std::uint64_t plane_tests = 0;   ///< points P = d I / (I . N) computed
  // The fields below are 0 without a unit.
  std::uint64_t unit_tests = 0;     ///< tests done by the unit
  std::uint64_t quotients = 0;      ///< divisions done by the unit
  std::uint64_t input_bytes = 0;    ///< bytes sent to the unit: records, or rays and planes
  std::uint64_t clocks = 0;         ///< simulated clock cycles
  std::uint64_t idle_clocks = 0;    ///< clocks of the pipelined unit's lanes without a test
  std::uint64_t output_stalls = 0;  ///< clocks of the lanes stalled by the consumer
  std::uint64_t exact_clocks = 0;   ///< busy clocks of the exact units of ray cores

  HitCounters& operator+=(const HitCounters& other) {
    add_counters(*this, other);
    return *this;
  }
};

/// Statistics of an intersector since its construction.
struct IntersectCounters {
  HitCounters hit;
  std::uint64_t exact_inside = 0;  ///< edge doubts resolved by exact arithmetic, without those
                                   ///< surely too far away
  std::uint64_t exact_depth = 0;   ///< exact comparisons of two hits, or of a hit and t_max
  std::uint64_t ended_early = 0;   ///< rays ended early by RayQuery::any_hit_before
  std::uint64_t records = 0;       ///< polygon records made
  // Seconds.
  double traverse = 0.0;   ///< boxes
  double record = 0.0;     ///< records
  double hit_tests = 0.0;  ///< tests and resolving doubts; without a unit: total time

  IntersectCounters& operator+=(const IntersectCounters& other) {
    hit += other.hit;
    exact_inside += other.exact_inside;
    exact_depth += other.exact_depth;
    ended_early += other.ended_early;
    records += other.records;
    traverse += other.traverse;
    record += other.record;
    hit_tests += other.hit_tests;
    return *this;
  }
};

}  // namespace raygate
