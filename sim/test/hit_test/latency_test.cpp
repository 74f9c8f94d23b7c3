// Measures the latencies that the header of hit_test_pipeline states.
#include <gtest/gtest.h>

#include <cstring>

#include "Vhit_test_array_structural.h"
#include "sim/model.h"

namespace raygate {
namespace {

// hit_test_pkg, in binary32
constexpr int kDotLatency = 9, kDivideLatency = 17;
constexpr int kClosedLatency = kDotLatency + kDivideLatency + 3;
constexpr int kPointLatency = kClosedLatency + kDivideLatency;

/// For a burst of one test: clocks from the one that takes the test, counted as 1, to the one that
/// reports the burst's end (`closed`) and to the one that reports its point. 0: not reported.
struct Latencies {
  int closed = 0, point = 0;
};

Latencies run(const float (&direction)[3], const float (&record)[16]) {
  Model<Vhit_test_array_structural> model;
  model->valid_i = 0;
  model->ready_i = 1;
  model->count_select_i = 0;
  model.reset();
  for (int i = 0; i < 5; ++i) model.clock();
  std::memcpy(&model->direction_i, direction, sizeof direction);
  std::memcpy(&model->record_i, record, sizeof record);
  model->first_i = model->last_i = 1;
  model->valid_i = 1;
  EXPECT_EQ(model->ready_o, 1);
  Latencies latencies;
  for (int clock = 1; clock < 100; ++clock) {
    model.clock();
    model->valid_i = 0;
    if (model->valid_o && model->closed_o) latencies.closed = clock;
    if (model->valid_o && model->point_valid_o) latencies.point = clock;
  }
  return latencies;
}

// Record of the triangle (-1, -1, 4), (3, -1, 4), (-1, 3, 4) for the origin, with generous bounds.
constexpr float kRecord[16] = {0, 0, 16, 64, 0, 16, 4, -16, -16, 8, 16, 0, 4, 1e-3f, 1e-3f, 1e-3f};

TEST(LatencyTest, OfAHit) {
  const Latencies latencies = run({0.0f, 0.0f, 1.0f}, kRecord);
  EXPECT_EQ(latencies.closed, kClosedLatency);
  EXPECT_EQ(latencies.point, kPointLatency);
}

TEST(LatencyTest, OfAMissWhichHasNoPoint) {
  const Latencies latencies = run({-1.0f, -1.0f, 1.0f}, kRecord);
  EXPECT_EQ(latencies.closed, kClosedLatency);
  EXPECT_EQ(latencies.point, 0);
}

}  // namespace
}  // namespace raygate
