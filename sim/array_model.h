// Drives several Verilated hit_test_arrays in lockstep, as one array of all their lanes: bursts in,
// results out.
#pragma once

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstring>
#include <random>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim/model.h"
#include "sim/port_numbers.h"
#include "sim/rtl_units.h"

namespace raygate {

/// Interface through which RtlBurstUnit drives a simulated array.
class BurstModel {
 public:
  virtual ~BurstModel() = default;
  virtual void start(std::span<const RayBundle> batch) = 0;
  virtual void finish(BurstResults& results) = 0;
  virtual HitCounters counters() = 0;
};

template <class T, class Port>
T read_slot(Port& port, int n) {
  T value;
  std::memcpy(&value, slot(port, n, sizeof value), sizeof value);
  return value;
}

/// Iterates over the bursts of a batch.
class BurstCursor {
 public:
  struct Burst {
    std::uint32_t bundle = 0, lane = 0;
  };

  explicit BurstCursor(std::span<const RayBundle> batch = {}) : batch_(batch) { settle(); }

  [[nodiscard]] bool done() const { return bundle_ == batch_.size(); }

  Burst take() {
    const Burst burst{bundle_, static_cast<std::uint32_t>(std::countr_zero(lanes_))};
    lanes_ &= lanes_ - 1;
    if (lanes_ == 0) {
      ++bundle_;
      settle();
    }
    return burst;
  }

 private:
  /// Skips bundles without tests, from the current bundle on.
  void settle() {
    while (!done() && (batch_[bundle_].record_count == 0 || batch_[bundle_].lanes == 0)) ++bundle_;
    lanes_ = done() ? 0 : batch_[bundle_].lanes;
  }

  std::span<const RayBundle> batch_;
  std::uint32_t bundle_ = 0;
  std::uint32_t lanes_ = 0;
};

/// A hardware lane's part of a batch: its bursts and their results.
struct LaneShare {
  std::vector<BurstCursor::Burst> bursts;  // all started bursts; the last may be incomplete
  std::size_t closed = 0;                  // number of bursts that have ended
  std::size_t pointed = 0;                 // number of leading `results` that await no point
  BurstResults results;

  void clear() {
    bursts.clear();
    results.clear();
    closed = pointed = 0;
  }
  [[nodiscard]] bool all_closed() { return closed == bursts.size(); }
  /// Returns whether every hit has received its point.
  [[nodiscard]] bool all_pointed() {
    while (pointed < results.size() && results[pointed].kind != BurstResult::Kind::kHit) ++pointed;
    return pointed == results.size();
  }
};

/// The burst that a lane is receiving.
struct LaneInput {
  const PolygonRecord* record = nullptr;  // the next test; null between bursts
  const PolygonRecord* end = nullptr;
  std::uint32_t tag = 0;  // index of `record` in the burst
};

/// Numbers of the counters, as in hit_test_pkg::count_e.
enum Count {
  kTests,
  kMisses,
  kHits,
  kDoubts,
  kNearTies,
  kDistances,
  kPoints,
  kIdleClocks,
  kOutputStalls
};

/// An array of `lanes` lanes, built of models with kModelLanes lanes each. `Top` is Verilator's
/// class of hit_test_array. Its lanes are independent; only their counters are added up. Therefore
/// several models behave like one model with all lanes. Throws std::runtime_error if
/// the hardware is broken: no test is taken and no burst ends for kPatience clocks, or a result
/// belongs to no burst.
template <class Top, int kModelLanes = 1, class Numbers = Binary32Numbers>
class ArrayModel : public BurstModel {
 public:
  /// `lanes`: a multiple of kModelLanes, at most 32; other values are a bug of the caller.
  explicit ArrayModel(int lanes, const BurstStalls& stalls = {}, const Numbers& numbers = {})
      : models_(static_cast<std::size_t>(lanes / kModelLanes)),
        numbers_(numbers),
        inputs_(static_cast<std::size_t>(lanes)),
        stalls_(stalls),
        random_(stalls.seed),
        throttled_(stalls.no_test > 0 || stalls.not_taken > 0) {
    assert(lanes > 0 && lanes % kModelLanes == 0 && lanes <= 32);
    for (Work& work : works_) work.shares.resize(inputs_.size());
    for (Model<Top>& model : models_) {
      model->valid_i = 0;
      model->ready_i = 0;
      model->count_select_i = 0;
      model.reset();
    }
  }

