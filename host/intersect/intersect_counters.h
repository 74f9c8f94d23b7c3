// What searches have done, counted.
#pragma once

#include <cstdint>

namespace raygate {

/// Tests of rays against polygons, and what a hit-test unit did for them.
struct HitCounters {
  std::uint64_t tests = 0;         ///< (ray, polygon) pairs; misses + hits + edge_doubts
  std::uint64_t misses = 0;        ///< surely missed
  std::uint64_t hits = 0;          ///< surely hit
  std::uint64_t edge_doubts = 0;   ///< neither
  std::uint64_t depth_doubts = 0;  ///< sure hits that float32 cannot put in order
  std::uint64_t plane_tests = 0;   ///< points P = d I / (I . N) computed
  // What follows is 0 where no unit is asked.
  std::uint64_t unit_tests = 0;     ///< tests that went through the unit
  std::uint64_t quotients = 0;      ///< divisions that the unit did
  std::uint64_t input_bytes = 0;    ///< of the words it took: records, or rays and planes
  std::uint64_t clocks = 0;         ///< simulated clock cycles; 0 where nothing is simulated
  std::uint64_t idle_clocks = 0;    ///< of the pipelined unit's lanes: no test was there
  std::uint64_t output_stalls = 0;  ///< of these: a result was not taken

  HitCounters& operator+=(const HitCounters& other);
};

/// What a intersector has done since it was made.
struct IntersectCounters {
  HitCounters hit;
  std::uint64_t exact_inside = 0;    ///< doubts about edges that exact arithmetic settled: not
                                     ///< those surely too far away
  std::uint64_t exact_depth = 0;     ///< pairs of hits, or a hit and a limit, that it put in order
  std::uint64_t ended_early = 0;     ///< searches that RayQuery::any_hit_before ended
  std::uint64_t own_records = 0;     ///< polygon records made for a single packet of rays
  std::uint64_t common_records = 0;  ///< polygon records made for origins that searches share
  // Seconds.
  double traverse = 0.0;   ///< boxes, and records of common origins
  double record = 0.0;     ///< own records
  double hit_tests = 0.0;  ///< tests, and settling what they leave open; of tests in place: all

  IntersectCounters& operator+=(const IntersectCounters& other);
};

}  // namespace raygate
