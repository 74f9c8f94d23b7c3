// Binary files, byte by byte.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>

namespace raygate::test {

/// Returns the bytes of numbers, least significant first.
template <class... Number>
std::string bytes_of(Number... numbers) {
  std::string bytes;
  (bytes.append(reinterpret_cast<const char*>(&numbers), sizeof numbers), ...);
  return bytes;
}

/// Returns a GLB file of this JSON and buffer.
inline std::string glb(std::string json, std::string buffer) {
  json.resize((json.size() + 3) / 4 * 4, ' ');
  buffer.resize((buffer.size() + 3) / 4 * 4, '\0');
  const auto size = [](const std::string& part) { return static_cast<std::uint32_t>(part.size()); };
  return "glTF" + bytes_of(std::uint32_t{2}, 28 + size(json) + size(buffer), size(json)) + "JSON" +
         json + bytes_of(size(buffer)) + std::string("BIN\0", 4) + buffer;
}

/// Returns the glTF buffer of a unit square in the plane z = 0: two triangles with normals and
/// texture coordinates, 128 bytes, then 6 indices of 2 bytes.
inline std::string square_buffer() {
  constexpr float kCorners[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  std::string positions, normals, texcoords;
  for (const auto& [x, y] : kCorners) {
    positions += bytes_of(x, y, 0.0f);
    normals += bytes_of(0.0f, 0.0f, 1.0f);
    texcoords += bytes_of(x, 1.0f - y);
  }
  std::string indices;
  for (const std::uint16_t index : {0, 1, 2, 0, 2, 3}) indices += bytes_of(index);
  return positions + normals + texcoords + indices;
}

/// Returns the JSON for square_buffer(), with these nodes and `more` members of the file.
inline std::string square_json(const std::string& nodes, const std::string& more = "",
                               const std::string& material = "") {
  return R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": )" + nodes +
         R"(, "meshes": [{"name": "square", "primitives": [{"attributes": {"POSITION": 0,
        "NORMAL": 1, "TEXCOORD_0": 2}, "indices": 3)" +
         material + R"(}]}],
      "accessors": [
        {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
        {"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC3"},
        {"bufferView": 2, "componentType": 5126, "count": 4, "type": "VEC2"},
        {"bufferView": 3, "componentType": 5123, "count": 6, "type": "SCALAR"}],
      "bufferViews": [
        {"buffer": 0, "byteOffset": 0, "byteLength": 48},
        {"buffer": 0, "byteOffset": 48, "byteLength": 48},
        {"buffer": 0, "byteOffset": 96, "byteLength": 32},
        {"buffer": 0, "byteOffset": 128, "byteLength": 12}],
      "buffers": [{"byteLength": 140}])" +
         more + "}";
}

}  // namespace raygate::test