  void start(std::span<const RayBundle> batch) override {
    assert(in_flight_ < kMostBatches);
    Work& work = work_at(in_flight_++);
    work.batch = batch;
    work.cursor = BurstCursor(batch);
    for (LaneShare& share : work.shares) share.clear();
  }

  void finish(BurstResults& results) override {
    assert(in_flight_ > 0);
    Work& work = work_at(0);
    while (!drained(work)) step();
    for (Model<Top>& model : models_) model->valid_i = 0;
    merge(work, results);
    oldest_ = (oldest_ + 1) % kMostBatches;
    --in_flight_;
  }

  HitCounters counters() override {
    assert(in_flight_ == 0);
    for (int i = 0; i < 3; ++i) clock();  // the counters have a latency of three clocks
    return {.tests = read(kTests),
            .misses = read(kMisses),
            .hits = read(kHits),
            .edge_doubts = read(kDoubts),
            .depth_doubts = read(kNearTies),
            .plane_tests = read(kPoints),
            .clocks = models_.front().clocks(),
            .idle_clocks = read(kIdleClocks),
            .output_stalls = read(kOutputStalls)};
  }

 private:
  static constexpr unsigned kAllOfModel = (1u << kModelLanes) - 1;
  static constexpr unsigned kMostBatches = 2;
  static constexpr unsigned kPatience = 10'000;

  /// A batch in flight.
  struct Work {
    std::span<const RayBundle> batch;
    BurstCursor cursor;
    std::vector<LaneShare> shares;
  };

  [[nodiscard]] int lanes() const { return static_cast<int>(inputs_.size()); }
  Top& model_of(int n) { return *models_[static_cast<std::size_t>(n / kModelLanes)]; }
  void clock() {
    for (Model<Top>& model : models_) model.clock();
  }

  /// Returns a batch in flight; the oldest has age 0.
  Work& work_at(unsigned age) { return works_[(oldest_ + age) % kMostBatches]; }

  static bool drained(Work& work) {
    return work.cursor.done() && std::ranges::all_of(work.shares, [](LaneShare& share) {
             return share.all_closed() && share.all_pointed();
           });
  }

  /// Simulates one clock: offers every lane a test and takes every lane's result.
  void step() {
    unsigned valid = 0, ready = ~0u;
    for (int n = 0; n < lanes(); ++n) {
      if (!(offered_ >> n & 1)) {
        if (inputs_[n].record == nullptr) start_burst(n);
        if (inputs_[n].record != nullptr && !(throttled_ && chance(stalls_.no_test))) {
          offer_test(n);
          valid |= 1u << n;
        }
      } else {
        valid |= 1u << n;
      }
      if (throttled_ && chance(stalls_.not_taken)) ready &= ~(1u << n);
      if ((ready >> n & 1) != 0 && bit(model_of(n).valid_o, n)) take_result(n);
    }
    unsigned taken = 0;
    for (int n = 0; n < lanes(); n += kModelLanes) {
      Top& model = model_of(n);
      model.valid_i = valid >> n & kAllOfModel;
      model.ready_i = ready >> n & kAllOfModel;
      taken |= static_cast<unsigned>(model.valid_i & model.ready_o) << n;
    }
    quiet_ = taken != 0 ? 0 : quiet_ + 1;
    if (quiet_ > kPatience)
      broken("nothing in and nothing ended for " + std::to_string(kPatience) + " clocks");
    clock();
    offered_ = valid & ~taken;
    for (unsigned left = taken; left != 0; left &= left - 1) next_test(std::countr_zero(left));
  }

  [[noreturn]] static void broken(const std::string& what) {
    throw std::runtime_error("hit_test_array: " + what);
  }

  bool chance(int of_256) { return static_cast<int>(random_() & 0xFF) < of_256; }

  std::uint64_t read(Count count) {
    std::uint64_t sum = 0;
    for (Model<Top>& model : models_) {
      model->count_select_i = count;
      model.eval();
      sum += model->counter_o;
    }
    return sum;
  }

  /// Starts the next burst of the batches, if there is one, in lane n.
  void start_burst(int n) {
    for (unsigned age = 0; age < in_flight_; ++age) {
      Work& work = work_at(age);
      if (work.cursor.done()) continue;
      const BurstCursor::Burst burst = work.cursor.take();
      work.shares[n].bursts.push_back(burst);
      const RayBundle& bundle = work.batch[burst.bundle];
      inputs_[n] = {bundle.records, bundle.records + bundle.record_count, 0};
      const glm::vec3 direction = bundle.lane_direction(static_cast<int>(burst.lane));
      numbers_.write(model_of(n).direction_i, n % kModelLanes, &direction.x, 3);
      return;
    }
  }

