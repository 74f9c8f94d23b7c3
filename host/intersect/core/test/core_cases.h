// A scene and rays to test ray cores with.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "host/exact/test/meshes.h"
#include "host/intersect/core/memory_image.h"

namespace raygate::test {

/// Returns a sphere, a large box around it, a flat box and a far box.
inline std::vector<Corners> bodies() {
  std::vector<Corners> mesh = sphere(2);
  for (const auto& part :
       {box(glm::vec3(-3), glm::vec3(3)), box(glm::vec3(-2, 0.5f, -2), glm::vec3(2, 0.5f, 2)),
        box(glm::vec3(1000, 0, 0), glm::vec3(1001, 1, 1))}) {
    mesh.insert(mesh.end(), part.begin(), part.end());
  }
  return mesh;
}

/// Returns rays, some through vertices, some along an axis, some with a common origin.
inline std::vector<Ray> some_rays(const std::vector<Corners>& mesh, Random& random, int count) {
  std::vector<Ray> rays;
  const glm::vec3 shared = random.point(2.5f);
  while (static_cast<int>(rays.size()) < count) {
    const glm::vec3 origin = random.below(3) == 0 ? shared : random.point(2.5f);
    glm::dvec3 way(random.point(1.0f));
    if (random.below(2) == 0) {
      const Corners& target =
          mesh[static_cast<std::size_t>(random.below(static_cast<int>(mesh.size())))];
      way = glm::dvec3(target[static_cast<std::size_t>(random.below(3))]) - glm::dvec3(origin);
    } else if (random.below(4) == 0) {
      way[random.below(3)] = 0.0;
      way[random.below(3)] = 0.0;
    }
    if (largest(way) > 0.0) rays.push_back({origin, scaled_direction(way)});
  }
  return rays;
}

/// Number of lines by which far_lines moves all lines but the root.
constexpr std::uint32_t kFar = 0x17'EDCB;

/// Returns a copy of an image with all lines but the root moved up by kFar, and larger ranks in the
/// same order: tests then reach high bits of line numbers and ranks.
inline std::vector<MemoryLine> far_lines(const MemoryImage& image) {
  const std::span<const MemoryLine> lines = image.lines();
  std::vector<MemoryLine> far(lines.size() + kFar);
  std::vector<std::uint32_t> nodes{MemoryImage::kRoot};
  while (!nodes.empty()) {
    const std::uint32_t at = nodes.back();
    nodes.pop_back();
    NodeLine node(lines[at]);
    std::uint32_t next = std::exchange(node.base, node.base + kFar);
    far[at == MemoryImage::kRoot ? at : at + kFar] = node.line();
    for (const NodeLine::Child& child : node.child) {
      const std::uint32_t end = next + child.size();
      if (child.kind == NodeLine::kInner) nodes.push_back(next++);
      for (; next < end; ++next) {
        TriangleLine triangle(lines[next]);
        triangle.index += kFar;
        triangle.rank *= 3'000'001;
        far[next + kFar] = triangle.line();
      }
    }
  }
  return far;
}

}  // namespace raygate::test
