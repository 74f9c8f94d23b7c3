// Reference model of the ray core in C++, without timing: one ray at a time.
#pragma once

#include "host/intersect/core/core_unit.h"

namespace raygate {

/// Boxes, records and tests are bit-exact. Tests are sequential, while the hardware overlaps them,
/// so it may do more tests and report other doubts. Reading beyond `lines` is a memory error.
class ReferenceCore : public CoreUnit {
 public:
  /// See ray_core.sv for `stack_depth` and `exact`.
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
