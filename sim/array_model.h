// Drives a Verilated hit_test_array, whatever its number of lanes: bursts in, results out.
#pragma once

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstring>
#include <random>
#include <span>
#include <vector>

#include "sim/model.h"
#include "sim/rtl_burst_unit.h"

namespace raygate {

/// What RtlBurstUnit needs of an array.
class BurstModel {
 public:
  virtual ~BurstModel() = default;
  virtual void run(std::span<const RayBundle> batch, BurstResults& results) = 0;
  virtual BurstCounters counters() = 0;
};

/// Slot `n` of a port, `size` bytes a slot: Verilator keeps the lowest bits at the lowest address,
/// as this machine does.
template <class Port>
char* slot(Port& port, int n, std::size_t size) {
  static_assert(std::endian::native == std::endian::little);
  return reinterpret_cast<char*>(&port) + size * static_cast<std::size_t>(n);
}

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

  explicit BurstCursor(std::span<const RayBundle> batch) : batch_(batch) { settle(); }

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

/// One lane of the hardware: the burst that goes in, those that are inside, those that came out.
struct HardwareLane {
  std::vector<BurstCursor::Burst> bursts;  // all that went in, and the one that does
  std::size_t closed = 0;                  // so many of them are over
  std::size_t pointed = 0;                 // so many of `hits` have their point
  BurstResults results;
  const PolygonRecord* record = nullptr;  // the next test; null between bursts
  const PolygonRecord* end = nullptr;
  std::uint32_t tag = 0;

  void clear() {
    bursts.clear();
    results.clear();
    closed = pointed = 0;
  }
  [[nodiscard]] bool drained() const {
    return record == nullptr && closed == bursts.size() && pointed == results.hits.size();
  }
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

/// The array `Top` (a class that Verilator made), with so many lanes.
template <class Top, int kHardwareLanes>
class ArrayModel : public BurstModel {
 public:
  explicit ArrayModel(const BurstStalls& stalls)
      : stalls_(stalls),
        random_(stalls.seed),
        throttled_(stalls.no_test > 0 || stalls.not_taken > 0) {
    model_->valid_i = 0;
    model_->ready_i = 0;
    model_->count_select_i = 0;
    model_.reset();
  }

  void run(std::span<const RayBundle> batch, BurstResults& results) override {
    BurstCursor cursor(batch);
    for (HardwareLane& lane : lanes_) lane.clear();
    unsigned offered = 0;  // lanes whose slot holds a test that was not taken yet
    bool busy = true;
    while (busy) {
      busy = false;
      unsigned valid = 0, ready = kAllLanes;
      for (int n = 0; n < kHardwareLanes; ++n) {
        HardwareLane& lane = lanes_[n];
        if (!(offered >> n & 1)) {
          if (lane.record == nullptr && !cursor.done()) start_burst(batch, cursor.take(), n);
          if (lane.record != nullptr && !(throttled_ && chance(stalls_.no_test)))
            offer_test(n), valid |= 1u << n;
        } else {
          valid |= 1u << n;
        }
        if (throttled_ && chance(stalls_.not_taken)) ready &= ~(1u << n);
        if (ready & model_->valid_o & (1u << n)) take_result(n);
        busy = busy || !lane.drained();
      }
      model_->valid_i = valid;
      model_->ready_i = ready;
      const unsigned taken = valid & model_->ready_o;
      model_.clock();
      offered = valid & ~taken;
      for (unsigned left = taken; left != 0; left &= left - 1) next_test(std::countr_zero(left));
    }
    model_->valid_i = 0;
    merge(results);
  }

  BurstCounters counters() override {
    for (int i = 0; i < 3; ++i) model_.clock();  // the counters are three clocks late
    return {read(kTests),      read(kMisses),      read(kHits),       read(kDoubts),
            read(kNearTies),   read(kDistances),   3 * read(kPoints), model_.clocks(),
            read(kIdleClocks), read(kOutputStalls)};
  }

