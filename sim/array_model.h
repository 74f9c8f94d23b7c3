// Drives a Verilated hit_test_array, whatever its number of lanes: bursts in, results out.
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
#include "sim/rtl_burst_unit.h"

namespace raygate {

/// What RtlBurstUnit needs of an array.
class BurstModel {
 public:
  virtual ~BurstModel() = default;
  virtual void start(std::span<const RayBundle> batch) = 0;
  virtual void finish(BurstResults& results) = 0;
  virtual BurstCounters counters() = 0;
};

template <class T, class Port>
T read_slot(Port& port, int n) {
  T value;
  std::memcpy(&value, slot(port, n, sizeof value), sizeof value);
  return value;
}

/// The bursts of a batch, one after the other.
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
  /// To the first bundle from here on with a test in it.
  void settle() {
    while (!done() && (batch_[bundle_].record_count == 0 || batch_[bundle_].lanes == 0)) ++bundle_;
    lanes_ = done() ? 0 : batch_[bundle_].lanes;
  }

  std::span<const RayBundle> batch_;
  std::uint32_t bundle_ = 0;
  std::uint32_t lanes_ = 0;
};

/// What a lane of the hardware has of a batch: the bursts that went in, and what came out of them.
struct LaneShare {
  std::vector<BurstCursor::Burst> bursts;  // all that went in, and the one that does
  std::size_t closed = 0;                  // so many of them are over
  std::size_t pointed = 0;                 // so many of `hits` have their point
  BurstResults results;

  void clear() {
    bursts.clear();
    results.clear();
    closed = pointed = 0;
  }
  [[nodiscard]] bool all_closed() const { return closed == bursts.size(); }
  [[nodiscard]] bool all_pointed() const { return pointed == results.hits.size(); }
};

/// The burst that goes into a lane.
struct LaneInput {
  const PolygonRecord* record = nullptr;  // the next test; null between bursts
  const PolygonRecord* end = nullptr;
  std::uint32_t tag = 0;
};

/// hit_test_pkg::count_e
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

/// The array `Top` (a class that Verilator made), with so many lanes. Hardware that is broken is
/// told by std::runtime_error: nothing goes in and nothing ends for kPatience clocks, or a result
/// that nobody waits for.
template <class Top, int kHardwareLanes, class Numbers = Binary32Numbers>
class ArrayModel : public BurstModel {
 public:
  explicit ArrayModel(const BurstStalls& stalls, const Numbers& numbers = {})
      : numbers_(numbers),
        stalls_(stalls),
        random_(stalls.seed),
        throttled_(stalls.no_test > 0 || stalls.not_taken > 0) {
    model_->valid_i = 0;
    model_->ready_i = 0;
    model_->count_select_i = 0;
    model_.reset();
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
    const Work& work = work_at(0);
    while (!drained(work)) step();
    model_->valid_i = 0;
    merge(work, results);
    oldest_ = (oldest_ + 1) % kMostBatches;
    --in_flight_;
  }

  BurstCounters counters() override {
    assert(in_flight_ == 0);
    for (int i = 0; i < 3; ++i) model_.clock();  // the counters are three clocks late
    return {read(kTests),      read(kMisses),      read(kHits),       read(kDoubts),
            read(kNearTies),   read(kDistances),   3 * read(kPoints), model_.clocks(),
            read(kIdleClocks), read(kOutputStalls)};
  }

 private:
  static constexpr unsigned kAllLanes = (1u << kHardwareLanes) - 1;
  static constexpr unsigned kMostBatches = 2;
  static constexpr unsigned kPatience = 10'000;

  /// A batch on its way.
  struct Work {
    std::span<const RayBundle> batch;
    BurstCursor cursor;
    LaneShare shares[kHardwareLanes];
  };

  /// The batches in flight in the order of their start.
  Work& work_at(unsigned age) { return works_[(oldest_ + age) % kMostBatches]; }

  static bool drained(const Work& work) {
    return work.cursor.done() && std::ranges::all_of(work.shares, [](const LaneShare& share) {
             return share.all_closed() && share.all_pointed();
           });
  }

  /// A clock: every lane is offered a test, and its result is taken.
  void step() {
    unsigned valid = 0, ready = kAllLanes;
    for (int n = 0; n < kHardwareLanes; ++n) {
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
      if (ready & model_->valid_o & (1u << n)) take_result(n);
    }
    model_->valid_i = valid;
    model_->ready_i = ready;
    const unsigned taken = valid & model_->ready_o;
    quiet_ = taken != 0 ? 0 : quiet_ + 1;
    if (quiet_ > kPatience)
      broken("nothing in and nothing ended for " + std::to_string(kPatience) + " clocks");
    model_.clock();
    offered_ = valid & ~taken;
    for (unsigned left = taken; left != 0; left &= left - 1) next_test(std::countr_zero(left));
  }

  [[noreturn]] static void broken(const std::string& what) {
    throw std::runtime_error("hit_test_array: " + what);
  }

