// GltfMaterials: converts materials and textures of a glTF file (a part of gltf_loader.cpp).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "host/scene/io/gltf_file.h"
#include "host/scene/scene.h"

namespace raygate {

/// Converts each material that is used, and its textures, once. A material with
/// KHR_materials_unlit is not shaded (illumination model 0).
class GltfMaterials {
 public:
  /// `file` and `scene` must outlive this object. If `textures` is false, no image is decoded.
  GltfMaterials(GltfFile& file, Scene& scene, bool textures)
      : file_(file), scene_(scene), textures_(textures) {}

  struct Converted {
    std::uint32_t number;  ///< index into Scene::materials
    /// Texture coordinate sets of the material, the base colour's first; -1: none.
    std::array<int, 2> texcoord_sets;
  };

  /// Returns a material of the file, converted at the first call; -1 is the default material.
  Converted convert(int material) {
    const auto found = converted_.find(material);
    if (found != converted_.end()) return found->second;
    sets_ = {-1, -1};
    Material result;
    result.name = "default";
    if (material != -1) result = translated(this->material(material));
    const Converted converted{static_cast<std::uint32_t>(scene_.materials.size()), sets_};
    scene_.materials.push_back(std::move(result));
    return converted_.emplace(material, converted).first->second;
  }

  /// If a material is masked or blended, makes vertex opacities multiply its opacity and returns
  /// true. Returns false for an opaque material, which does not change.
  [[nodiscard]] bool use_vertex_opacity(int material) {
    const Converted converted = convert(material);
    Material& to = scene_.materials[converted.number];
    sets_ = converted.texcoord_sets;
    set_opacity(this->material(material), true, to);
    return to.has_vertex_opacity;
  }

 private:
  static constexpr std::int64_t kMostTexels = std::int64_t{1} << 27;

  static double in_unit(double x) { return x >= 0.0 ? std::min(x, 1.0) : 0.0; }

  /// Returns the first three numbers as a colour, clamped to [0, most]; missing numbers are 1.
  static glm::vec3 colour_of(const std::vector<double>& numbers, double most = 1.0) {
    glm::vec3 colour(1.0f);
    for (std::size_t k = 0; k < std::min<std::size_t>(numbers.size(), 3); ++k) {
      colour[int(k)] = static_cast<float>(numbers[k] >= 0.0 ? std::min(numbers[k], most) : 0.0);
    }
    return colour;
  }

  static glm::vec2 pair_in(const Json& object, const char* key, const glm::vec2& otherwise) {
    const std::vector<double> numbers = numbers_in(object, key);
    return numbers.size() == 2 ? glm::vec2(numbers[0], numbers[1]) : otherwise;
  }

  static constexpr const char *kSpecular = "KHR_materials_specular",
                              *kTransmission = "KHR_materials_transmission",
                              *kTransform = "KHR_texture_transform";

  /// Returns the index of the texture coordinate set that a texture uses.
  static int set_of(const Json& info) {
    const double set =
        number_in(extension(info, kTransform), "texCoord", number_in(info, "texCoord", 0.0));
    return static_cast<int>(std::clamp(set, -1.0, 1e6));
  }

  /// Returns the material with this index, or null for index -1.
  [[nodiscard]] const Json& material(int index) const {
    static const Json kDefault;
    return index == -1 ? kDefault : file_.at(file_.list("materials"), index, "material");
  }

  /// Returns the `size` numbers at a key; none for a missing key or (with a warning) a wrong value.
  std::vector<double> numbers(const Json& object, const char* key, std::size_t size) {
    std::vector<double> numbers = numbers_in(object, key);
    if (numbers.size() == size) return numbers;
    if (!member(object, key).is_null()) {
      file_.warn_once(in_quotes(key) + " of a material is not as glTF has it, left out");
    }
    return {};
  }

  /// Returns a texture's image; nullopt if images are not decoded or, with a warning, if the
  /// texture names none. Throws InputError for a damaged image or if all images exceed kMostTexels.
  std::optional<Texture> picture(const Json& texture, Texture::Content content) {
    if (!textures_) return std::nullopt;
    const int source = index_in(texture, "source");
    if (source < 0) {
      file_.warn_once("a texture without a PNG or JPEG picture is left out");
      return std::nullopt;
    }
    Texture result = Texture::decode(file_.picture_bytes(source),
                                     file_.name + ": image " + std::to_string(source), content);
    texels_ += std::int64_t{result.width()} * result.height();
    if (texels_ > kMostTexels) {
      file_.fail("textures of more than " + std::to_string(kMostTexels) + " pixels in all");
    }
    return result;
  }