 private:
  static constexpr unsigned kAllLanes = (1u << kHardwareLanes) - 1;

  bool chance(int of_256) { return static_cast<int>(random_() & 0xFF) < of_256; }

  std::uint64_t read(Count count) {
    model_->count_select_i = count;
    model_.eval();
    return model_->counter_o;
  }

  void start_burst(std::span<const RayBundle> batch, BurstCursor::Burst burst, int n) {
    const RayBundle& bundle = batch[burst.bundle];
    HardwareLane& lane = lanes_[n];
    lane.bursts.push_back(burst);
    lane.record = bundle.records;
    lane.end = bundle.records + bundle.record_count;
    lane.tag = 0;
    const glm::vec3 direction = bundle.lane_direction(static_cast<int>(burst.lane));
    std::memcpy(slot(model_->direction_i, n, sizeof direction), &direction, sizeof direction);
    set_bit(model_->first_i, n, true);
  }

  /// Puts the lane's next test into its slot.
  void offer_test(int n) {
    const HardwareLane& lane = lanes_[n];
    std::memcpy(slot(model_->record_i, n, sizeof(PolygonRecord)), lane.record,
                sizeof(PolygonRecord));
    std::memcpy(slot(model_->tag_i, n, sizeof lane.tag), &lane.tag, sizeof lane.tag);
    set_bit(model_->first_i, n, lane.tag == 0);
    set_bit(model_->last_i, n, lane.record + 1 == lane.end);
  }

  void next_test(int n) {
    HardwareLane& lane = lanes_[n];
    ++lane.tag;
    if (++lane.record == lane.end) lane.record = nullptr;
  }

  template <class Port>
  static void set_bit(Port& port, int n, bool value) {
    port = static_cast<Port>((port & ~(1u << n)) | static_cast<unsigned>(value) << n);
  }

  void take_result(int n) {
    HardwareLane& lane = lanes_[n];
    const unsigned kind = model_->report_o >> (2 * n) & 3;
    const auto& [bundle, bundle_lane] = lane.bursts[std::min(lane.closed, lane.bursts.size() - 1)];
    if (kind != 0) {
      lane.results.reports.push_back({bundle, bundle_lane,
                                      read_slot<std::uint32_t>(model_->report_tag_o, n),
                                      static_cast<TestReport::Kind>(kind)});
    }
    if (model_->closed_o >> n & 1) {
      if (model_->found_o >> n & 1) {
        lane.results.hits.push_back({bundle,
                                     bundle_lane,
                                     read_slot<std::uint32_t>(model_->tag_o, n),
                                     read_slot<float>(model_->t_o, n),
                                     static_cast<std::uint32_t>(model_->t_error_o >> (4 * n) & 15),
                                     {}});
      }
      ++lane.closed;
    }
    if (model_->point_valid_o >> n & 1) {
      lane.results.hits[lane.pointed++].point = read_slot<glm::vec3>(model_->point_o, n);
    }
  }

  /// The lanes' results, each in order, into one list in the order of the batch.
  void merge(BurstResults& results) {
    const auto before = [](const auto& a, const auto& b) {
      return a.bundle != b.bundle ? a.bundle < b.bundle : a.lane < b.lane;
    };
    const auto append = [&](auto& to, auto part) {
      const auto old = static_cast<std::ptrdiff_t>(to.size());
      for (const HardwareLane& lane : lanes_) {
        to.insert(to.end(), (lane.results.*part).begin(), (lane.results.*part).end());
      }
      if (kHardwareLanes > 1) std::stable_sort(to.begin() + old, to.end(), before);
    };
    append(results.hits, &BurstResults::hits);
    append(results.reports, &BurstResults::reports);
  }

  Model<Top> model_;
  HardwareLane lanes_[kHardwareLanes];
  BurstStalls stalls_;
  std::mt19937_64 random_;
  bool throttled_;
};

}  // namespace raygate
