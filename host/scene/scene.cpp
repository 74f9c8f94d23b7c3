#include "host/scene/scene.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>
#include <string_view>

#include "host/base/input.h"
#include "host/base/input_error.h"
#include "host/exact/exact.h"

namespace raygate {
namespace {

/// Returns a sequential hash. Each step takes eight bytes, is invertible, and changes all later
/// states (mixing function of Steele et al., SplitMix64, OOPSLA 2014).
std::uint64_t hash_of(std::string_view bytes) {
  std::uint64_t state = bytes.size();
  while (!bytes.empty()) {
    std::uint64_t word = 0;
    const std::size_t size = std::min(bytes.size(), sizeof word);
    std::memcpy(&word, bytes.data(), size);
    bytes.remove_prefix(size);
    state = (state ^ word) + 0x9e3779b97f4a7c15u;
    state = (state ^ (state >> 30)) * 0xbf58476d1ce4e5b9u;
    state = (state ^ (state >> 27)) * 0x94d049bb133111ebu;
    state ^= state >> 31;
  }
  return state;
}

}  // namespace

void add_light(Scene& scene, const WorldPointLight& light, const std::string& file) {
  const glm::vec3 position(light.position - scene.origin);
  if (!is_finite(position)) throw InputError(file + ": a light is beyond the range of float");
  scene.lights.push_back({position, light.intensity, light.spot});
}

void add_quad(Scene& scene, const std::array<glm::vec3, 4>& corners, const Material& material) {
  const auto first = static_cast<std::uint32_t>(scene.positions.size());
  scene.positions.insert(scene.positions.end(), corners.begin(), corners.end());
  for (const std::uint32_t second : {1u, 2u}) {
    Triangle& triangle = scene.triangles.emplace_back();
    triangle.vertices = {first, first + second, first + second + 1};
    triangle.material = static_cast<std::uint32_t>(scene.materials.size());
    triangle.object = static_cast<std::uint32_t>(scene.objects.size());
  }
  scene.materials.push_back(material);
  scene.objects.push_back(material.name);
}

std::string digest_of(std::span<const std::filesystem::path> files, const std::string& settings) {
  std::uint64_t sum = hash_of(settings);
  for (const std::filesystem::path& file : files) sum += hash_of(read_file(file));
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(sum));
  return text;
}

}  // namespace raygate
