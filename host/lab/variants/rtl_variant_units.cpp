#include "host/lab/variants/rtl_variant_units.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstring>
#include <utility>
#include <vector>

#include "host/find/unit/serial_hit_tester.h"
#include "host/lab/variants/variant_hit_tester.h"
#include "host/lab/variants/variant_models.h"
#include "sim/model.h"

namespace raygate {
namespace {

/// Words of a format of any width packed into a port, the first at the lowest bits.
class PackedWords {
 public:
  explicit PackedWords(const Arithmetic& math) : math_(math) {}

  void push(float x) {
    std::uint64_t word = math_.to_word(x);
    const std::size_t at = bits_ / 64, shift = bits_ % 64;
    words_[at] |= word << shift;
    if (shift != 0) words_[at + 1] |= word >> (64 - shift);
    bits_ += static_cast<std::size_t>(math_.word_bits());
  }
  void push(const glm::vec3& v) {
    for (int k = 0; k < 3; ++k) push(v[k]);
  }

  template <class Port>
  void write(Port& port) const {
    static_assert(sizeof(Port) <= sizeof words_);
    std::memcpy(&port, words_.data(), sizeof port);
  }

 private:
  const Arithmetic& math_;
  std::array<std::uint64_t, 9> words_{};  // sixteen of 32 bits, and one to spill into
  std::size_t bits_ = 0;
};

/// Word `n` of a port.
template <class Port>
float word_at(const Arithmetic& math, const Port& port, int n) {
  std::array<std::uint64_t, 3> words{};
  static_assert(sizeof port <= sizeof words);
  std::memcpy(words.data(), &port, sizeof port);
  const std::size_t bit = static_cast<std::size_t>(n * math.word_bits());
  const std::size_t at = bit / 64, shift = bit % 64;
  std::uint64_t word = words[at] >> shift;
  if (shift != 0 && at + 1 < words.size()) word |= words[at + 1] << (64 - shift);
  const std::uint64_t mask = (std::uint64_t{1} << math.word_bits()) - 1;
  return math.from_word(static_cast<std::uint32_t>(word & mask));
}

template <class Top>
class RtlVariantBurstUnit : public BurstUnit {
 public:
  explicit RtlVariantBurstUnit(const Arithmetic& math) : math_(math) {
    model_->valid_i = 0;
    model_->ready_i = 1;
    model_.reset();
  }

  void run(std::span<const RayBundle> batch, BurstResults& results) override {
    bursts_.clear();
    closed_ = 0;
    pointed_ = first_hit_ = results.hits.size();
    for (std::uint32_t i = 0; i < batch.size(); ++i) {
      for (LaneMask lanes = batch[i].lanes; lanes != 0 && batch[i].record_count != 0;
           lanes &= lanes - 1) {
        send_burst(batch[i], i, static_cast<std::uint32_t>(std::countr_zero(lanes)), results);
      }
    }
    model_->valid_i = 0;
    while (closed_ < bursts_.size() || pointed_ < results.hits.size()) clock(results);
  }

  [[nodiscard]] BurstCounters counters() const override {
    BurstCounters counters = counters_;
    counters.clocks = model_.clocks();
    return counters;
  }

 private:
  static constexpr std::size_t kEvents = 9;  // hit_test_pkg::count_e

  void send_burst(const RayBundle& bundle, std::uint32_t index, std::uint32_t lane,
                  BurstResults& results) {
    bursts_.emplace_back(index, lane);
    PackedWords direction(math_);
    direction.push(bundle.lane_direction(static_cast<int>(lane)));
    direction.write(model_->direction_i);
    for (std::uint32_t i = 0; i < bundle.record_count; ++i) {
      const PolygonRecord& record = bundle.records[i];
      PackedWords words(math_);
      words.push(record.normal);
      words.push(record.d);
      for (const glm::vec3& edge : record.edges) words.push(edge);
      for (const float bound : record.bounds) words.push(bound);
      words.write(model_->record_i);
      model_->tag_i = i;
      model_->first_i = i == 0;
      model_->last_i = i + 1 == bundle.record_count;
      model_->valid_i = 1;
      while (!model_->ready_o) clock(results);
      clock(results);
    }
  }

