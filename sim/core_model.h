// Drives a Verilated ray_core and the memory behind it: rays in, results out.
#pragma once

#include <bit>
#include <cstring>
#include <random>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "host/find/core/core_unit.h"
#include "sim/memory_model.h"
#include "sim/model.h"
#include "sim/rtl_core.h"

namespace raygate {

/// The core `Top` (a class that Verilator made). Hardware that is broken is told by
/// std::runtime_error: no line and no result for kPatience clocks, a ray that ends twice, a line
/// that is not there.
template <class Top>
class CoreModel : public CoreUnit {
 public:
  CoreModel(const MemoryTiming& timing, const CoreStalls& stalls)
      : memory_(timing), stalls_(stalls), random_(stalls.seed) {
    model_->invalidate_i = 0;
    model_->ray_valid_i = 0;
    model_->result_ready_i = 0;
    model_->read_ready_i = 0;
    model_->line_valid_i = 0;
    model_.reset();
  }

  void trace(std::span<const MemoryLine> lines, std::span<const CoreRay> rays,
             std::vector<CoreResult>& results) override {
    memory_.load(lines);
    invalidate();
    std::size_t sent = 0, ended = 0;
    unsigned quiet = 0;
    while (ended < rays.size()) {
      // A ray
      if (model_->ray_valid_i == 0 && sent < rays.size() && !chance(stalls_.no_ray))
        offer(rays[sent]);
      const bool taken = (model_->ray_valid_i & model_->ray_ready_o) != 0;
      // A result
      model_->result_ready_i = chance(stalls_.not_taken) ? 0 : 1;
      if ((model_->result_valid_o & model_->result_ready_i) != 0) {
        results.push_back(result());
        ended += results.back().kind == CoreResult::Kind::kEnd;
        quiet = 0;
      }
      // A request, and a line
      memory_.clock();
      model_->read_ready_i = memory_.ready();
      if ((model_->read_valid_o & model_->read_ready_i) != 0) {
        if (memory_.read(model_->read_line_o, model_->read_tag_o)) {
          broken("asks for line " + std::to_string(model_->read_line_o));
        }
        quiet = 0;
      }
      if (!line_there_ && memory_.valid()) {
        model_->line_valid_i = 1;
        model_->line_tag_i = memory_.tag();
        std::memcpy(&model_->line_i, &memory_.line(), sizeof(MemoryLine));
        memory_.pop();
        line_there_ = true;
      }
      const bool line_taken = line_there_ && model_->line_ready_o != 0;
      if (++quiet > kPatience)
        broken("nothing asked for and nothing told for " + std::to_string(kPatience) + " clocks");
      model_.clock();
      count();
      if (taken) {
        model_->ray_valid_i = 0;
        ++sent;
      }
      if (line_taken) {
        model_->line_valid_i = 0;
        line_there_ = false;
      }
    }
    model_->result_ready_i = 0;
    if (sent != rays.size() || model_->result_valid_o != 0) broken("a ray ended twice");
  }

  [[nodiscard]] CoreCounters counters() const override {
    CoreCounters counters = counters_;
    counters.clocks = model_.clocks();
    return counters;
  }

 private:
  static constexpr unsigned kPatience = 10'000;

  [[noreturn]] static void broken(const std::string& what) {
    throw std::runtime_error("ray_core: " + what);
  }

  /// Empties the core's caches.
  void invalidate() {
    model_->invalidate_i = 1;
    model_.clock();
    model_->invalidate_i = 0;
  }

  bool chance(int of_256) { return of_256 != 0 && static_cast<int>(random_() & 0xFF) < of_256; }

  void offer(const CoreRay& ray) {
    std::memcpy(&model_->ray_origin_i, &ray.ray.origin, sizeof ray.ray.origin);
    std::memcpy(&model_->ray_direction_i, &ray.ray.direction, sizeof ray.ray.direction);
    model_->ray_limit_i = std::bit_cast<std::uint32_t>(ray.limit);
    model_->ray_ignored_i = ray.ignored;
    model_->ray_start_i = ray.start;
    model_->ray_any_hit_i = ray.any_hit;
    model_->ray_every_box_i = ray.every_box;
    model_->ray_tag_i = ray.tag;
    model_->ray_valid_i = 1;
  }

  CoreResult result() const {
    CoreResult result;
    result.kind = static_cast<CoreResult::Kind>(model_->result_kind_o);
    result.found = model_->result_found_o != 0;
    result.tag = model_->result_tag_o;
    result.triangle = model_->result_triangle_o;
    result.t = std::bit_cast<float>(model_->result_t_o);
    result.t_error = model_->result_t_error_o;
    std::memcpy(&result.point, &model_->result_point_o, sizeof result.point);
    result.tests = model_->result_tests_o;
    result.line = model_->result_line_o;
    result.nodes = model_->result_nodes_o;
    return result;
  }

  /// ray_core_pkg::event_e.
  void count() {
    const unsigned events = model_->events_o;
    counters_.rays += events & 1;
    counters_.nodes += events >> 1 & 1;
    counters_.triangles += events >> 2 & 1;
    counters_.hits += events >> 3 & 1;
    counters_.misses += events >> 4 & 1;
    counters_.doubts += events >> 5 & 1;
    counters_.near_ties += events >> 6 & 1;
    counters_.rests += events >> 7 & 1;
    counters_.lines += events >> 8 & 1;
  }

  mutable Model<Top> model_;
  MemoryModel memory_;
  CoreStalls stalls_;
  std::mt19937_64 random_;
  CoreCounters counters_;
  bool line_there_ = false;  // offered, and not taken
};

}  // namespace raygate
