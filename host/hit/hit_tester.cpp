#include "host/hit/hit_tester.h"

namespace raygate {

HitCounters& HitCounters::operator+=(const HitCounters& other) {
  tests += other.tests;
  misses += other.misses;
  hits += other.hits;
  edge_doubts += other.edge_doubts;
  depth_doubts += other.depth_doubts;
  plane_tests += other.plane_tests;
  clocks += other.clocks;
  return *this;
}

}  // namespace raygate
