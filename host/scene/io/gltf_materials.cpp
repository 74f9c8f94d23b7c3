#include "host/scene/io/gltf_materials.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include "host/base/input_error.h"
#include "host/base/srgb.h"
#include "host/scene/io/tokens.h"

namespace raygate {
namespace {

constexpr std::int64_t kMostTexels = std::int64_t{1} << 27;

double in_unit(double x) { return x >= 0.0 ? std::min(x, 1.0) : 0.0; }

/// Returns the first three numbers, clamped to [0, most]; 1 for missing ones.
glm::vec3 colour_of(const std::vector<double>& numbers, double most = 1.0) {
  glm::vec3 colour(1.0f);
  for (int k = 0; k < 3 && static_cast<std::size_t>(k) < numbers.size(); ++k) {
    const double number = numbers[static_cast<std::size_t>(k)];
    colour[k] = static_cast<float>(number >= 0.0 ? std::min(number, most) : 0.0);
  }
  return colour;
}

double number_in(const tinygltf::ExtensionMap& extensions, const char* extension, const char* key,
                 double otherwise) {
  const auto found = extensions.find(extension);
  if (found == extensions.end() || !found->second.Has(key)) return otherwise;
  const tinygltf::Value& value = found->second.Get(key);
  const double number = value.IsNumber() ? value.GetNumberAsDouble() : otherwise;
  return std::isfinite(number) ? number : otherwise;
}

glm::vec2 pair_in(const tinygltf::Value& value, const char* key, const glm::vec2& otherwise) {
  if (!value.Has(key) || !value.Get(key).IsArray() || value.Get(key).ArrayLen() != 2) {
    return otherwise;
  }
  glm::vec2 pair;
  for (int k = 0; k < 2; ++k) {
    const tinygltf::Value& number = value.Get(key).Get(k);
    pair[k] = number.IsNumber() ? static_cast<float>(number.GetNumberAsDouble()) : otherwise[k];
  }
  return pair;
}

/// Returns the three numbers at a key, with negative ones as 0; 1 for missing ones.
glm::vec3 three_in(const tinygltf::Value& value, const char* key) {
  std::vector<double> numbers;
  if (!value.Has(key) || !value.Get(key).IsArray()) return glm::vec3(1.0f);
  for (int k = 0; k < 3; ++k) {
    const tinygltf::Value& number = value.Get(key).Get(k);
    numbers.push_back(number.IsNumber() ? number.GetNumberAsDouble() : 1.0);
  }
  return colour_of(numbers, std::numeric_limits<float>::max());
}

/// Returns the texture at a key of an extension, with index -1 if there is none.
tinygltf::TextureInfo texture_in(const tinygltf::Material& material, const char* extension,
                                 const char* key) {
  tinygltf::TextureInfo info;
  const auto found = material.extensions.find(extension);
  if (found == material.extensions.end() || !found->second.Has(key)) return info;
  const tinygltf::Value& texture = found->second.Get(key);
  const auto number = [&](const char* name, int otherwise) {
    const bool is_given = texture.Has(name) && texture.Get(name).IsInt();
    return is_given ? texture.Get(name).Get<int>() : otherwise;
  };
  info.index = number("index", -1);
  info.texCoord = number("texCoord", 0);
  if (texture.Has("extensions") && texture.Get("extensions").IsObject()) {
    info.extensions = texture.Get("extensions").Get<tinygltf::Value::Object>();
  }
  return info;
}

/// Returns the number of the set of coordinates that a texture uses.
template <class TextureInfo>
int set_of(const TextureInfo& info) {
  const double set = number_in(info.extensions, "KHR_texture_transform", "texCoord", info.texCoord);
  return static_cast<int>(std::clamp(set, -1.0, 1e6));
}

constexpr const char *kCoat = "KHR_materials_clearcoat", *kSpecular = "KHR_materials_specular",
                     *kTransmission = "KHR_materials_transmission";

}  // namespace

std::uint32_t GltfMaterials::number_of(int material) {
  const auto [entry, is_new] =
      numbers_.try_emplace(material, static_cast<std::uint32_t>(scene_.materials.size()));
  if (is_new) {
    Material result;
    result.name = "default";
    if (material != -1)
      result = translated(file_.at(file_.model().materials, material, "material"));
    scene_.materials.push_back(std::move(result));
  }
  return entry->second;
}

GltfMaterials::Sets GltfMaterials::texcoord_sets(int material) {
  if (material < 0) return {-1, -1};
  return sets_of(file_.at(file_.model().materials, material, "material"));
}

GltfMaterials::Sets GltfMaterials::sets_of(const tinygltf::Material& from) {
  const tinygltf::PbrMetallicRoughness& pbr = from.pbrMetallicRoughness;
  Sets sets{-1, -1};
  const auto look = [&](const auto& info) {
    if (info.index < 0) return;
    const int set = set_of(info);
    auto at = std::ranges::find(sets, set);
    if (at == sets.end()) at = std::ranges::find(sets, -1);
    if (at != sets.end()) {
      *at = set;
    } else {
      file_.warn_once(
          "of textures of one material with three sets of coordinates the third is not read",
          scene_.warnings);
    }
  };
  look(pbr.baseColorTexture);
  look(pbr.metallicRoughnessTexture);
  look(from.normalTexture);
  look(from.emissiveTexture);
  look(texture_in(from, kCoat, "clearcoatTexture"));
  look(texture_in(from, kCoat, "clearcoatRoughnessTexture"));
  look(texture_in(from, kTransmission, "transmissionTexture"));
  look(texture_in(from, kSpecular, "specularTexture"));
  look(texture_in(from, kSpecular, "specularColorTexture"));
  return sets;
}

std::optional<Texture> GltfMaterials::picture(int texture, Texture::Content content) {
  if (!textures_) return std::nullopt;
  const tinygltf::Model& model = file_.model();
  const int source = file_.at(model.textures, texture, "texture").source;
  if (source < 0) {
    file_.warn_once("a texture without a PNG or JPEG picture is left out", scene_.warnings);
    return std::nullopt;
  }
  const std::string bytes = file_.picture_bytes(source);
  if (bytes.empty()) {
    const std::string& uri = model.images[static_cast<std::size_t>(source)].uri;
    file_.fail(uri.empty() ? "image " + std::to_string(source) + " has no picture"
                           : "the texture " + in_quotes(uri) + " is missing");
  }
  Texture result =
      Texture::decode(bytes, file_.name() + ": image " + std::to_string(source), content);
  texels_ += std::int64_t{result.width()} * result.height();
  if (texels_ > kMostTexels) {
    file_.fail("textures of more than " + std::to_string(kMostTexels) + " pixels in all");
  }
  return result;
}

template <class TextureInfo>
MaterialMap GltfMaterials::map_of(const TextureInfo& info, Texture::Content content) {
  try {
    return read_map(info, content);
  } catch (const InputError& error) {
    file_.warn_once(error, "its material is plain instead", scene_.warnings);
    return {};
  }
}

template <class TextureInfo>
MaterialMap GltfMaterials::read_map(const TextureInfo& info, Texture::Content content) {
  MaterialMap map;
  const int texture = info.index;
  if (texture < 0) return map;
  map.mapping.is_second = set_of(info) == sets_[1];
  const tinygltf::Model& model = file_.model();
  const tinygltf::Texture& from = file_.at(model.textures, texture, "texture");
  const auto [entry, is_new] =
      texture_of_image_.try_emplace(std::pair(from.source, content), kNoIndex);
  if (is_new) {
    if (std::optional<Texture> decoded = picture(texture, content)) {
      entry->second = static_cast<std::uint32_t>(scene_.textures.size());
      scene_.textures.push_back(std::move(*decoded));
    }
  }
  map.texture = entry->second;
  if (from.sampler >= 0) {
    const tinygltf::Sampler& sampler = file_.at(model.samplers, from.sampler, "sampler");
    const auto wrap_of = [&](int mode) {
      if (mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return Wrap::kClamp;
      if (mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT) return Wrap::kMirror;
      if (mode != TINYGLTF_TEXTURE_WRAP_REPEAT) {
        file_.warn_once("sampler " + std::to_string(from.sampler) + ": found the wrap mode " +
                            std::to_string(mode) + ", expected 10497, 33071 or 33648; repeated",
                        scene_.warnings);
      }
      return Wrap::kRepeat;
    };
    map.mapping.sampling.u = wrap_of(sampler.wrapS);
    map.mapping.sampling.v = wrap_of(sampler.wrapT);
    map.mapping.sampling.is_nearest = sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
  }
  const auto transform = info.extensions.find("KHR_texture_transform");
  if (transform == info.extensions.end()) return map;
  map.mapping.scale = pair_in(transform->second, "scale", glm::vec2(1.0f));
  // The file's v points down: 1 - (c s v + o) = c s (1 - v) + 1 - c s - o.
  const glm::vec2 offset = pair_in(transform->second, "offset", glm::vec2(0.0f));
  const double angle = number_in(info.extensions, "KHR_texture_transform", "rotation", 0.0);
  map.mapping.turn = {std::cos(angle), std::sin(angle)};
  const glm::vec2 up = map.mapping.scale.y * map.mapping.turn;
  map.mapping.offset = {offset.x + up.y, 1.0f - up.x - offset.y};
  return map;
}

bool GltfMaterials::has_opacity(int material) const {
  if (material < 0) return false;
  const std::string& mode = file_.at(file_.model().materials, material, "material").alphaMode;
  return mode == "MASK" || mode == "BLEND";
}

void GltfMaterials::use_vertex_opacity(int material) {
  const tinygltf::Material& from = file_.at(file_.model().materials, material, "material");
  const tinygltf::PbrMetallicRoughness& pbr = from.pbrMetallicRoughness;
  const tinygltf::TextureInfo& base = pbr.baseColorTexture;
  Material& to = scene_.materials[number_of(material)];
  sets_ = sets_of(from);
  to.has_vertex_opacity = true;
  to.opacity_blends = from.alphaMode == "BLEND";
  to.opacity_map = map_of(base, Texture::Content::kAlpha);
  const double factor = pbr.baseColorFactor.size() == 4 ? in_unit(pbr.baseColorFactor[3]) : 1.0;
  if (!to.opacity_blends)
    to.opacity_cutoff = static_cast<float>(std::max(from.alphaCutoff, 0.0) / factor);
}

/// Sets the opacity from the base colour's factor and texture, which blend or are a mask.
void GltfMaterials::set_opacity(const tinygltf::Material& from, Material& material) {
  const tinygltf::PbrMetallicRoughness& pbr = from.pbrMetallicRoughness;
  if (from.alphaMode != "MASK" && from.alphaMode != "BLEND") return;
  const bool is_mask = from.alphaMode == "MASK";
  const double factor = pbr.baseColorFactor.size() == 4 ? in_unit(pbr.baseColorFactor[3]) : 1.0;
  const double cutoff = std::max(from.alphaCutoff, 0.0);  // above 1 nothing is visible
  if (!is_mask) material.opacity = static_cast<float>(factor);
  if (is_mask && factor < cutoff) material.opacity = 0.0f;
  const tinygltf::TextureInfo& base = pbr.baseColorTexture;
  if (base.index < 0 || material.opacity == 0.0f) return;
  MaterialMap map = map_of(base, Texture::Content::kAlpha);
  const double least = is_mask ? cutoff / factor : 1.0;
  if (map.texture == kNoIndex || scene_.textures[map.texture].min_code() >= least) return;
  material.opacity_map = std::move(map);
  material.opacity_blends = !is_mask;
  if (is_mask) material.opacity_cutoff = static_cast<float>(least);
}

Material GltfMaterials::translated(const tinygltf::Material& from) {
  const tinygltf::PbrMetallicRoughness& pbr = from.pbrMetallicRoughness;
  Material material;
  sets_ = sets_of(from);
  material.name = from.name;
  const glm::vec3 base = colour_of(pbr.baseColorFactor);
  material.diffuse = base;
  MetallicRoughness& shares = material.metallic_roughness.emplace();
  shares.metallic = static_cast<float>(in_unit(pbr.metallicFactor));
  shares.roughness = static_cast<float>(in_unit(pbr.roughnessFactor));
  const auto colour = Texture::Content::kColour;
  shares.map = map_of(pbr.metallicRoughnessTexture, colour);
  const MaterialMap diffuse = map_of(pbr.baseColorTexture, colour);
  material.diffuse_texture = diffuse.texture;
  material.diffuse_mapping = diffuse.mapping;
  material.normal_map = map_of(from.normalTexture, colour);
  material.normal_scale =
      static_cast<float>(std::isfinite(from.normalTexture.scale) ? from.normalTexture.scale : 1.0);
  set_opacity(from, material);
  if (from.occlusionTexture.index >= 0) {
    file_.warn_once("occlusionTexture is not read: the rays of the scene find what is in shade",
                    scene_.warnings);
  }

  const double strength = std::clamp(
      number_in(from.extensions, "KHR_materials_emissive_strength", "emissiveStrength", 1.0), 0.0,
      1e6);
  material.emission = from.emissiveFactor.size() == 3
                          ? colour_of(from.emissiveFactor) * static_cast<float>(strength)
                          : glm::vec3(0.0f);
  if (material.emission != glm::vec3(0.0f)) {
    material.emission_map = map_of(from.emissiveTexture, colour);
  }
  const auto share = [&](const char* extension, const char* key, double otherwise) {
    return static_cast<float>(in_unit(number_in(from.extensions, extension, key, otherwise)));
  };
  const auto map = [&](const char* extension, const char* key, Texture::Content content) {
    const tinygltf::TextureInfo info = texture_in(from, extension, key);
    return map_of(info, content);
  };
  shares.specular = share(kSpecular, "specularFactor", 1.0);
  shares.specular_map = map(kSpecular, "specularTexture", Texture::Content::kAlpha);
  if (const auto found = from.extensions.find(kSpecular); found != from.extensions.end()) {
    shares.specular_color = three_in(found->second, "specularColorFactor");
  }
  shares.specular_color_map = map(kSpecular, "specularColorTexture", colour);
  shares.transmission = share(kTransmission, "transmissionFactor", 0.0);
  shares.transmission_map = map(kTransmission, "transmissionTexture", colour);
  shares.coat = share(kCoat, "clearcoatFactor", 0.0);
  shares.coat_roughness = share(kCoat, "clearcoatRoughnessFactor", 0.0);
  shares.coat_map = map(kCoat, "clearcoatTexture", colour);
  shares.coat_roughness_map = map(kCoat, "clearcoatRoughnessTexture", colour);
  if (texture_in(from, kCoat, "clearcoatNormalTexture").index >= 0) {
    file_.warn_once(
        "clearcoatNormalTexture is not read: a coat has the normals of what is under it",
        scene_.warnings);
  }
  material.refraction_index = static_cast<float>(
      std::clamp(number_in(from.extensions, "KHR_materials_ior", "ior", 1.5), 1.0, 4.0));
  if (from.extensions.contains("KHR_materials_unlit")) {
    material.illumination_model = 0;
    material.metallic_roughness.reset();
  }
  return material;
}

}  // namespace raygate
