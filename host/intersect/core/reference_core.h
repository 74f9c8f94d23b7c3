// Reference core: the ray core in C++ without clocks, one ray after the other.
#pragma once

#include "host/intersect/core/core_unit.h"

namespace raygate {

/// Boxes, records and tests have the bits of the hardware's. The order of its tests is that of a
/// core which waits for each; so the hardware, which does not, may test more, and leave other
/// doubts. Lines beyond those that trace() is given come with an error.
class ReferenceCore : public CoreUnit {
 public:
  /// `stack_depth`, `exact`: see ray_core.sv.
  explicit ReferenceCore(int stack_depth = kStackDepth, bool exact = false)
      : stack_depth_(stack_depth), exact_(exact) {}

  void trace(std::span<const MemoryLine> lines, std::span<const CoreRay> rays,
             std::vector<CoreResult>& results) override;
  [[nodiscard]] CoreCounters counters() const override { return counters_; }
  [[nodiscard]] bool is_exact() const override { return exact_; }

  static constexpr int kStackDepth = 8;

 private:
  void trace(std::span<const MemoryLine> lines, const CoreRay& ray,
             std::vector<CoreResult>& results);

  int stack_depth_;
  bool exact_;
  CoreCounters counters_;
};

}  // namespace raygate
