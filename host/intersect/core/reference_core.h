// Reference core: the ray core in C++ without clocks, one ray after the other.
#pragma once

#include "host/intersect/core/core_unit.h"

namespace raygate {

/// Boxes, records and tests have the hardware's bits. Tests are done one after the other; the
/// hardware overlaps them, so it can do more tests and leave other doubts. Lines that trace() is
/// not given are memory errors.
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
