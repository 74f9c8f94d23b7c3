// Closed meshes and random numbers for the tests of hits.
#pragma once

#include <array>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <cstdlib>
#include <glm/glm.hpp>
#include <iostream>
#include <map>
#include <random>
#include <utility>
#include <vector>

#include "host/exact/exact.h"
#include "host/scene/scene.h"

namespace raygate::test {

/// Returns the dot product of i and e, with the hardware's roundings.
inline float float_dot(const glm::vec3& i, const glm::vec3& e) {
  return (i.x * e.x + i.y * e.y) + i.z * e.z;
}

/// A random generator. The seed, which it prints, is environment variable RAYGATE_SEED or 1.
class Random {
 public:
  Random() {
    const char* text = std::getenv("RAYGATE_SEED");
    const auto seed = text == nullptr ? 1u : static_cast<unsigned>(std::strtoul(text, nullptr, 0));
    std::cout << "seed " << seed << "\n";
    engine_.seed(seed);
  }
  float uniform(float low = -1.0f, float high = 1.0f) {
    return std::uniform_real_distribution<float>(low, high)(engine_);
  }
  int below(int n) { return std::uniform_int_distribution<int>(0, n - 1)(engine_); }
  glm::vec3 point(float size = 1.0f) {
    const float x = uniform(), y = uniform(), z = uniform();
    return glm::vec3(x, y, z) * size;
  }

 private:
  std::mt19937 engine_;
};

inline std::vector<Corners> box(const glm::vec3& low, const glm::vec3& high) {
  const auto corner = [&](int i) {
    return glm::vec3((i & 1) != 0 ? high.x : low.x, (i & 2) != 0 ? high.y : low.y,
                     (i & 4) != 0 ? high.z : low.z);
  };
  constexpr int kFaces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  std::vector<Corners> triangles;
  for (const auto& f : kFaces) {
    triangles.push_back({corner(f[0]), corner(f[1]), corner(f[2])});
    triangles.push_back({corner(f[0]), corner(f[2]), corner(f[3])});
  }
  return triangles;
}

/// Returns a sphere of 20 * 4^level triangles. Vertices are rounded to float once, then shared.
inline std::vector<Corners> sphere(int level, float radius = 1.0f,
                                   const glm::vec3& center = glm::vec3(0.0f)) {
  const double g = (1.0 + std::sqrt(5.0)) / 2.0;
  std::vector<glm::dvec3> v = {{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0},
                               {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g},
                               {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
  for (auto& p : v) p = glm::normalize(p);
  using Face = std::array<int, 3>;
  std::vector<Face> faces = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                             {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                             {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                             {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  for (int l = 0; l < level; ++l) {
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
      const auto [at, is_new] = middles.try_emplace(std::minmax(a, b), static_cast<int>(v.size()));
      if (is_new) v.push_back(glm::normalize(v[a] + v[b]));
      return at->second;
    };
    std::vector<Face> finer;
    for (const auto& [a, b, c] : faces) {
      const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    faces = std::move(finer);
  }
  std::vector<Corners> triangles;
  triangles.reserve(faces.size());
  const auto place = [&](int i) {
    return glm::vec3(v[i] * static_cast<double>(radius) + glm::dvec3(center));
  };
  for (const auto& [a, b, c] : faces) triangles.push_back({place(a), place(b), place(c)});
  return triangles;
}

/// Returns a scene of these triangles with one material. It has rests unless all are 0 (rest_of).
inline Scene scene_of(const std::vector<Corners>& triangles) {
  Scene scene;
  scene.materials.emplace_back();
  scene.objects.push_back("mesh");
  for (const Corners& corners : triangles) {
    Triangle triangle;
    for (int k = 0; k < 3; ++k) {
      triangle.vertices[k] = static_cast<std::uint32_t>(scene.positions.size());
      const glm::vec3 position(corners[k]);
      scene.positions.push_back(position);
      glm::ivec3& rest = scene.rests.emplace_back(0);
      for (int axis = 0; axis < 3; ++axis) rest[axis] = rest_of(corners[k][axis], position[axis]);
    }
    scene.triangles.push_back(triangle);
  }
  scene.drop_zero_rests();
  return scene;
}

template <std::same_as<FloatCorners> T>  // rejects braced lists
Scene scene_of(const std::vector<T>& triangles) {
  std::vector<Corners> mesh;
  mesh.reserve(triangles.size());
  for (const FloatCorners& triangle : triangles) mesh.push_back(widened(triangle));
  return scene_of(mesh);
}

}  // namespace raygate::test
