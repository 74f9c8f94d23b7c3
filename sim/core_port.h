// One Verilated ray_core and the words at its ports, clock by clock.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "host/intersect/core/core_intersector.h"
#include "host/intersect/core/linked_core.h"
#include "sim/model.h"

namespace raygate {

/// Decodes a 256-bit result of ray_core_axi (layout: hw/ray_core/registers.md).
inline CoreResult result_of(const std::array<std::uint32_t, 8>& words) {
  CoreResult result;
  result.kind = static_cast<CoreResult::Kind>(words[0] & 1);
  result.found = (words[0] >> 1 & 1) != 0;
  result.error = static_cast<CoreResult::Error>(words[0] >> 2 & 7);
  result.t_error = words[0] >> 5 & 31;
  result.tag = words[1];
  result.tests = words[7];
  result.triangle = words[2];
  result.t = std::bit_cast<float>(words[3]);
  for (int k = 0; k < 3; ++k) result.point[k] = std::bit_cast<float>(words[4 + k]);
  return result;
}

/// Offers a ray at the ray port of `top`, a Verilated ray_core or ray_core_axi.
template <class Top>
void put_ray(Top& top, const CoreRay& ray) {
  std::memset(&top.ray_i, 0, sizeof top.ray_i);
  PackedFields fields(top.ray_i);  // ray_core_pkg::ray_t
  fields.put(ray.tag);
  fields.put(ray.any_hit, 1);
  fields.put(ray.source_id);
  fields.put(ray.skip_id);
  fields.put(std::bit_cast<std::uint32_t>(ray.t_max), 31);
  fields.put(ray.ray.direction);
  fields.put(ray.ray.origin);
  top.ray_valid_i = 1;
}

/// Returns the result at the result port of `top`, a Verilated ray_core.
template <class Top>
CoreResult result_at(const Top& top) {
  return unpack_result(top.result_o);
}

/// One ray core. `Top` is Verilator's class of ray_core; `Holder` is Model, or WaveModel to write
/// waveforms.
template <class Top, template <class> class Holder = Model>
class CorePort {
 public:
  CorePort() {
    model_->invalidate_i = model_->abort_i = 0;
    model_->ray_valid_i = 0;
    model_->result_ready_i = 0;
    model_->read_ready_i = 0;
    model_->line_valid_i = 0;
    model_.reset();
  }

  Holder<Top>& model() { return model_; }
  [[nodiscard]] const CoreCounters& counters() const { return counters_; }
  [[nodiscard]] std::uint64_t clocks() const { return model_.clocks(); }

  /// Resets the core in mid-run: everything in flight is lost.
  void reset() {
    model_->ray_valid_i = model_->line_valid_i = 0;
    model_.reset();
    rays_ = 0;
  }

  /// Empties the core's caches and sets the size of memory to `lines` lines; takes one clock.
  void invalidate(std::size_t lines) {
    model_->lines_i = static_cast<std::uint32_t>(lines);
    model_->invalidate_i = 1;
    model_.clock();
    model_->invalidate_i = 0;
  }

  // ---- Rays

  [[nodiscard]] bool is_offering() const { return model_->ray_valid_i != 0; }
  /// Offers a ray until the core takes it. Must not be called while is_offering().
  void offer(const CoreRay& ray) {
    put_ray(*model_, ray);
    ++rays_;
  }
  /// Returns the number of rays offered whose final results have not been taken.
  [[nodiscard]] int rays() const { return rays_; }

  // ---- Results

  /// Sets the result port's ready input; returns whether a result is taken in this clock.
  bool take_result(bool ready) {
    model_->result_ready_i = ready;
    const bool taken = ready && model_->result_valid_o != 0;
    if (taken && result().kind == CoreResult::Kind::kEnd) --rays_;
    return taken;
  }
  [[nodiscard]] bool has_result() const { return model_->result_valid_o != 0; }
  [[nodiscard]] CoreResult result() const { return result_at(*model_); }

  // ---- Memory

  /// Returns whether lines are in flight or about to be requested; memory must not change then.
  [[nodiscard]] bool is_busy_with_memory() const { return model_->outstanding_o != 0; }
  /// Returns whether the core requests a line; line() is its number and tag() the request's tag.
  [[nodiscard]] bool is_reading() const { return model_->read_valid_o != 0; }
  [[nodiscard]] std::uint32_t line() const { return model_->read_line_o; }
  [[nodiscard]] std::uint64_t tag() const { return model_->read_id_o; }
  void set_read_ready(bool ready) { model_->read_ready_i = ready; }
  /// Returns whether put() may be called: the core has taken the line put before.
  [[nodiscard]] bool has_room() const { return model_->line_valid_i == 0; }
  void put(const MemoryLine& line, bool is_error, std::uint64_t tag) {
    model_->line_valid_i = 1;
    model_->line_error_i = is_error;
    model_->line_id_i = tag;
    std::memcpy(&model_->line_i, &line, sizeof line);
  }

  // ---- The clock

  void clock() {
    const bool ray_taken = (model_->ray_valid_i & model_->ray_ready_o) != 0;
    const bool line_taken = (model_->line_valid_i & model_->line_ready_o) != 0;
    count();
    model_.clock();
    if (ray_taken) model_->ray_valid_i = 0;
    if (line_taken) model_->line_valid_i = 0;
  }

 private:
  /// Adds this clock's events, one bit each in the order of ray_core_pkg::event_e.
  void count() {
    const unsigned events = model_->events_o;
    counters_.rays += events & 1;
    counters_.nodes += events >> 1 & 1;
    counters_.tests += events >> 2 & 1;
    counters_.hits += events >> 3 & 1;
    counters_.misses += events >> 4 & 1;
    counters_.edge_doubts += events >> 5 & 1;
    counters_.depth_doubts += events >> 6 & 1;
    counters_.overflows += events >> 7 & 1;
    counters_.lines += events >> 8 & 1;
    counters_.waits += events >> 9 & 1;
    counters_.exact_clocks += events >> 10 & 1;
  }

  Holder<Top> model_;
  CoreCounters counters_;
  int rays_ = 0;
};

}  // namespace raygate
