#include "host/intersect/intersect_counters.h"

namespace raygate {

HitCounters& HitCounters::operator+=(const HitCounters& other) {
  tests += other.tests;
  misses += other.misses;
  hits += other.hits;
  edge_doubts += other.edge_doubts;
  depth_doubts += other.depth_doubts;
  plane_tests += other.plane_tests;
  unit_tests += other.unit_tests;
  quotients += other.quotients;
  input_bytes += other.input_bytes;
  clocks += other.clocks;
  idle_clocks += other.idle_clocks;
  output_stalls += other.output_stalls;
  return *this;
}

IntersectCounters& IntersectCounters::operator+=(const IntersectCounters& other) {
  hit += other.hit;
  exact_inside += other.exact_inside;
  exact_depth += other.exact_depth;
  ended_early += other.ended_early;
  own_records += other.own_records;
  common_records += other.common_records;
  traverse += other.traverse;
  record += other.record;
  hit_tests += other.hit_tests;
  return *this;
}

}  // namespace raygate
