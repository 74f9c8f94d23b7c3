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

/// The edge from a corner to the next one, by the positions of its ends.
struct Edge {
  std::uint32_t low, high;
  Corner corner;
  bool is_forward;  ///< from `low` to `high`
};

class Smoother {
 public:
  Smoother(std::span<const std::uint32_t> groups, std::optional<double> angle, Scene& scene)
      : groups_(groups),
        by_angle_(angle.has_value()),
        least_cosine_(angle ? sine_cosine(*angle / 360.0).cosine : 0.0),
        scene_(scene),
        joined_(3 * scene.triangles.size()),
        is_joined_(joined_.size()) {
    std::iota(joined_.begin(), joined_.end(), 0u);
  }

  void smooth() {
    find_places();
    find_edges();
    for (std::size_t i = 0; i < edges_.size();) {
      std::size_t end = i + 1;
      while (end < edges_.size() && edges_[end].low == edges_[i].low &&
             edges_[end].high == edges_[i].high) {
        ++end;
      }
      if (end == i + 2) look_at(edges_[i], edges_[i + 1]);
      i = end;
    }
    add_normals();
  }

 private:
  [[nodiscard]] bool is_wanted(std::size_t triangle) const {
    return !is_left_out(scene_.triangles[triangle]) &&
           scene_.triangles[triangle].normals[0] == kNoIndex &&
           (by_angle_ || groups_[triangle] != 0);
  }
  [[nodiscard]] const glm::vec3& position(Corner corner) const {
    return scene_.positions[scene_.triangles[corner / 3].vertices[corner % 3]];
  }
  [[nodiscard]] static Corner next(Corner corner) {
    return corner % 3 == 2 ? corner - 2 : corner + 1;
  }

  /// Numbers vertices so that those with equal positions have one number.
  void find_places() {
    std::vector<std::uint32_t> order(scene_.positions.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto key = [&](std::uint32_t i) {
      const glm::vec3& at = scene_.positions[i];
      return std::tuple(at.x, at.y, at.z, i);
    };
    std::ranges::sort(order, {}, key);
    places_.resize(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
      const bool is_same = i > 0 && scene_.positions[order[i]] == scene_.positions[order[i - 1]];
      places_[order[i]] = is_same ? places_[order[i - 1]] : order[i];
    }
  }

  void find_edges() {
    for (std::size_t i = 0; i < scene_.triangles.size(); ++i) {
      if (!is_wanted(i)) continue;
      const auto& vertices = scene_.triangles[i].vertices;
      for (std::uint32_t k = 0; k < 3; ++k) {
        const std::uint32_t from = places_[vertices[k]], to = places_[vertices[(k + 1) % 3]];
        edges_.push_back(
            {std::min(from, to), std::max(from, to), static_cast<Corner>(3 * i + k), from < to});
      }
    }
    std::ranges::sort(
        edges_, {}, [](const Edge& edge) { return std::tuple(edge.low, edge.high, edge.corner); });
  }

  /// Joins the corners at both ends of a smooth edge.
  void look_at(const Edge& a, const Edge& b) {
    if (a.is_forward == b.is_forward || !is_smooth(a.corner / 3, b.corner / 3)) return;
    join(a.corner, next(b.corner));
    join(next(a.corner), b.corner);
  }

  [[nodiscard]] bool is_smooth(std::size_t a, std::size_t b) const {
    if (!by_angle_) return groups_[a] == groups_[b];
    const double cosine = glm::dot(face_normal(a), face_normal(b));
    return cosine >= least_cosine_ - 1e-12;
  }

  [[nodiscard]] glm::dvec3 face_normal(std::size_t triangle) const {
    const auto first = static_cast<Corner>(3 * triangle);
    const glm::dvec3 a(position(first));
    return glm::normalize(
        glm::cross(glm::dvec3(position(first + 1)) - a, glm::dvec3(position(first + 2)) - a));
  }

  [[nodiscard]] Corner root(Corner corner) {
    while (joined_[corner] != corner) {
      joined_[corner] = joined_[joined_[corner]];
      corner = joined_[corner];
    }
    return corner;
  }
  void join(Corner a, Corner b) {
    is_joined_[a] = is_joined_[b] = true;
    a = root(a);
    b = root(b);
    joined_[std::max(a, b)] = std::min(a, b);
  }

  /// Returns the face's normal at a corner, weighted by the sine of its angle over the lengths of
  /// both sides.
  [[nodiscard]] glm::dvec3 weighted_normal(Corner corner) const {
    const glm::dvec3 at(position(corner));
    const glm::dvec3 u = glm::dvec3(position(next(corner))) - at;
    const glm::dvec3 v = glm::dvec3(position(next(next(corner)))) - at;
    return glm::cross(u, v) / (glm::dot(u, u) * glm::dot(v, v));
  }

  void add_normals() {
    if (edges_.empty()) return;
    const auto count = static_cast<Corner>(joined_.size());
    std::vector<glm::dvec3> sums(count, glm::dvec3(0.0));
    for (Corner corner = 0; corner < count; ++corner) {
      if (is_wanted(corner / 3)) sums[root(corner)] += weighted_normal(corner);
    }
    std::vector<std::uint32_t> numbers(count, kNoIndex);
    for (Corner first = 0; first < count; first += 3) {
      if (!is_wanted(first / 3)) continue;
      if (!is_joined_[first] && !is_joined_[first + 1] && !is_joined_[first + 2]) continue;
      for (std::uint32_t k = 0; k < 3; ++k) {
        const Corner kept = root(first + k);
        if (numbers[kept] == kNoIndex) {
          numbers[kept] = static_cast<std::uint32_t>(scene_.normals.size());
          // If the normals of the faces cancel out, use that of one of them.
          const double length = glm::length(sums[kept]);
          scene_.normals.emplace_back(
              length > 0.0 && std::isfinite(length) ? sums[kept] / length : face_normal(kept / 3));
        }
        numbers[first + k] = numbers[kept];
      }
    }
    for (Corner corner = 0; corner < count; ++corner) {
      if (numbers[corner] == kNoIndex) continue;
      scene_.triangles[corner / 3].normals[corner % 3] = numbers[corner];
    }
  }

  std::span<const std::uint32_t> groups_;
  bool by_angle_;
  double least_cosine_;
  Scene& scene_;
  std::vector<std::uint32_t> places_;  // numbers of the vertices' positions
  std::vector<Edge> edges_;
  std::vector<Corner> joined_;  // to a corner before it, or itself
  std::vector<bool> is_joined_;
};

}  // namespace

void add_smooth_normals(std::span<const std::uint32_t> groups, std::optional<double> angle,
                        Scene& scene) {
  Smoother(groups, angle, scene).smooth();
}

}  // namespace raygate
