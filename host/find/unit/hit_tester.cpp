#include "host/find/unit/hit_tester.h"

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

}  // namespace raygate
