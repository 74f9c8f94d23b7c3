#include "host/scene/scene.h"

#include <cmath>
#include <concepts>
#include <cstdio>
#include <cstring>
#include <type_traits>

#include "host/base/input_error.h"
#include "host/exact/expansion.h"

namespace raygate {
namespace {

/// A sequential hash. Each step takes eight bytes, is invertible, and changes all later states
/// (mixing function of Steele et al., SplitMix64, OOPSLA 2014).
class Digest {
 public:
  [[nodiscard]] std::uint64_t value() const { return state_; }

  void word(std::uint64_t bits) {
    state_ = (state_ ^ bits) + 0x9e3779b97f4a7c15u;
    state_ = (state_ ^ (state_ >> 30)) * 0xbf58476d1ce4e5b9u;
    state_ = (state_ ^ (state_ >> 27)) * 0x94d049bb133111ebu;
    state_ ^= state_ >> 31;
  }
  void bytes(const void* first, std::size_t count) {
    word(count);
    const char* at = static_cast<const char*>(first);
    std::uint64_t bits = 0;
    for (; count >= sizeof bits; at += sizeof bits, count -= sizeof bits) {
      std::memcpy(&bits, at, sizeof bits);
      word(bits);
    }
    if (count == 0) return;
    bits = 0;
    std::memcpy(&bits, at, count);
    word(bits);
  }

  // Only types without padding are hashed by their bytes. 0.0 and -0.0 have different digests,
  // because they may give different images.
  template <class T>
  requires std::is_arithmetic_v<T> || std::is_enum_v<T>
  void add(T value) { bytes(&value, sizeof value); }
  void add(const std::string& text) { bytes(text.data(), text.size()); }
  template <glm::length_t kSize, class T>
  void add(const glm::vec<kSize, T>& vector) {
    bytes(&vector, sizeof vector);
  }
  template <class T>
  void add(const std::optional<T>& value) {
    word(value.has_value());
    if (value) add(*value);
  }
  template <class T>
  void add(const std::vector<T>& values) {
    if constexpr (kIsPacked<T>) {
      bytes(values.data(), values.size() * sizeof(T));
    } else {
      word(values.size());
      for (const T& value : values) add(value);
    }
  }
  template <class... Values>
  requires(sizeof...(Values) > 1) void add(const Values&... values) { (add(values), ...); }

  // Structured bindings name all members, so a new member does not compile until add() handles it.
  // Rarely used members are skipped at their defaults, which keeps older digests valid.
  void add(const TextureMapping& m) {
    const auto& [scale, offset, sampling, turn, is_second] = m;
    const bool clamps = sampling == Sampling(Wrap::kClamp);
    add(scale, offset, clamps);
    if (!clamps && sampling != Sampling()) add(sampling.u, sampling.v, sampling.is_nearest);
    if (turn != glm::vec2(1.0f, 0.0f)) add(turn);
    if (is_second) add(is_second);
  }
  void add(const MaterialMap& m) {
    const auto& [file, mapping, texture] = m;
    add(mapping, texture);
  }
  void add(const MetallicRoughness& m) {
    const auto& [metallic, roughness, transmission, specular, specular_color, roughness_map,
                 metallic_map, transmission_map, specular_map, specular_color_map] = m;
    add(metallic, roughness, transmission, roughness_map);
    if (specular != 1.0f || specular_color != glm::vec3(1.0f)) add(specular, specular_color);
    int number = 0;
    for_each_map(m, [&](const MaterialMap& map) {
      const bool is_same = &map == &m.metallic_map && map.texture == m.roughness_map.texture;
      if (number++ > 0 && map.texture != kNoIndex && !is_same) add(number, map);
    });
  }
  void add(const Material& m) {
    const auto& [name, diffuse, specular, emission, transmittance, shininess, refraction_index,
                 opacity, illumination_model, diffuse_map, metallic_roughness, normal_map,
                 normal_scale, emission_map, opacity_map, opacity_cutoff, opacity_blends,
                 has_vertex_opacity, has_vertex_colors] = m;
    add(diffuse, specular, emission, transmittance, shininess, refraction_index, opacity,
        illumination_model, diffuse_map);
    add(metallic_roughness, normal_map, normal_scale, opacity_map, opacity_cutoff);
    if (emission_map.texture != kNoIndex) add(emission_map);
    if (opacity_blends) add(opacity_blends);
    if (has_vertex_opacity) add(has_vertex_opacity);
  }
  void add(const Texture& t) { add(t.width(), t.height(), t.texels()); }
  void add(const Mesh& m) {
    const auto& [positions, triangles, colors] = m;
    add(positions, triangles);
    if (!colors.empty()) add(colors);
  }
  void add(const SpotCone& c) {
    const auto& [axis, inner, outer] = c;
    add(axis, inner, outer);
  }
  void add(const PointLight& l) {
    const auto& [position, intensity, spot] = l;
    add(position, intensity, spot);
  }
  void add(const DirectionalLight& l) {
    const auto& [direction, irradiance] = l;
    add(direction, irradiance);
  }
  void add(const EnvironmentMap& e) {
    const auto& [width, height, texels, strength, up, ahead] = e;
    add(width, height, texels, strength, up, ahead);
  }
  void add(const Instance& i) {
    const auto& [rows, mesh, object] = i;
    bytes(rows, sizeof rows);
    add(mesh, object);
  }
  // `camera` and `up` are omitted: images record their own view.
  void add(const Scene& s) {
    const auto& [positions, rests, colors, normals, tangents, texcoords, second_texcoords,
                 opacities, triangles, meshes, instances, materials, textures, objects, lights,
                 directional_lights, background, environment, origin, rounding, camera, up, files,
                 warnings] = s;
    add(positions, normals, texcoords, triangles, meshes, instances, materials, textures, objects);
    add(lights, directional_lights, background, environment, origin);
    if (!rests.empty()) add(rests);
    if (!colors.empty()) add(colors);
    if (!tangents.empty()) add(tangents);
    if (!second_texcoords.empty()) add(second_texcoords);
    if (!opacities.empty()) add(opacities);
    // If there are vertex colours, add the indices of materials that ignore them.
    const auto has_colors = [](const Mesh& mesh) { return !mesh.colors.empty(); };
    if (colors.empty() && std::ranges::none_of(meshes, has_colors)) return;
    for (std::size_t i = 0; i < materials.size(); ++i) {
      if (!materials[i].has_vertex_colors) word(i);
    }
  }

 private:
  template <class T>
  static constexpr bool kIsPacked =
      std::same_as<T, glm::vec2> || std::same_as<T, glm::vec3> || std::same_as<T, glm::ivec3> ||
      std::same_as<T, Triangle> || std::same_as<T, Texture::Texel>;
  static_assert(std::has_unique_object_representations_v<Triangle> && sizeof(glm::vec3) == 12);

  std::uint64_t state_ = 0;
};

}  // namespace

double Scene::add_vertex(const glm::dvec3& world) {
  double largest_error = 0.0;
  glm::vec3& position = positions.emplace_back();
  glm::ivec3& rest = rests.emplace_back();
  for (int k = 0; k < 3; ++k) {
    const auto [value, error] = two_sum(world[k], -origin[k]);
    const double exact = on_float_grid(value);
    largest_error = std::max(largest_error, std::abs((exact - value) - error));
    position[k] = static_cast<float>(exact);
    rest[k] = rest_of(exact, position[k]);
  }
  return largest_error;
}

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

std::string digest_of(const Scene& scene) {
  Digest digest;
  digest.add(scene);
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(digest.value()));
  return text;
}

}  // namespace raygate