  /// One clock, and what comes out before it.
  void clock(BurstResults& results) {
    if (model_->valid_o) take(results);
    model_.eval();
    const std::uint32_t events = model_->events_o;
    std::uint64_t* const counts[kEvents] = {
        &counters_.tests,       &counters_.misses,      &counters_.hits,
        &counters_.doubts,      &counters_.near_ties,   &counters_.distances,
        &counters_.coordinates, &counters_.idle_clocks, &counters_.output_stalls};
    for (std::size_t i = 0; i < kEvents; ++i) *counts[i] += (events >> i & 1) * (i == 6 ? 3 : 1);
    model_.clock();
  }

  void take(BurstResults& results) {
    const auto& [bundle, lane] = bursts_[std::min(closed_, bursts_.size() - 1)];
    if (const unsigned kind = model_->report_o; kind != 0) {
      results.reports.push_back(
          {bundle, lane, model_->report_tag_o, static_cast<TestReport::Kind>(kind)});
    }
    if (model_->closed_o) {
      if (model_->found_o) {
        results.hits.push_back({bundle, lane, model_->tag_o, word_at(math_, model_->t_o, 0),
                                model_->t_error_o, glm::vec3{0.0f}});
      }
      ++closed_;
    }
    if (model_->point_valid_o) {
      glm::vec3& point = results.hits[pointed_++].point;
      for (int k = 0; k < 3; ++k) point[k] = word_at(math_, model_->point_o, k);
    }
  }

  Arithmetic math_;
  Model<Top> model_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> bursts_;  // all that went in
  std::size_t closed_ = 0;                                       // so many of them are over
  std::size_t first_hit_ = 0, pointed_ = 0;  // results.hits from the first, and the next to get P
  BurstCounters counters_;
};

template <class Top>
class RtlVariantPlaneUnit : public PlaneUnit {
 public:
  explicit RtlVariantPlaneUnit(const Arithmetic& math) : math_(math) {
    model_->valid_i = 0;
    model_.reset();
  }

  void intersect(std::span<const PlaneTest> tests, std::span<glm::vec3> points) override {
    assert(tests.size() == points.size());
    if (tests.empty()) return;
    glm::vec3 unread;  // what the bus has before the first result
    glm::vec3* point = &unread;
    model_->valid_i = 1;
    for (std::size_t i = 0; i < tests.size(); ++i) {
      for (int k = 0; k < 3; ++k) (*point)[k] = exchange(tests[i].direction[k]);
      for (int k = 0; k < 3; ++k) (void)exchange(tests[i].normal[k]);
      (void)exchange(tests[i].d);
      point = &points[i];
    }
    model_->valid_i = 0;
    for (int k = 0; k < 3; ++k) (*point)[k] = exchange(0.0f);
  }

  [[nodiscard]] std::uint64_t clocks() const override { return model_.clocks(); }

 private:
  float exchange(float word) {
    model_->bus_i = math_.to_word(math_.read(word));
    model_.clock();
    return math_.from_word(model_->bus_o);
  }

  Arithmetic math_;
  Model<Top> model_;
};

/// Whether a model with these parameters computes as the variant does.
bool matches(const Variant& variant, int exponent_bits, int digits, int rounding,
             int quotient_digits) {
  const Arithmetic& math = variant.math;
  return variant.has_hardware() && math.exponent_bits == exponent_bits && math.digits == digits &&
         math.rounding == static_cast<Rounding>(rounding) &&
         math.quotient_digits == quotient_digits;
}

}  // namespace

std::unique_ptr<BurstUnit> make_rtl_burst_unit(const Variant& variant) {
#define RAYGATE_PIPELINE_MODEL(top, ...) \
  if (matches(variant, __VA_ARGS__))     \
    return std::make_unique<RtlVariantBurstUnit<top>>(variant.math);
  RAYGATE_PIPELINE_MODELS
  return nullptr;
}

std::unique_ptr<PlaneUnit> make_rtl_plane_unit(const Variant& variant) {
#define RAYGATE_SERIAL_MODEL(top, ...) \
  if (matches(variant, __VA_ARGS__))   \
    return std::make_unique<RtlVariantPlaneUnit<top>>(variant.math);
  RAYGATE_SERIAL_MODELS
  return nullptr;
}

std::unique_ptr<HitTester> make_rtl_variant_tester(const Variant& variant) {
  if (variant.unit == Variant::Unit::kSerial) {
    auto unit = make_rtl_plane_unit(variant);
    return unit ? std::make_unique<SerialHitTester>(std::move(unit)) : nullptr;
  }
  auto unit = make_rtl_burst_unit(variant);
  return unit ? std::make_unique<VariantHitTester>(variant, std::move(unit)) : nullptr;
}

}  // namespace raygate
