// Drives Verilated ray cores and the memory behind them: rays in, results out.
#pragma once

#include <algorithm>
#include <deque>
#include <random>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "host/intersect/core/core_intersector.h"
#include "sim/core_port.h"
#include "sim/memory_model.h"
#include "sim/rtl_core.h"

namespace raygate {

/// Cores of class `Top`, each in a `Holder` (see CorePort), clocked together. The cores take turns
/// at one memory port, which accepts one request and returns one line per clock. Throws
/// std::runtime_error if a core is broken: it makes no progress for longer than patience(), ends a
/// ray twice, or reports that no line is in flight although one is.
template <class Top, template <class> class Holder = Model>
class CoreModel : public CoreUnit {
 public:
  explicit CoreModel(const MemoryTiming& timing, const CoreStalls& stalls = {},
                     const CoreSet& set = {})
      : cores_(static_cast<std::size_t>(set.cores)),
        set_(set),
        memory_(timing),
        stalls_(stalls),
        random_(stalls.seed) {}

  /// Returns the model of the only core, or of the first one.
  Holder<Top>& model() { return cores_.front().model(); }

  void trace(std::span<const MemoryLine> lines, std::span<const CoreRay> rays,
             std::vector<CoreResult>& results) override {
    memory_.load(lines);
    lacking_ = 0;
    for (Core& core : cores_) core.invalidate(lines.size());
    std::size_t sent = 0, ended = 0;
    const std::uint64_t before = visits();
    std::uint64_t visited = 0, quiet = 0;
    while (ended < rays.size()) {
      for (Core& core : cores_) {
        if (sent < rays.size() && !core.is_offering() && !chance(stalls_.no_ray)) {
          core.offer(rays[sent++]);
        }
        if (core.take_result(!chance(stalls_.not_taken))) {
          results.push_back(core.result());
          if (results.back().error == CoreResult::Error::kMemory) results.back().line = lacking_;
          ended += results.back().kind == CoreResult::Kind::kEnd;
          quiet = 0;
        }
      }
      if (serve_memory()) quiet = 0;
      const std::uint64_t now = visits() - before;
      // More visits are no progress: a ray visits each line once, and its hit's line once more.
      if (now != std::exchange(visited, now) && now <= 2 * sent * lines.size()) quiet = 0;
      if (++quiet > patience(sent + visited)) {
        broken("nothing asked for and nothing told for " + std::to_string(quiet) + " clocks; of " +
               std::to_string(sent) + " rays " + std::to_string(sent - ended) + " have not ended");
      }
      for (Core& core : cores_) core.clock();
    }
    for (Core& core : cores_) core.take_result(false);
    while (std::ranges::any_of(cores_, &Core::is_busy_with_memory)) {
      serve_memory();
      if (++quiet > kPatience) broken("waits for a line that it does not ask for");
      for (Core& core : cores_) core.clock();
    }
    if (!memory_.is_idle()) broken("lines are on their way, and it says that none is");
    for (const Core& core : cores_) {
      if (core.rays() != 0 || core.is_offering() || core.has_result()) broken("a ray ended twice");
    }
  }

  /// Traces for `clocks` clocks, then resets the cores in mid-run; their results are dropped.
  void abandon(std::span<const MemoryLine> lines, std::span<const CoreRay> rays, unsigned clocks) {
    memory_.load(lines);
    for (Core& core : cores_) core.invalidate(lines.size());
    for (std::size_t sent = 0; clocks != 0; --clocks) {
      for (Core& core : cores_) {
        if (sent < rays.size() && !core.is_offering()) core.offer(rays[sent++]);
        core.take_result(!chance(stalls_.not_taken));
      }
      serve_memory();
      for (Core& core : cores_) core.clock();
    }
    for (Core& core : cores_) core.reset();
    while (!memory_.is_idle()) memory_.pop();
  }

  [[nodiscard]] bool is_exact() const override { return set_.exact; }
  [[nodiscard]] CoreCounters counters() const override {
    CoreCounters sum;
    for (const Core& core : cores_) add_counters(sum, core.counters());
    sum.clocks = cores_.front().clocks();
    return sum;
  }

 private:
  using Core = CorePort<Top, Holder>;
  static constexpr std::uint64_t kPatience = 10'000;       // clocks
  static constexpr std::uint64_t kQuestionClocks = 4'000;  // per exact decision: exact_unit.sv
  static constexpr std::uint64_t kMostQuestions = 3 * kTableRays + 128;  // queued in a core
  static constexpr unsigned kCoreBit = 48;  // in memory tags: the core's number starts at this bit

  [[noreturn]] static void broken(const std::string& what) {
    throw std::runtime_error("ray_core: " + what);
  }

  /// Returns the most clocks for which a correct core shows no progress while up to `questions`
  /// exact decisions are open.
  [[nodiscard]] std::uint64_t patience(std::uint64_t questions) const {
    return kPatience + (is_exact() ? kQuestionClocks * std::min(questions, kMostQuestions) : 0);
  }
  [[nodiscard]] std::uint64_t visits() const {
    std::uint64_t sum = 0;
    for (const Core& core : cores_) sum += core.counters().nodes + core.counters().tests;
    return sum;
  }

  bool chance(int of_256) { return of_256 != 0 && static_cast<int>(random_() & 0xFF) < of_256; }

  /// Simulates one clock of the memory: takes at most one request, from the core whose turn it is,
  /// and returns at most one line. Returns whether a request was taken.
  bool serve_memory() {
    memory_.clock();
    bool taken = false;
    const std::size_t count = cores_.size(), first = turn_;
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t number = (first + i) % count;
      Core& core = cores_[number];
      const bool served = memory_.ready() && !taken && core.is_reading();
      core.set_read_ready(served);
      if (!served) continue;
      memory_.read(core.line(), std::uint64_t{number} << kCoreBit | core.tag());
      turn_ = (number + 1) % count;
      taken = true;
    }
    if (memory_.valid()) {
      Core& core = cores_[memory_.tag() >> kCoreBit];
      if (core.has_room()) {
        core.put(memory_.line(), memory_.is_error(),
                 memory_.tag() & ((std::uint64_t{1} << kCoreBit) - 1));
        if (memory_.is_error()) lacking_ = memory_.number();
        memory_.pop();
      }
    }
    return taken;
  }

  std::deque<Core> cores_;
  CoreSet set_;
  MemoryModel memory_;
  CoreStalls stalls_;
  std::mt19937_64 random_;
  std::uint32_t lacking_ = 0;  // number of the last line that memory answered with an error
  std::size_t turn_ = 0;       // index of the core that is served first
};

}  // namespace raygate
