// The ray core in C++, without its clocks: the same units, one ray after the other.
#pragma once

#include "host/find/core/core_unit.h"

namespace raygate {

/// Boxes, records and tests have the bits of the hardware's. The order of its tests is that of a
/// core which waits for each; so the hardware, which does not, may test more, and leave other
/// doubts.
class ReferenceCore : public CoreUnit {
 public:
  /// The lines of a MemoryImage; they must outlive this. `stack_depth`: see ray_core.sv.
  explicit ReferenceCore(std::span<const MemoryLine> lines, int stack_depth = kStackDepth)
      : lines_(lines), stack_depth_(stack_depth) {}

  void trace(std::span<const CoreRay> rays, std::vector<CoreResult>& results) override;
  [[nodiscard]] CoreCounters counters() const override { return counters_; }

 private:
  static constexpr int kStackDepth = 8;

  void trace(const CoreRay& ray, std::vector<CoreResult>& results);

  std::span<const MemoryLine> lines_;
  int stack_depth_;
  CoreCounters counters_;
};

}  // namespace raygate
