#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>

#include "host/base/lanes.h"
#include "host/bvh/bvh.h"
#include "host/exact/exact.h"

// Why boxes of an instance contain its triangles
//
// To show: the low bound b of a box is at or below the float before each corner's coordinate c.
// High bounds are symmetric. Let u = 2^-24, the unit roundoff of float, and on one axis
//   (m, m3): the row of the transform: m has three elements m_k, and m3 is the translation;
//   m': m rounded to float; V_k: the largest magnitude of the mesh's bounds along axis k;
//   S = sum |m_k| V_k + |m3|; D = sum |m_k - m'_k| V_k; v: a corner in the mesh.
// 1. c = float32(double(m.v + m3)) differs from m.v + m3 by at most 1.01 u S + 2^-150.
// 2. The float before c is at most 2.02 u S + 2^-149 below c.
// 3. b = float32(low + m'.x). Here low <= m3 - e, with e as below, and x_k is the end of the mesh's
//    box on axis k with the lesser product m'_k x_k. So m'.x <= m'.v <= m.v + D.
// 4. The three products and three sums of b have an error of at most 4.1 u (S + e) + 3 2^-150.
// So it suffices that e >= D + (4.1 + 1.01 + 2.02) u S + 4.1 u e + 2^-147. The code uses
// e = D + 12 u S + 2^-140, which suffices because D <= u S, or D <= S if elements underflow.
// All operations are monotonic, so nested boxes of the mesh give nested boxes of the instance.

namespace raygate {

InstanceBvh::InstanceBvh(const Instance& instance, const glm::dvec3& size) : mesh(instance.mesh) {
  std::memcpy(rows, instance.rows, sizeof rows);
  for (int k = 0; k < 3; ++k) {
    double lost = 0.0, sum = std::abs(rows[k][3]);
    for (int axis = 0; axis < 3; ++axis) {
      matrix[k][axis] = static_cast<float>(rows[k][axis]);
      lost += std::abs(rows[k][axis] - double{matrix[k][axis]}) * size[axis];
      sum += std::abs(rows[k][axis]) * size[axis];
    }
    const double e = lost + 12.0 * 0x1p-24 * sum + 0x1p-140;
    low[k] = float_below(rows[k][3] - e);
    high[k] = float_above(rows[k][3] + e);
  }
}

namespace {

/// Computes a node of an instance from the mesh's node.
RAYGATE_INLINE void place(const InstanceBvh& at, const Bvh::Node& from, Bvh::Node& to) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  FloatLanes bounds[2][3];
  for (int end = 0; end < 2; ++end) {
    for (int k = 0; k < 3; ++k) bounds[end][k] = load<FloatLanes>(from.bounds[end][k]);
  }
  // Boxes of absent children are set separately: their infinite bounds times 0 are NaN.
  const IntLanes absent = bounds[0][0] > bounds[1][0];
  for (int k = 0; k < 3; ++k) {
    FloatLanes low = FloatLanes{} + at.low[k], high = FloatLanes{} + at.high[k];
    for (int axis = 0; axis < 3; ++axis) {
      const float m = at.matrix[k][axis];
      const int turned = m < 0.0f ? 1 : 0;
      low += m * bounds[turned][axis];
      high += m * bounds[turned ^ 1][axis];
    }
    low = absent ? FloatLanes{} + kInfinity : low;
    high = absent ? FloatLanes{} - kInfinity : high;
    std::memcpy(to.bounds[0][k], &low, sizeof low);
    std::memcpy(to.bounds[1][k], &high, sizeof high);
  }
  for (int i = 0; i < Bvh::kWidth; ++i)
    to.child[i] = {from.child[i].first + at.first, from.child[i].count};
}

/// Computes the corners of a leaf's triangles, with the same bits as transform_point().
RAYGATE_INLINE void place(const InstanceBvh& at, const float* from, std::size_t count, float* to) {
  for (std::size_t v = 0; v < 3; ++v) {
    DoubleQuad corner[3];
    for (std::size_t k = 0; k < 3; ++k) {
      corner[k] = wide(load<FloatQuad>(from + (3 * v + k) * count));
    }
    for (std::size_t k = 0; k < 3; ++k) {  // the next write replaces excess elements
      DoubleQuad coordinate;
      transform_coordinate(at.rows[k], corner, coordinate);
      store(to + (3 * v + k) * count, narrow(coordinate));
    }
  }
}

}  // namespace