  /// Returns the texture at a key, with its mapping; none, with a warning, if it is unreadable.
  MaterialMap map_of(const Json& parent, const char* key,
                     Texture::Content content = Texture::Content::kColour) {
    MaterialMap map;
    const Json& info = member(parent, key);
    if (!member(info, "index").is_number_integer()) {
      if (!info.is_null()) {
        file_.warn_once(in_quotes(key) + " of a material is not as glTF has it, left out");
      }
      return map;
    }
    file_.optionally("its material is plain instead", [&] { map = read_map(info, content); });
    return map;
  }

  MaterialMap read_map(const Json& info, Texture::Content content) {
    MaterialMap map;
    const int set = set_of(info);
    auto at = std::ranges::find(sets_, set);
    if (at == sets_.end()) at = std::ranges::find(sets_, -1);
    if (at == sets_.end()) {
      file_.fail("textures of one material with three sets of coordinates, expected two at most");
    }
    *at = set;
    map.mapping.is_second = at != sets_.begin();
    const Json& texture = file_.at(file_.list("textures"), index_in(info, "index"), "texture");
    const auto [entry, is_new] =
        texture_of_image_.try_emplace(std::pair(index_in(texture, "source"), content), kNoIndex);
    if (is_new) {
      if (std::optional<Texture> decoded = picture(texture, content)) {
        entry->second = static_cast<std::uint32_t>(scene_.textures.size());
        scene_.textures.push_back(std::move(*decoded));
      }
    }
    map.texture = entry->second;
    if (const int number = index_in(texture, "sampler"); number >= 0) {
      const Json& sampler = file_.at(file_.list("samplers"), number, "sampler");
      const auto wrap_of = [&](const char* key) {
        constexpr int kClamp = 33071, kMirror = 33648, kRepeat = 10497;
        const auto mode = static_cast<int>(number_in(sampler, key, kRepeat));
        if (mode == kClamp) return Wrap::kClamp;
        if (mode == kMirror) return Wrap::kMirror;
        if (mode != kRepeat) {
          file_.warn_once("sampler " + std::to_string(number) + ": found the wrap mode " +
                          std::to_string(mode) + ", expected 10497, 33071 or 33648; repeated");
        }
        return Wrap::kRepeat;
      };
      constexpr int kNearest = 9728;
      map.mapping.sampling.u = wrap_of("wrapS");
      map.mapping.sampling.v = wrap_of("wrapT");
      map.mapping.sampling.is_nearest = index_in(sampler, "magFilter") == kNearest;
    }
    const Json& transform = extension(info, kTransform);
    if (transform.is_null()) return map;
    map.mapping.scale = pair_in(transform, "scale", glm::vec2(1.0f));
    // v points down in glTF, but the scene's v' = 1 - v points up. With cosine c, scale s and
    // offset o, 1 - (c s v + o) = c s v' + (1 - c s - o), so the offset becomes 1 - c s - o.
    const glm::vec2 offset = pair_in(transform, "offset", glm::vec2(0.0f));
    const double angle = number_in(transform, "rotation", 0.0);
    map.mapping.turn = {std::cos(angle), std::sin(angle)};
    const glm::vec2 up = map.mapping.scale.y * map.mapping.turn;
    map.mapping.offset = {offset.x + up.y, 1.0f - up.x - offset.y};
    return map;
  }

