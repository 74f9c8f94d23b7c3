// Bit-exact C++ reference model of the ray core's box unit.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>

#include "host/intersect/core/memory_image.h"

namespace raygate {

/// The fields of a ray that box_unit reads.
struct BoxRay {
  glm::vec3 origin{0.0f};
  glm::vec3 inverse{0.0f};  ///< 1 / I_k, rounded to nearest; infinite if I_k is 0
  float t_max = 0.0f;       ///< positive or +infinity: hits beyond it do not count
  bool no_cull = false;     ///< the ray enters all children
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

/// Returns whether the entry is surely beyond `limit`, at least 0; +infinity: no limit.
[[nodiscard]] bool is_beyond(const BoxGroup& group, const BoxGroup::Entry& entry, float limit);

}  // namespace raygate