int Bvh::add_instances(const Scene& scene, int threads) {
  int most_levels = 0;
  std::vector<glm::dvec3> sizes;
  for (const Mesh& mesh : scene.meshes) {
    Bvh& tree = meshes_.emplace_back(Bvh());
    tree.build(mesh.positions, mesh.triangles, kMaxDepth, threads);
    // Rarely needed: leaves half of the levels to the BVH above the instances.
    if (tree.levels() > kMaxDepth / 2) {
      tree.build(mesh.positions, mesh.triangles, kMaxDepth / 2, threads);
    }
    most_levels = std::max(most_levels, tree.levels());
    const auto [low, high] = tree.nodes_[0].box();
    sizes.push_back(glm::max(glm::abs(glm::dvec3(low)), glm::abs(glm::dvec3(high))));
  }
  // An upper bound of the numbers of the BVH's own nodes and primitives.
  first_instanced_ =
      static_cast<std::uint32_t>(scene.triangles.size() + scene.instances.size()) + 1;
  std::vector<std::uint32_t> primitive_counts;
  std::uint64_t primitives = first_instanced_;
  for (const Instance& instance : scene.instances) {
    primitive_counts.push_back(meshes_[instance.mesh].primitive_count());
    primitives += primitive_counts.back();
  }
  if (primitives >= std::uint64_t{1} << 31) throw std::length_error("2^31 triangles or more");
  if (static_cast<int>(std::bit_width(first_instanced_)) > kMaxDepth - most_levels) {
    throw std::length_error("meshes and instances too many for one tree");
  }
  instance_numbers_ = RangeMap(first_instanced_, primitive_counts);
  auto triangle = static_cast<std::uint32_t>(scene.triangles.size());
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    const std::uint32_t mesh = scene.instances[i].mesh;
    InstanceBvh& at = instances_.emplace_back(scene.instances[i], sizes[mesh]);
    at.first = instance_numbers_.begin(i);
    at.first_triangle = triangle;
    triangle += static_cast<std::uint32_t>(scene.meshes[mesh].triangles.size());
  }
  return most_levels;
}

int Bvh::levels(std::uint32_t index) const {
  int most = 0;
  const Node& node = nodes_[index];
  for (int i = 0; i < kWidth && node.bounds[0][0][i] <= node.bounds[1][0][i]; ++i) {
    if (node.child[i].count == 0) most = std::max(most, levels(node.child[i].first));
  }
  return most + 1;
}

void Bvh::make_instance_node(std::uint32_t index, Node& room) const {
  const InstanceBvh& at = instance_of(index);
  const Node& from = meshes_[at.mesh].nodes_[index - at.first];
  in_vectors([&](auto) RAYGATE_BODY { place(at, from, room); });
}

void Bvh::make_instance_corners(const Child& leaf, LeafRoom& room) const {
  const InstanceBvh& at = instance_of(leaf.first);
  const float* const from = &meshes_[at.mesh].corners_[9 * std::size_t{leaf.first - at.first}];
  in_vectors([&](auto) RAYGATE_BODY { place(at, from, leaf.count, room.corners); });
}

FloatCorners Bvh::instance_corners(std::uint32_t primitive) const {
  const InstanceBvh& at = instance_of(primitive);
  FloatCorners corners = meshes_[at.mesh].stored_corners(primitive - at.first);
  for (glm::vec3& corner : corners) corner = raygate::transform_point(at.rows, corner);
  return corners;
}

std::uint32_t Bvh::instance_triangle(std::uint32_t primitive) const {
  const InstanceBvh& at = instance_of(primitive);
  return at.first_triangle + meshes_[at.mesh].triangles_[primitive - at.first];
}

FaceRef Bvh::instance_face(std::uint32_t primitive) const {
  const std::uint32_t instance = instance_numbers_.find(primitive);
  const InstanceBvh& at = instances_[instance];
  return {instance, meshes_[at.mesh].triangles_[primitive - at.first]};
}

void Bvh::prefetch_instance(const Child& child) const {
  const InstanceBvh& at = instance_of(child.first);
  BvhView(meshes_[at.mesh]).prefetch({child.first - at.first, child.count});
}

}  // namespace raygate
