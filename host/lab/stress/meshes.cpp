#include "host/lab/stress/meshes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace raygate::lab {
namespace {

using Face = std::array<int, 3>;
using Points = std::vector<glm::dvec3>;

MeshPointer placed(const Points& points, const std::vector<Face>& faces,
                   const Placement& placement) {
  auto mesh = std::make_shared<Mesh>();
  mesh->closed = true;
  const auto place = [&](int i) {
    return glm::vec3(points[i] * placement.scale + placement.shift);
  };
  for (const auto& [a, b, c] : faces) mesh->triangles.push_back({place(a), place(b), place(c)});
  return mesh;
}

void icosahedron(Points& points, std::vector<Face>& faces) {
  const double g = (1.0 + std::sqrt(5.0)) / 2.0;
  points.clear();
  for (int axis = 0; axis < 3; ++axis) {
    for (const double a : {-1.0, 1.0}) {
      for (const double b : {-g, g}) {
        glm::dvec3 p(0.0);
        p[axis] = a;
        p[(axis + 1) % 3] = b;
        points.push_back(glm::normalize(p));
      }
    }
  }
  // All triples of adjacent points, in counter-clockwise order seen from outside.
  faces.clear();
  const auto near = [&](int i, int j) { return glm::distance(points[i], points[j]) < 1.2; };
  for (int a = 0; a < 12; ++a) {
    for (int b = a + 1; b < 12; ++b) {
      for (int c = b + 1; c < 12; ++c) {
        if (!near(a, b) || !near(b, c) || !near(c, a)) continue;
        const bool outwards = glm::dot(points[a], glm::cross(points[b], points[c])) > 0.0;
        faces.push_back(outwards ? Face{a, b, c} : Face{a, c, b});
      }
    }
  }
}

/// Incremental triangulation of a sphere: a new point splits the triangle below it, and edges are
/// flipped until no triangle has a point above it (Lawson, "Software for C1 surface interpolation",
/// 1977). Flips keep the mesh closed, regardless of rounding.
class Triangulation {
 public:
  Triangulation() { icosahedron(points_, faces_); }

  void add(const glm::dvec3& point) {
    const int p = static_cast<int>(points_.size());
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      const auto [a, b, c] = faces_[f];
      if (!left(a, b, point) || !left(b, c, point) || !left(c, a, point)) continue;
      points_.push_back(point);
      faces_[f] = {a, b, p};
      faces_.push_back({b, c, p});
      faces_.push_back({c, a, p});
      for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
        legalize(from, to, p);
      }
      return;
    }
  }

  [[nodiscard]] const Points& points() const { return points_; }
  [[nodiscard]] const std::vector<Face>& faces() const { return faces_; }

 private:
  [[nodiscard]] bool left(int a, int b, const glm::dvec3& p) const {
    return glm::dot(glm::cross(points_[a], points_[b]), p) > 0.0;
  }

  /// Returns the face with the edge from -> to, rotated so that this edge is first.
  Face* face_with(int from, int to) {
    for (Face& face : faces_) {
      for (int k = 0; k < 3; ++k) {
        if (face[k] != from || face[(k + 1) % 3] != to) continue;
        face = {from, to, face[(k + 2) % 3]};
        return &face;
      }
    }
    return nullptr;
  }

  /// Flips the edge between the face of `p` and its neighbour if the neighbour's point is above.
  void legalize(int from, int to, int p) {
    Face* const mine = face_with(from, to);
    Face* const other = face_with(to, from);
    if (mine == nullptr || other == nullptr) return;
    const int q = (*other)[2];
    const glm::dvec3 normal = glm::cross(points_[to] - points_[from], points_[p] - points_[from]);
    if (glm::dot(normal, points_[q] - points_[p]) <= 1e-12) return;
    *mine = {from, q, p};
    *other = {q, to, p};
    legalize(from, q, p);
    legalize(q, to, p);
  }

  Points points_;
  std::vector<Face> faces_;
};

}  // namespace

MeshPointer box(const Placement& placement) {
  Points points;
  for (int i = 0; i < 8; ++i) {
    points.emplace_back((i & 1) != 0 ? 1 : -1, (i & 2) != 0 ? 1 : -1, (i & 4) != 0 ? 1 : -1);
  }
  return placed(points,
                {{0, 2, 3},
                 {0, 3, 1},
                 {4, 5, 7},
                 {4, 7, 6},
                 {0, 1, 5},
                 {0, 5, 4},
                 {2, 6, 7},
                 {2, 7, 3},
                 {0, 4, 6},
                 {0, 6, 2},
                 {1, 3, 7},
                 {1, 7, 5}},
                placement);
}

MeshPointer sphere(int level, const Placement& placement) {
  Points points;
  std::vector<Face> faces;
  icosahedron(points, faces);
  for (int l = 0; l < level; ++l) {
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
      const auto [at, is_new] =
          middles.try_emplace(std::minmax(a, b), static_cast<int>(points.size()));
      if (is_new) points.push_back(glm::normalize(points[a] + points[b]));
      return at->second;
    };
    std::vector<Face> finer;
    for (const auto& [a, b, c] : faces) {
      const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    faces = std::move(finer);
  }
  return placed(points, faces, placement);
}

MeshPointer random_sphere(int points, Random& random, const Placement& placement) {
  Triangulation triangulation;
  for (int i = 12; i < points; ++i) triangulation.add(random.unit());
  return placed(triangulation.points(), triangulation.faces(), placement);
}

MeshPointer wedge(double angle, const Placement& placement) {
  const double y = std::tan(angle);
  return placed(
      {{0, 0, -1}, {1, 0, -1}, {1, y, -1}, {0, 0, 1}, {1, 0, 1}, {1, y, 1}},
      {{0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3}, {0, 3, 5}, {0, 5, 2}, {1, 2, 5}, {1, 5, 4}},
      placement);
}

}  // namespace raygate::lab
