#include "host/scene/digest.h"

#include <concepts>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

namespace raygate {
namespace {

/// Takes values one after the other. Eight bytes are one step, each of which can be undone but
/// changes all that follows: Steele and others' mixing function (SplitMix64, OOPSLA 2014).
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

  // Only what is without gaps between its members, whose bytes may be anything, goes in by its
  // bytes; floats have two zeros, which may draw two pictures.
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

  // What few materials have is left out where it is the default: files keep their digest.
  void add(const TextureMapping& m) {
    const bool clamps = m.sampling == Sampling(Wrap::kClamp);
    add(m.scale, m.offset, clamps);
    if (!clamps && m.sampling != Sampling()) add(m.sampling.u, m.sampling.v, m.sampling.is_nearest);
    if (m.turn != glm::vec2(1.0f, 0.0f)) add(m.turn);
    if (m.is_second) add(m.is_second);
  }
  void add(const MaterialMap& m) { add(m.mapping, m.texture); }
  void add(const MetallicRoughness& m) {
    add(m.metallic, m.roughness, m.transmission, m.map);
    if (m.specular != 1.0f || m.specular_color != glm::vec3(1.0f)) {
      add(m.specular, m.specular_color);
    }
    if (m.coat != 0.0f) add(m.coat, m.coat_roughness);
    int number = 0;
    for_each_map(m, [&](const MaterialMap& map) {
      if (number++ > 0 && map.texture != kNoIndex) add(number, map);
    });
  }
  void add(const Material& m) {
    add(m.diffuse, m.specular, m.emission, m.transmittance, m.shininess, m.refraction_index,
        m.opacity, m.illumination_model, m.diffuse_mapping, m.diffuse_texture);
    add(m.metallic_roughness, m.normal_map, m.normal_scale, m.opacity_map, m.opacity_cutoff);
    if (m.emission_map.texture != kNoIndex) add(m.emission_map);
    if (m.opacity_blends) add(m.opacity_blends);
    if (m.has_vertex_opacity) add(m.has_vertex_opacity);
  }
  void add(const NameList& names) {
    word(names.size());
    for (std::size_t i = 0; i < names.size(); ++i) add(names[i]);
  }
  void add(const Texture& t) { add(t.width(), t.height(), t.texels()); }
  void add(const Mesh& m) {
    add(m.positions, m.triangles);
    if (!m.colors.empty()) add(m.colors);
  }
  void add(const SpotCone& c) { add(c.axis, c.inner, c.outer); }
  void add(const PointLight& l) { add(l.position, l.intensity, l.spot); }
  void add(const DirectionalLight& l) { add(l.direction, l.irradiance); }
  void add(const EnvironmentMap& e) { add(e.width, e.height, e.texels, e.strength, e.up, e.ahead); }
  void add(const Instance& i) {
    bytes(i.rows, sizeof i.rows);
    add(i.mesh, i.object);
  }

 private:
  template <class T>
  static constexpr bool kIsPacked = std::same_as<T, glm::vec2> || std::same_as<T, glm::vec3> ||
                                    std::same_as<T, Triangle> || std::same_as<T, Texture::Texel>;
  static_assert(std::has_unique_object_representations_v<Triangle> && sizeof(glm::vec3) == 12);

  std::uint64_t state_ = 0;
};

}  // namespace

std::string digest_of(const Scene& scene) {
  Digest digest;
  digest.add(scene.positions, scene.normals, scene.texcoords, scene.triangles, scene.meshes,
             scene.instances, scene.materials, scene.textures, scene.objects);
  digest.add(scene.lights, scene.directional_lights, scene.background, scene.environment,
             scene.origin);
  if (!scene.colors.empty()) digest.add(scene.colors);
  if (!scene.tangents.empty()) digest.add(scene.tangents);
  if (!scene.second_texcoords.empty()) digest.add(scene.second_texcoords);
  if (!scene.opacities.empty()) digest.add(scene.opacities);
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(digest.value()));
  return text;
}

}  // namespace raygate
