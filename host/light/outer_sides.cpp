#include <array>
#include <cstddef>
#include <glm/glm.hpp>
#include <map>
#include <numeric>
#include <unordered_map>
#include <utility>

#include "host/bvh/box_query.h"
#include "host/exact/exact.h"
#include "host/light/lights.h"

namespace raygate {
namespace {

/// Triangles that hang together by their edges; they are numbers from 0 on.
class Parts {
 public:
  explicit Parts(std::size_t count) : leads_to_(count) {
    std::iota(leads_to_.begin(), leads_to_.end(), 0u);
  }
  void join(std::uint32_t a, std::uint32_t b) { leads_to_[of(a)] = of(b); }
  /// The triangle that stands for all of a part.
  [[nodiscard]] std::uint32_t of(std::uint32_t i) {
    while (leads_to_[i] != i) i = leads_to_[i] = leads_to_[leads_to_[i]];
    return i;
  }

 private:
  std::vector<std::uint32_t> leads_to_;  // another one of the part, or itself
};

/// What is known of a part.
struct Part {
  bool is_open = false;
  double volume = 0.0;  // six times; negative where its triangles face inwards
  glm::vec3 low, high;
};

}  // namespace

std::vector<OuterSide> outer_sides(const Bvh& bvh, std::span<const std::uint32_t> primitives) {
  std::map<std::array<float, 3>, std::uint32_t> places;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>> edges;
  for (std::uint32_t i = 0; i < primitives.size(); ++i) {
    std::array<std::uint32_t, 3> numbers{};
    const Corners corners = bvh.corners_of(primitives[i]);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto next = static_cast<std::uint32_t>(places.size());
      numbers[k] =
          places.try_emplace({corners[k].x, corners[k].y, corners[k].z}, next).first->second;
    }
    for (std::size_t k = 0; k < 3; ++k) edges[{numbers[k], numbers[(k + 1) % 3]}].push_back(i);
  }
  Parts parts(primitives.size());
  for (const auto& [edge, along] : edges) {
    for (const std::uint32_t i : along) parts.join(i, along[0]);
    const auto back = edges.find({edge.second, edge.first});
    if (back != edges.end()) parts.join(back->second[0], along[0]);
  }
  std::unordered_map<std::uint32_t, std::uint32_t> part_of_slot;
  std::map<std::uint32_t, Part> found;
  for (std::uint32_t i = 0; i < primitives.size(); ++i) {
    const Corners t = bvh.corners_of(primitives[i]);
    const glm::dvec3 middle(bvh.corners_of(primitives[parts.of(i)])[0]);
    const auto [at, is_new] = found.try_emplace(parts.of(i));
    Part& part = at->second;
    if (is_new) part.low = part.high = t[0];
    part.low = glm::min(part.low, glm::min(t[0], glm::min(t[1], t[2])));
    part.high = glm::max(part.high, glm::max(t[0], glm::max(t[1], t[2])));
    part.volume += glm::dot(glm::dvec3(t[0]) - middle,
                            glm::cross(glm::dvec3(t[1]) - middle, glm::dvec3(t[2]) - middle));
    part_of_slot[primitives[i]] = parts.of(i);
  }
  for (const auto& [edge, along] : edges) {
    const auto back = edges.find({edge.second, edge.first});
    if (along.size() != 1 || back == edges.end()) found[parts.of(along[0])].is_open = true;
  }
  for (auto& entry : found) {
    const std::uint32_t number = entry.first;
    Part& part = entry.second;
    part.is_open =
        part.is_open || part.volume == 0.0 ||
        any_primitive_near(bvh, part.low, part.high, [&](std::uint32_t primitive, const Corners&) {
          const auto known = part_of_slot.find(primitive);
          return known == part_of_slot.end() || known->second != number;
        });
  }
  std::vector<OuterSide> sides(primitives.size());
  for (std::uint32_t i = 0; i < primitives.size(); ++i) {
    const Part& part = found[parts.of(i)];
    if (part.is_open) continue;
    sides[i] = part.volume > 0.0 ? OuterSide::kAlongNormal : OuterSide::kAgainstNormal;
  }
  return sides;
}

}  // namespace raygate