  /// Sets the opacity from the alpha of the base colour's factor and texture, which is a mask or
  /// blends, and from the opacities of vertices if `has_vertex_opacity`.
  void set_opacity(const Json& from, bool has_vertex_opacity, Material& material) {
    const std::string mode = text_in(from, "alphaMode");
    if (mode != "MASK" && mode != "BLEND") return;
    const Json& pbr = member(from, "pbrMetallicRoughness");
    const bool is_mask = mode == "MASK";
    const std::vector<double> base_color = numbers(pbr, "baseColorFactor", 4);
    const double factor = base_color.empty() ? 1.0 : in_unit(base_color[3]);
    // The cutoff of a mask: above 1 nothing is visible.
    const double cutoff = std::max(number_in(from, "alphaCutoff", 0.5), 0.0);
    if (!is_mask) material.opacity = static_cast<float>(factor);
    if (is_mask && factor < cutoff) material.opacity = 0.0f;
    if (material.opacity == 0.0f && !has_vertex_opacity) return;
    MaterialMap map = map_of(pbr, "baseColorTexture", Texture::Content::kAlpha);
    const double least = is_mask ? cutoff / factor : 1.0;
    const bool hides_nothing =
        map.texture == kNoIndex || scene_.textures[map.texture].min_code() >= least;
    if (hides_nothing && !has_vertex_opacity) return;
    material.has_vertex_opacity = has_vertex_opacity;
    material.opacity_map = std::move(map);
    material.opacity_blends = !is_mask;
    if (is_mask) material.opacity_cutoff = static_cast<float>(least);
  }

  Material translated(const Json& from) {
    const Json &pbr = member(from, "pbrMetallicRoughness"), &specular = extension(from, kSpecular),
               &transmission = extension(from, kTransmission),
               &normal = member(from, "normalTexture");
    const auto fraction = [](const Json& object, const char* key, double otherwise) {
      return static_cast<float>(in_unit(number_in(object, key, otherwise)));
    };
    Material material;
    const Json& base = member(pbr, "baseColorTexture");
    if (index_in(base, "index") >= 0) sets_[0] = set_of(base);
    material.name = text_in(from, "name");
    if (!pbr.is_object()) (void)numbers(from, "pbrMetallicRoughness", 0);
    material.diffuse = colour_of(numbers(pbr, "baseColorFactor", 4));
    MetallicRoughness& model = material.metallic_roughness.emplace();
    model.metallic = fraction(pbr, "metallicFactor", 1.0);
    model.roughness = fraction(pbr, "roughnessFactor", 1.0);
    model.roughness_map = model.metallic_map = map_of(pbr, "metallicRoughnessTexture");
    material.diffuse_map = map_of(pbr, "baseColorTexture");
    material.normal_map = map_of(from, "normalTexture");
    const double normal_scale = number_in(normal, "scale", 1.0);
    if (std::isfinite(normal_scale)) material.normal_scale = static_cast<float>(normal_scale);
    set_opacity(from, false, material);
    if (!member(from, "occlusionTexture").is_null()) {
      file_.warn_once("occlusionTexture is not read: the rays of the scene find what is in shade");
    }

    const double strength = std::clamp(
        number_in(extension(from, "KHR_materials_emissive_strength"), "emissiveStrength", 1.0), 0.0,
        1e6);
    const std::vector<double> emission = numbers(from, "emissiveFactor", 3);
    material.emission =
        emission.empty() ? glm::vec3(0.0f) : colour_of(emission) * static_cast<float>(strength);
    if (material.emission != glm::vec3(0.0f)) {
      material.emission_map = map_of(from, "emissiveTexture");
    }
    model.specular = fraction(specular, "specularFactor", 1.0);
    model.specular_map = map_of(specular, "specularTexture", Texture::Content::kAlpha);
    model.specular_color =
        colour_of(numbers_in(specular, "specularColorFactor"), std::numeric_limits<float>::max());
    model.specular_color_map = map_of(specular, "specularColorTexture");
    model.transmission = fraction(transmission, "transmissionFactor", 0.0);
    model.transmission_map = map_of(transmission, "transmissionTexture");
    material.refraction_index = static_cast<float>(
        std::clamp(number_in(extension(from, "KHR_materials_ior"), "ior", 1.5), 1.0, 4.0));
    if (!extension(from, "KHR_materials_unlit").is_null()) {
      material.illumination_model = 0;
      material.metallic_roughness.reset();
    }
    return material;
  }

  GltfFile& file_;
  Scene& scene_;
  const bool textures_;
  std::map<int, Converted> converted_;  // by the material's index in the file
  std::array<int, 2> sets_{-1, -1};     // texcoord_sets of the material that is being read
  /// Index into Scene::textures, by image of the file and content; kNoIndex: could not be read.
  std::map<std::pair<int, Texture::Content>, std::uint32_t> texture_of_image_;
  std::int64_t texels_ = 0;  // decoded so far
};

}  // namespace raygate
