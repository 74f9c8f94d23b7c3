#include "host/scene/io/gltf_mending.h"

#include <tiny_gltf.h>

#include <algorithm>
#include <initializer_list>
#include <nlohmann/json.hpp>

#include "host/scene/io/tokens.h"

namespace raygate {
namespace {

using Json = nlohmann::json;

/// Replaces a value that is not an object by an empty object, and returns it.
Json& as_object(Json& value) {
  if (!value.is_object()) value = Json::object();
  return value;
}

void default_numbers(Json& object, std::initializer_list<const char*> keys) {
  for (const char* const key : keys) {
    if (!object[key].is_number()) object[key] = 0;
  }
}

bool has_integers(const Json& object, std::initializer_list<const char*> keys) {
  return object.is_object() && std::ranges::all_of(keys, [&](const char* key) {
           return object.contains(key) && object[key].is_number_integer();
         });
}

bool has_picture(const Json& image, std::size_t buffer_views) {
  const bool has_view = image.contains("bufferView");
  if (has_view == image.contains("uri")) return false;
  if (has_view) {
    return has_integers(image, {"bufferView"}) && image["bufferView"] >= 0 &&
           image["bufferView"] < buffer_views;
  }
  if (!image["uri"].is_string()) return false;
  const auto uri = image["uri"].get<std::string>();
  std::vector<unsigned char> bytes;
  std::string type;
  return !tinygltf::IsDataURI(uri) || tinygltf::DecodeDataURI(&bytes, type, uri, 0, false);
}

void mend_camera(Json& camera) {
  const bool is_orthographic = camera["type"] == "orthographic";
  camera["type"] = is_orthographic ? "orthographic" : "perspective";
  if (is_orthographic) {
    default_numbers(as_object(camera["orthographic"]), {"xmag", "ymag", "zfar", "znear"});
  } else {
    default_numbers(as_object(camera["perspective"]), {"yfov", "znear"});
  }
}

}  // namespace

std::string mend_gltf(std::string_view json, std::vector<std::string>& warnings) {
  Json file = Json::parse(json, nullptr, false);
  if (!file.is_object()) return std::string(json);
  const auto each = [](Json& parent, const char* list, const auto& mend) {
    if (!parent.is_object() || !parent.contains(list) || !parent[list].is_array()) return;
    for (Json& part : parent[list]) mend(as_object(part));
  };

  const std::size_t views = file.contains("bufferViews") ? file["bufferViews"].size() : 0;
  each(file, "images", [&](Json& image) {
    if (!has_picture(image, views)) image = {{"uri", ""}};
  });
  each(file, "cameras", mend_camera);
  each(as_object(as_object(file["extensions"])["KHR_lights_punctual"]), "lights", [&](Json& light) {
    if (!light["type"].is_string()) light["type"] = "";
    if (light["type"] != "spot" || light["spot"].is_object()) return;
    light["spot"] = Json::object();
    warnings.emplace_back("a spot light without 'spot' has the usual cone");
  });
  each(file, "accessors", [](Json& accessor) {
    if (!accessor.contains("sparse")) return;
    const Json& sparse = accessor["sparse"];
    if (has_integers(sparse, {"count"}) && sparse.contains("indices") &&
        has_integers(sparse["indices"], {"bufferView", "componentType"}) &&
        sparse.contains("values") && has_integers(sparse["values"], {"bufferView"})) {
      return;
    }
    accessor["sparse"] = {{"count", 1},
                          {"indices", {{"bufferView", -1}, {"componentType", 5125}}},
                          {"values", {{"bufferView", -1}}}};
  });
  each(file, "materials", [&](Json& material) {
    const auto leave_out = [&](Json& from, const char* key, const auto& is_right) {
      if (!from.is_object() || !from.contains(key) || is_right(from[key])) return;
      from.erase(key);
      warnings.push_back(in_quotes(key) + " of a material is not as glTF has it, left out");
    };
    const auto is_object = [](const Json& value) { return value.is_object(); };
    const auto is_texture = [](const Json& value) { return has_integers(value, {"index"}); };
    const auto has_size = [](std::size_t size) {
      return [size](const Json& value) { return value.is_array() && value.size() == size; };
    };
    leave_out(material, "pbrMetallicRoughness", is_object);
    leave_out(material, "emissiveFactor", has_size(3));
    for (const char* const key : {"normalTexture", "occlusionTexture", "emissiveTexture"}) {
      leave_out(material, key, is_texture);
    }
    if (!material.contains("pbrMetallicRoughness")) return;
    Json& pbr = material["pbrMetallicRoughness"];
    leave_out(pbr, "baseColorFactor", has_size(4));
    for (const char* const key : {"baseColorTexture", "metallicRoughnessTexture"}) {
      leave_out(pbr, key, is_texture);
    }
  });
  each(file, "skins", [&](Json& skin) {
    if (skin["joints"].is_array()) return;
    skin["joints"] = Json::array();
    warnings.emplace_back("a skin without joints is left out");
  });
  for (const char* const list : {"textures", "samplers"}) each(file, list, [](Json&) {});
  if (file.contains("animations")) warnings.emplace_back("animations are not read");
  file.erase("animations");
  return file.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace raygate