  /// Writes lane n's next test to the lane's input ports.
  void offer_test(int n) {
    const LaneInput& lane = inputs_[n];
    Top& model = model_of(n);
    const int own = n % kModelLanes;
    numbers_.write(model.record_i, own, &lane.record->normal.x, 16);
    std::memcpy(slot(model.tag_i, own, sizeof lane.tag), &lane.tag, sizeof lane.tag);
    set_bit(model.first_i, own, lane.tag == 0);
    set_bit(model.last_i, own, lane.record + 1 == lane.end);
  }

  void next_test(int n) {
    LaneInput& lane = inputs_[n];
    ++lane.tag;
    if (++lane.record == lane.end) lane.record = nullptr;
  }

  /// Returns lane n's bit of a port of its model.
  template <class Port>
  static bool bit(Port port, int n) {
    return (port >> (n % kModelLanes) & 1) != 0;
  }
  template <class Port>
  static void set_bit(Port& port, int own, bool value) {
    port = static_cast<Port>((port & ~(1u << own)) | static_cast<unsigned>(value) << own);
  }

  /// Returns lane n's share of the oldest batch for which `all` returns false, or null if none.
  LaneShare* awaited(int n, bool (LaneShare::*all)()) {
    for (unsigned age = 0; age < in_flight_; ++age) {
      LaneShare& share = work_at(age).shares[n];
      if (!(share.*all)()) return &share;
    }
    return nullptr;
  }

  /// Takes lane n's output word. Only a word that ends a burst or carries a point counts as
  /// progress: broken hardware may repeat other words for ever.
  void take_result(int n) {
    Top& model = model_of(n);
    const int own = n % kModelLanes;
    const unsigned kind = model.report_o >> (2 * own) & 3;
    const bool closed = bit(model.closed_o, n);
    if (kind != 0 || closed) {
      LaneShare* const share = awaited(n, &LaneShare::all_closed);
      if (share == nullptr) broken("a result for no burst, lane " + std::to_string(n));
      const auto& [bundle, bundle_lane] = share->bursts[share->closed];
      if (kind != 0) {
        share->results.push_back({bundle, bundle_lane,
                                  read_slot<std::uint32_t>(model.report_tag_o, own),
                                  static_cast<BurstResult::Kind>(kind)});
      }
      if (closed) {
        if (bit(model.found_o, n)) {
          BurstResult& hit = share->results.emplace_back();
          hit = {bundle, bundle_lane, read_slot<std::uint32_t>(model.tag_o, own)};
          numbers_.read(model.t_o, own, &hit.t, 1);
          hit.t_error = static_cast<std::uint32_t>(model.t_error_o >> (4 * own) & 15);
        }
        ++share->closed;
        quiet_ = 0;
      }
    }
    if (bit(model.point_valid_o, n)) {
      LaneShare* const share = awaited(n, &LaneShare::all_pointed);
      if (share == nullptr) broken("a point for no hit, lane " + std::to_string(n));
      numbers_.read(model.point_o, own, &share->results[share->pointed++].point.x, 3);
      quiet_ = 0;
    }
  }

  /// Merges the lanes' results, each in order, into one list in the order of the batch.
  void merge(const Work& work, BurstResults& results) {
    const auto before = [](const auto& a, const auto& b) {
      return a.bundle != b.bundle ? a.bundle < b.bundle : a.lane < b.lane;
    };
    const auto old = static_cast<std::ptrdiff_t>(results.size());
    for (const LaneShare& share : work.shares) {
      results.insert(results.end(), share.results.begin(), share.results.end());
    }
    if (lanes() > 1) std::stable_sort(results.begin() + old, results.end(), before);
  }

  std::vector<Model<Top>> models_;
  Numbers numbers_;
  std::vector<LaneInput> inputs_;  // one per lane
  unsigned offered_ = 0;           // bit n: the test at lane n's input has not been taken yet
  unsigned quiet_ = 0;             // clocks since a test was taken, or a burst or a point ended
  Work works_[kMostBatches];
  unsigned oldest_ = 0, in_flight_ = 0;
  BurstStalls stalls_;
  std::mt19937_64 random_;
  bool throttled_;
};

}  // namespace raygate