  bool chance(int of_256) { return static_cast<int>(random_() & 0xFF) < of_256; }

  std::uint64_t read(Count count) {
    model_->count_select_i = count;
    model_.eval();
    return model_->counter_o;
  }

  /// The next burst of the batches goes into lane n, if there is one.
  void start_burst(int n) {
    for (unsigned age = 0; age < in_flight_; ++age) {
      Work& work = work_at(age);
      if (work.cursor.done()) continue;
      const BurstCursor::Burst burst = work.cursor.take();
      work.shares[n].bursts.push_back(burst);
      const RayBundle& bundle = work.batch[burst.bundle];
      inputs_[n] = {bundle.records, bundle.records + bundle.record_count, 0};
      const glm::vec3 direction = bundle.lane_direction(static_cast<int>(burst.lane));
      numbers_.write(model_->direction_i, n, &direction.x, 3);
      return;
    }
  }

  /// Puts the lane's next test into its slot.
  void offer_test(int n) {
    const LaneInput& lane = inputs_[n];
    numbers_.write(model_->record_i, n, &lane.record->normal.x, 16);
    std::memcpy(slot(model_->tag_i, n, sizeof lane.tag), &lane.tag, sizeof lane.tag);
    set_bit(model_->first_i, n, lane.tag == 0);
    set_bit(model_->last_i, n, lane.record + 1 == lane.end);
  }

  void next_test(int n) {
    LaneInput& lane = inputs_[n];
    ++lane.tag;
    if (++lane.record == lane.end) lane.record = nullptr;
  }

  template <class Port>
  static void set_bit(Port& port, int n, bool value) {
    port = static_cast<Port>((port & ~(1u << n)) | static_cast<unsigned>(value) << n);
  }

  /// The oldest batch of which lane n still has something to say, by `all` of LaneShare.
  LaneShare* awaited(int n, bool (LaneShare::*all)() const) {
    for (unsigned age = 0; age < in_flight_; ++age) {
      LaneShare& share = work_at(age).shares[n];
      if (!(share.*all)()) return &share;
    }
    return nullptr;
  }

  /// What ends nothing (a report, or no news at all) is no sign of life: broken hardware may say it
  /// for ever.
  void take_result(int n) {
    const unsigned kind = model_->report_o >> (2 * n) & 3;
    const bool closed = model_->closed_o >> n & 1;
    if (kind != 0 || closed) {
      LaneShare* const share = awaited(n, &LaneShare::all_closed);
      if (share == nullptr) broken("a result for no burst, lane " + std::to_string(n));
      const auto& [bundle, bundle_lane] = share->bursts[share->closed];
      if (kind != 0) {
        share->results.reports.push_back({bundle, bundle_lane,
                                          read_slot<std::uint32_t>(model_->report_tag_o, n),
                                          static_cast<TestReport::Kind>(kind)});
      }
      if (closed) {
        if (model_->found_o >> n & 1) {
          BurstHit& hit = share->results.hits.emplace_back();
          hit = {bundle, bundle_lane, read_slot<std::uint32_t>(model_->tag_o, n)};
          numbers_.read(model_->t_o, n, &hit.t, 1);
          hit.t_error = static_cast<std::uint32_t>(model_->t_error_o >> (4 * n) & 15);
        }
        ++share->closed;
        quiet_ = 0;
      }
    }
    if (model_->point_valid_o >> n & 1) {
      LaneShare* const share = awaited(n, &LaneShare::all_pointed);
      if (share == nullptr) broken("a point for no hit, lane " + std::to_string(n));
      numbers_.read(model_->point_o, n, &share->results.hits[share->pointed++].point.x, 3);
      quiet_ = 0;
    }
  }

  /// The lanes' results, each in order, into one list in the order of the batch.
  void merge(const Work& work, BurstResults& results) {
    const auto before = [](const auto& a, const auto& b) {
      return a.bundle != b.bundle ? a.bundle < b.bundle : a.lane < b.lane;
    };
    const auto append = [&](auto& to, auto part) {
      const auto old = static_cast<std::ptrdiff_t>(to.size());
      for (const LaneShare& share : work.shares) {
        to.insert(to.end(), (share.results.*part).begin(), (share.results.*part).end());
      }
      if (kHardwareLanes > 1) std::stable_sort(to.begin() + old, to.end(), before);
    };
    append(results.hits, &BurstResults::hits);
    append(results.reports, &BurstResults::reports);
  }

  Model<Top> model_;
  Numbers numbers_;
  LaneInput inputs_[kHardwareLanes];
  unsigned offered_ = 0;  // lanes whose slot holds a test that was not taken yet
  unsigned quiet_ = 0;    // clocks since something was taken, on either side
  Work works_[kMostBatches];
  unsigned oldest_ = 0, in_flight_ = 0;
  BurstStalls stalls_;
  std::mt19937_64 random_;
  bool throttled_;
};

}  // namespace raygate
