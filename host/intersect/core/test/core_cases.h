// A scene and rays to test ray cores with.
#pragma once

#include <sys/mman.h>

#include <cmath>
#include <cstdint>
#include <new>
#include <span>
#include <utility>
#include <vector>

#include "host/exact/test/meshes.h"
#include "host/intersect/core/core_intersector.h"
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

/// Returns the fractional part of n * step, mapped to [-1, 1). Independent of RAYGATE_SEED.
inline double fixed(std::uint32_t n, double step) {
  return 2.0 * (n * step - std::floor(n * step)) - 1.0;
}

/// Returns rays that do not depend on RAYGATE_SEED. One in six has any_hit, one in six a t_max.
inline std::vector<CoreRay> fixed_rays(std::uint32_t count) {
  std::vector<CoreRay> rays;
  for (std::uint32_t n = 0; n < count; ++n) {
    const glm::dvec3 origin(fixed(n, 0.618034), fixed(n, 0.414214), fixed(n, 0.732051));
    const glm::dvec3 target(fixed(n, 0.236068), fixed(n, 0.645751), fixed(n, 0.316625));
    CoreRay& ray = rays.emplace_back();
    ray.ray = {glm::vec3(2.5 * origin), scaled_direction(target - 2.5 * origin)};
    ray.tag = n;
    ray.any_hit = n % 6 == 1;
    if (n % 6 == 2) ray.t_max = 1.5f;
  }
  return rays;
}

/// Returns a core's counters after it has traced `rays`: clocks, nodes, triangles, lines read,
/// and clocks of exact units.
inline std::vector<std::uint64_t> events(CoreUnit& core, std::span<const MemoryLine> lines,
                                         std::span<const CoreRay> rays) {
  std::vector<CoreResult> results;
  core.trace(lines, rays, results);
  const CoreCounters counters = core.counters();
  return {counters.clocks, counters.nodes, counters.tests, counters.lines, counters.exact_clocks};
}

/// Number of lines by which FarLines moves all lines but the root. Most of its 28 bits are ones.
constexpr std::uint32_t kFar = 0xFEF'EDCB;

/// A copy of an image of at most 800 triangles. All lines but the root are moved up by kFar. Ranks
/// keep their order, and neighbouring ranks differ by a power of two. So results depend on high
/// bits of line numbers and on most bits of ranks. Reserves 16 GiB of address space; only copied
/// lines take memory. Throws std::bad_alloc.
class FarLines {
 public:
  explicit FarLines(const MemoryImage& image) : size_(image.lines().size() + kFar) {
    void* const place = mmap(nullptr, size_ * sizeof(MemoryLine), PROT_READ | PROT_WRITE,
                             MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (place == MAP_FAILED) throw std::bad_alloc();
    far_ = static_cast<MemoryLine*>(place);
    std::vector<std::uint32_t> nodes{MemoryImage::kRoot};
    while (!nodes.empty()) {
      const std::uint32_t at = nodes.back();
      nodes.pop_back();
      NodeLine node(image.lines()[at]);
      std::uint32_t next = std::exchange(node.base, node.base + kFar);
      far_[at == MemoryImage::kRoot ? at : at + kFar] = node.line();
      for (const NodeLine::Child& child : node.child) {
        const std::uint32_t end = next + child.size();
        if (child.kind == NodeLine::kInner) nodes.push_back(next++);
        for (; next < end; ++next) {
          TriangleLine triangle(image.lines()[next]);
          triangle.index += kFar;
          triangle.rank = triangle.rank / 27 * ((1u << 27) - 1) + (2u << triangle.rank % 27) - 1;
          far_[next + kFar] = triangle.line();
        }
      }
    }
  }
  ~FarLines() { munmap(far_, size_ * sizeof(MemoryLine)); }
  FarLines(const FarLines&) = delete;
  FarLines& operator=(const FarLines&) = delete;

  [[nodiscard]] std::span<const MemoryLine> lines() const { return {far_, size_}; }

 private:
  std::size_t size_;
  MemoryLine* far_ = nullptr;
};

}  // namespace raygate::test
