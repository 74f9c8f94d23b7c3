// What comes of loading a file, whole or in small parts: the same.
#pragma once

#include <filesystem>
#include <sstream>
#include <string>

#include "host/base/input_error.h"
#include "host/scene/io/scene_loader.h"

namespace raygate::test {

/// All that loading gives, in words: a scene, bit for bit, or an error.
inline std::string outcome(const std::filesystem::path& file, LoadOptions options) {
  std::ostringstream out;
  out << std::hexfloat;
  const auto vectors = [&](const char* name, const auto& list) {
    out << name;
    for (const auto& v : list) {
      for (int k = 0; k < static_cast<int>(v.length()); ++k) out << " " << v[k];
    }
    out << "\n";
  };
  try {
    const Scene scene = load_obj(file, options);
    vectors("positions", scene.positions);
    vectors("normals", scene.normals);
    vectors("texcoords", scene.texcoords);
    out << scene.origin.x << " " << scene.origin.y << " " << scene.origin.z << "\n";
    for (const Triangle& t : scene.triangles) {
      for (int k = 0; k < 3; ++k) {
        out << t.vertices[k] << " " << t.normals[k] << " " << t.texcoords[k] << " ";
      }
      out << t.material << " " << t.object << "\n";
    }
    for (const Material& material : scene.materials) out << material.name << "\n";
    for (const std::string& object : scene.objects.all()) out << object << "\n";
    for (const auto& read : scene.files) out << read << "\n";
    for (const std::string& warning : scene.warnings) out << warning << "\n";
  } catch (const InputError& error) {
    out << error.what();
  }
  return out.str();
}

/// Parts of a line or a few, read by several threads.
inline std::string outcome_in_parts(const std::filesystem::path& file, LoadOptions options) {
  options.threads = 3;  // a dozen parts
  options.chunk_size = 1;
  return outcome(file, options);
}

}  // namespace raygate::test
