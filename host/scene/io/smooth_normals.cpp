#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <vector>

#include "host/base/elementary.h"
#include "host/scene/io/mesh_builder.h"

namespace raygate {
namespace {

/// A corner of a triangle: 3 times the triangle's index plus 0, 1 or 2.
using Corner = std::uint32_t;

Corner next(Corner corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }

/// The edge from a corner to the next one. `low` and `high` number the positions of its ends.
struct Edge {
  std::uint32_t low, high;
  Corner corner;
  bool is_forward;  ///< from `low` to `high`
};

/// Returns a number for each position; equal positions get the same number.
std::vector<std::uint32_t> numbers_of(const Scene& scene) {
  std::vector<std::uint32_t> order(scene.positions.size()), numbers(scene.positions.size());
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::sort(order, {}, [&](std::uint32_t i) {
    const glm::dvec3 at = scene.vertex(i);
    return std::tuple(at.x, at.y, at.z, i);
  });
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool is_same = i > 0 && scene.vertex(order[i]) == scene.vertex(order[i - 1]);
    numbers[order[i]] = is_same ? numbers[order[i - 1]] : order[i];
  }
  return numbers;
}

}  // namespace

void add_smooth_normals(std::span<const std::uint32_t> groups, std::optional<double> angle,
                        Scene& scene) {
  const auto is_wanted = [&](std::size_t triangle) {
    const Triangle& face = scene.triangles[triangle];
    return !is_left_out(face) && face.normals[0] == kNoIndex && (angle || groups[triangle] != 0);
  };
  const auto position = [&](Corner corner) {
    return scene.vertex(scene.triangles[corner / 3].vertices[corner % 3]);
  };
  const auto face_normal = [&](std::size_t triangle) {
    const auto first = static_cast<Corner>(3 * triangle);
    const glm::dvec3 a = position(first);
    return glm::normalize(glm::cross(position(first + 1) - a, position(first + 2) - a));
  };
  // Face normal at a corner, times the sine of its angle over the product of both side lengths.
  const auto weighted_normal = [&](Corner corner) {
    const glm::dvec3 at = position(corner), u = position(next(corner)) - at,
                     v = position(next(next(corner))) - at;
    return glm::cross(u, v) / (glm::dot(u, u) * glm::dot(v, v));
  };
  const double least_cosine = angle ? sine_cosine(*angle / 360.0).cosine : 0.0;
  const auto is_smooth = [&](std::size_t a, std::size_t b) {
    if (!angle) return groups[a] == groups[b];
    return glm::dot(face_normal(a), face_normal(b)) >= least_cosine - 1e-12;
  };

  std::vector<Edge> edges;
  const std::vector<std::uint32_t> numbers = numbers_of(scene);
  for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
    if (!is_wanted(i)) continue;
    const auto& vertices = scene.triangles[i].vertices;
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t from = numbers[vertices[k]], to = numbers[vertices[(k + 1) % 3]];
      edges.push_back(
          {std::min(from, to), std::max(from, to), static_cast<Corner>(3 * i + k), from < to});
    }
  }
  if (edges.empty()) return;
  std::ranges::sort(edges, {},
                    [](const Edge& edge) { return std::tuple(edge.low, edge.high, edge.corner); });

  const auto count = static_cast<Corner>(3 * scene.triangles.size());
  // A union-find forest of corners connected by smooth edges. Roots refer to themselves.
  std::vector<Corner> joined(count);
  std::iota(joined.begin(), joined.end(), 0u);
  std::vector<bool> is_joined(count);
  const auto root = [&](Corner corner) {
    for (; joined[corner] != corner; corner = joined[corner]) {
      joined[corner] = joined[joined[corner]];
    }
    return corner;
  };
  const auto join = [&](Corner a, Corner b) {
    is_joined[a] = is_joined[b] = true;
    const auto [low, high] = std::minmax({root(a), root(b)});
    joined[high] = low;
  };
  for (auto first = edges.begin(), end = first; first != edges.end(); first = end) {
    const auto is_same = [&](const Edge& e) {
      return e.low == first->low && e.high == first->high;
    };
    end = std::find_if_not(first, edges.end(), is_same);
    const Edge &a = *first, &b = *(end - 1);
    if (end - first != 2 || a.is_forward == b.is_forward) continue;
    if (!is_smooth(a.corner / 3, b.corner / 3)) continue;
    join(a.corner, next(b.corner));
    join(next(a.corner), b.corner);
  }

  std::vector<glm::dvec3> sums(count, glm::dvec3(0.0));
  for (Corner corner = 0; corner < count; ++corner) {
    if (is_wanted(corner / 3)) sums[root(corner)] += weighted_normal(corner);
  }
  std::vector<std::uint32_t> normals(count, kNoIndex);
  for (Corner first = 0; first < count; first += 3) {
    if (!is_wanted(first / 3)) continue;
    if (!is_joined[first] && !is_joined[first + 1] && !is_joined[first + 2]) continue;
    for (Corner corner = first; corner < first + 3; ++corner) {
      const Corner kept = root(corner);
      if (normals[kept] == kNoIndex) {
        normals[kept] = static_cast<std::uint32_t>(scene.normals.size());
        // If the normals of the faces cancel out, use the normal of one of the faces.
        const double length = glm::length(sums[kept]);
        scene.normals.emplace_back(length > 0.0 && std::isfinite(length) ? sums[kept] / length
                                                                         : face_normal(kept / 3));
      }
      normals[corner] = normals[kept];
    }
  }
  for (Corner corner = 0; corner < count; ++corner) {
    if (normals[corner] == kNoIndex) continue;
    scene.triangles[corner / 3].normals[corner % 3] = normals[corner];
  }
}

}  // namespace raygate
