// Reference models of the ray core in C++, without timing, and of its box and set-up units.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>

#include "host/intersect/core/core_intersector.h"
#include "host/intersect/polygon_record.h"

namespace raygate {

/// The fields of a ray that box_unit reads.
struct BoxRay {
  glm::vec3 origin{0.0f};
  glm::vec3 inverse{0.0f};  ///< 1 / direction by component, rounded to nearest; infinite for 0
  float t_max = 0.0f;       ///< positive, or +infinity; hits beyond t_max do not count
};

/// The children that a ray enters, nearest first (a group in hw/ray_core/ray_core_pkg.sv).
struct BoxGroup {
  struct Entry {
    std::uint32_t enter = 0;   ///< lower bound of t, in units of 2^(exponent - 127 - 12)
    std::uint32_t offset = 0;  ///< first line of the child, relative to `base`
    std::uint32_t count = 0;   ///< number of triangles of a leaf; 0: an inner node

    friend bool operator==(const Entry&, const Entry&) = default;
  };

  std::uint32_t base = 0, exponent = 0;
  int size = 0;
  std::array<Entry, NodeLine::kChildren> entry{};

  friend bool operator==(const BoxGroup&, const BoxGroup&) = default;
};

[[nodiscard]] BoxGroup enter_boxes(const NodeLine& node, const BoxRay& ray);

/// Returns whether the entry is surely beyond `limit`, which is at least 0; +infinity: no limit.
[[nodiscard]] bool is_beyond(const BoxGroup& group, const BoxGroup::Entry& entry, float limit);

/// A polygon record computed in binary32, with larger bounds than make_record's. Its d is NaN if
/// the sign of d is not sure, or if the normal N or d is too inaccurate for a sure hit.
struct SetUpRecord {
  PolygonRecord record;
  std::uint32_t normal_error = 0;    ///< number of bits that cancelled in N, unless d is NaN
  std::uint32_t distance_error = 0;  ///< number of bits that cancelled in d, unless d is NaN
};

/// Returns the record that triangle_test computes, bit for bit, also for NaN and infinities.
[[nodiscard]] SetUpRecord set_up(const glm::vec3& origin, const FloatCorners& triangle);

/// Returns whether a hit is sure (set_up_pkg::is_good_hit). `grazing` is HitDistance::error.
[[nodiscard]] bool is_good_hit(const SetUpRecord& set_up, std::uint32_t grazing);

/// Returns e such that fewer than 2^e floats lie between t of a good hit and the exact t
/// (set_up_pkg::t_error_exponent).
[[nodiscard]] std::uint32_t t_error_exponent(const SetUpRecord& set_up, std::uint32_t grazing);

/// A ray core with the hardware's bits in boxes, records and tests. The hardware overlaps tests, so
/// it may do more tests and report other doubts. Reading beyond `lines` is a memory error.
class ReferenceCore : public CoreUnit {
 public:
  /// See ray_core.sv for `stack_depth` and `exact`.
  explicit ReferenceCore(int stack_depth = kStackDepth, bool exact = false)
      : stack_depth_(static_cast<std::size_t>(stack_depth)), exact_(exact) {}

  void trace(std::span<const MemoryLine> lines, std::span<const CoreRay> rays,
             std::vector<CoreResult>& results) override;
  [[nodiscard]] CoreCounters counters() const override { return counters_; }
  [[nodiscard]] bool is_exact() const override { return exact_; }

  static constexpr int kStackDepth = 8;

 private:
  std::size_t stack_depth_;
  bool exact_;
  CoreCounters counters_;
};

}  // namespace raygate
