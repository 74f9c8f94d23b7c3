// GltfFile, for gltf_loader.cpp: checked access to JSON, buffers and images of a glTF 2.0 file.
#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "host/base/input.h"
#include "host/base/input_error.h"
#include "host/scene/io/json_reader.h"
#include "host/scene/io/scene_loader.h"

namespace raygate {

// Access to members of JSON objects. Files of other programs often have small errors, so a member
// of a wrong type counts as missing, and so do all members of a value that is not an object.

/// Returns the member at a key; null if it is missing.
inline const Json& member(const Json& object, const char* key) {
  static const Json kMissing;
  if (!object.is_object()) return kMissing;
  const auto found = object.find(key);
  return found == object.end() ? kMissing : *found;
}

inline double number_in(const Json& object, const char* key, double otherwise) {
  const Json& value = member(object, key);
  return value.is_number() ? value.get<double>() : otherwise;
}

/// Returns an integer, or -1 (no valid index) for other values and for integers beyond an int.
inline int index_of(const Json& value) {
  const double index = value.is_number_integer() ? value.get<double>() : -1.0;
  return std::abs(index) <= std::numeric_limits<int>::max() ? static_cast<int>(index) : -1;
}

inline int index_in(const Json& object, const char* key) { return index_of(member(object, key)); }

/// Returns a size or an offset; 0 if it is missing.
inline std::size_t size_in(const Json& object, const char* key) {
  const Json& value = member(object, key);
  return value.is_number_unsigned() ? value.get<std::size_t>() : 0;
}

inline std::string text_in(const Json& object, const char* key) {
  const Json& value = member(object, key);
  return value.is_string() ? value.get<std::string>() : std::string();
}

inline std::vector<std::string> texts_in(const Json& object, const char* key) {
  std::vector<std::string> texts;
  for (const Json& text : member(object, key)) {
    if (text.is_string()) texts.push_back(text);
  }
  return texts;
}

/// Returns an array of numbers; an empty list unless all elements are numbers.
inline std::vector<double> numbers_in(const Json& object, const char* key) {
  const Json& list = member(object, key);
  const bool are_numbers =
      list.is_array() &&
      std::all_of(list.begin(), list.end(), [](const Json& value) { return value.is_number(); });
  return are_numbers ? list.get<std::vector<double>>() : std::vector<double>();
}

/// Returns an array of indices, with -1 for elements that are not integers.
inline std::vector<int> indices_in(const Json& object, const char* key) {
  std::vector<int> indices;
  const Json& list = member(object, key);
  if (!list.is_array()) return indices;
  for (const Json& index : list) indices.push_back(index_of(index));
  return indices;
}

/// Returns an extension of a part of the file; null if it is missing.
inline const Json& extension(const Json& part, const char* name) {
  return member(member(part, "extensions"), name);
}

/// Returns the transform from a node's coordinates to its parent's.
inline glm::dmat4 local_matrix(const Json& node) {
  const std::vector<double> matrix = numbers_in(node, "matrix");
  if (matrix.size() == 16) return glm::make_mat4(matrix.data());
  const std::vector<double> t = numbers_in(node, "translation"), r = numbers_in(node, "rotation"),
                            s = numbers_in(node, "scale");
  glm::dmat4 result(1.0);
  if (t.size() == 3) result[3] = glm::dvec4(t[0], t[1], t[2], 1.0);
  if (r.size() == 4) {
    const glm::dquat turn(r[3], r[0], r[1], r[2]);
    const double length = glm::length(turn);
    if (length > 0.0) result = result * glm::mat4_cast(turn / length);
  }
  for (std::size_t axis = 0; s.size() == 3 && axis < 3; ++axis) {
    result[static_cast<int>(axis)] *= s[axis];
  }
  return result;
}

/// A .gltf or .glb file with its buffers.
class GltfFile {
 public:
  std::string name;
  std::vector<std::filesystem::path> files;  ///< all files read so far
  std::size_t bytes = 0;                     ///< total size of `files`
  Json json;

  /// Appends warnings to `warnings`, which must outlive this object. Throws InputError if a file
  /// cannot be read, is not glTF 2.0 or requires an extension that is not supported.
  GltfFile(const std::filesystem::path& file, std::vector<std::string>& warnings)
      : name(file.string()), folder_(file.parent_path()), warnings_(warnings) {
    std::string_view text = read(file), binary;
    if (text.starts_with("glTF")) {
      std::string_view rest = text.substr(std::min<std::size_t>(text.size(), 12));
      const auto take_chunk = [&](std::string_view type) {
        if (rest.size() < 8 || rest.substr(4, 4) != type) return std::string_view();
        const std::size_t size =
            std::min<std::size_t>(number_at<std::uint32_t>(rest.data()), rest.size() - 8);
        const std::string_view chunk = rest.substr(8, size);
        rest.remove_prefix(std::min(8 + (size + 3) / 4 * 4, rest.size()));
        return chunk;
      };
      text = take_chunk("JSON");
      binary = take_chunk({"BIN\0", 4});
      if (text.empty()) fail("a GLB file that ends too soon");
    }
    LineBuffer lines(text);
    json = parse_json(lines, name);
    const std::string version = text_in(list("asset"), "version");
    if (version.empty()) fail("not a glTF 2.0 file that can be read: no asset with a version");
    if (!version.starts_with("2.")) fail("glTF version " + in_quotes(version) + ", expected 2.0");
    for (const std::string& needed : texts_in(json, "extensionsRequired")) {
      if (!is_in(kRead, needed) && !is_in(kDispensable, needed)) fail_extension(needed);
    }
    for (const std::string& used : texts_in(json, "extensionsUsed")) {
      if (!is_in(kRead, used)) warn_once("the extension " + in_quotes(used) + " is not read");
    }
    if (binary.empty()) contents_.clear();
    for (const Json& buffer : list("buffers")) {
      const std::string uri = text_in(buffer, "uri");
      if (uri.empty()) {
        buffers_.push_back(buffers_.empty() ? binary : std::string_view());
      } else if (const auto buffer_bytes = load(uri)) {
        buffers_.push_back(*buffer_bytes);
      } else {
        fail("the buffer " + in_quotes(uri) + " is missing");
      }
    }
  }

  [[noreturn]] void fail(const std::string& what) const { throw InputError(name + ": " + what); }
  /// Adds the warning "file: what" unless it was added before.
  void warn_once(const std::string& what) { add_warning(name + ": " + what); }
  /// Calls `read`. An InputError becomes a warning that ends in `instead`.
  template <class Read>
  void optionally(const char* instead, const Read& read) {
    try {
      read();
    } catch (const InputError& error) {
      add_warning(error.what() + std::string(", ") + instead);
    }
  }

  /// Returns a list of the file, such as "nodes"; null if it has none.
  [[nodiscard]] const Json& list(const char* key) const { return member(json, key); }
  /// Returns element `index` of a list. If there is none, throws InputError that names it `what`.
  [[nodiscard]] const Json& at(const Json& list, int index, const char* what) const {
    const std::size_t size = list.is_array() ? list.size() : 0;
    if (index >= 0 && static_cast<std::size_t>(index) < size) {
      return list[static_cast<std::size_t>(index)];
    }
    fail(std::string(what) + " " + std::to_string(index) + ", but the file has " +
         std::to_string(size));
  }
  [[nodiscard]] const Json& accessor(int index) const {
    return at(list("accessors"), index, "accessor");
  }
  [[nodiscard]] std::size_t count(int accessor) const {
    return size_in(this->accessor(accessor), "count");
  }

  /// Returns the first `wanted` components of each element of an accessor; they may be infinite or
  /// NaN. Throws InputError if the accessor cannot be read.
  [[nodiscard]] std::vector<double> numbers(int accessor, std::size_t wanted, const char* what,
                                            bool are_indices = false) const {
    static const std::map<std::string, std::size_t> kTypes = {
        {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4},
        {"MAT2", 4},   {"MAT3", 9}, {"MAT4", 16}};
    const std::string place = "accessor " + std::to_string(accessor) + " (" + what + "): ";
    const Json& from = this->accessor(accessor);
    const auto type = kTypes.find(text_in(from, "type"));
    if (type == kTypes.end()) fail(place + "of an unknown type");
    const Component& component = component_of(from, place);
    const std::size_t width = type->second, count = this->count(accessor);
    const bool is_index = component.type == NumberType::kUint8 ||
                          component.type == NumberType::kUint16 ||
                          component.type == NumberType::kUint32;
    if (are_indices && !is_index) fail(place + "not of whole numbers");
    if (!are_indices && component.type == NumberType::kUint32) {
      fail(place + "numbers of a type that is not expected there");
    }
    if (width < wanted) fail(place + "too few components");
    std::vector<double> all;
    if (!member(from, "bufferView").is_null()) {
      all = stored_numbers(from, component, width, count, place);
    } else {  // all are 0, apart from sparse elements
      constexpr std::size_t kMost = 1'000'000;
      if (count > kMost + bytes) fail(place + "too many elements without a buffer");
      all.assign(width * count, 0.0);
    }
    if (const Json& sparse = member(from, "sparse"); sparse.is_object()) {
      const std::size_t changes = size_in(sparse, "count");
      const Json& indices = member(sparse, "indices");
      const std::vector<double> places = stored_numbers(indices, component_of(indices, place), 1,
                                                        changes, place),
                                values = stored_numbers(member(sparse, "values"), component, width,
                                                        changes, place);
      for (std::size_t i = 0; i < changes; ++i) {
        if (!(places[i] >= 0.0 && places[i] < static_cast<double>(count))) {
          fail(place + "a sparse element beyond its end");
        }
        const std::size_t at = static_cast<std::size_t>(places[i]) * width;
        for (std::size_t k = 0; k < width; ++k) all[at + k] = values[i * width + k];
      }
    }
    const Json& normalized = member(from, "normalized");
    const bool is_normalized = !are_indices && normalized.is_boolean() && normalized.get<bool>();
    if (width == wanted && !is_normalized) return all;
    std::vector<double> numbers;
    numbers.reserve(count * wanted);
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (i % width >= wanted) continue;
      numbers.push_back(is_normalized ? std::max(all[i] / component.one, -1.0) : all[i]);
    }
    return numbers;
  }
  /// Returns the components of an optional attribute. Returns an empty list for accessor -1 and,
  /// with a warning, for an accessor that cannot be read or has not `vertices` elements.
  [[nodiscard]] std::vector<double> optional_numbers(int accessor, std::size_t width,
                                                     const char* what, std::size_t vertices) {
    std::vector<double> all;
    if (accessor < 0) return all;
    optionally("left out", [&] {
      if (count(accessor) != vertices) {
        fail(std::string(what) + ": found " + std::to_string(count(accessor)) + ", expected " +
             std::to_string(vertices));
      }
      all = numbers(accessor, width, what);
    });
    return all;
  }
  /// Returns the encoded bytes of image `number`. Throws InputError if the image is missing.
  [[nodiscard]] std::string_view picture_bytes(int number) {
    const Json& image = at(list("images"), number, "image");
    const std::string place = "image " + std::to_string(number);
    if (!member(image, "bufferView").is_null()) return stored(image, place + ": ");
    const std::string uri = text_in(image, "uri");
    const auto picture = uri.empty() ? std::nullopt : load(uri);
    if (!picture && !uri.empty()) fail("the texture " + in_quotes(uri) + " is missing");
    if (!picture || picture->empty()) fail(place + " has no picture");
    return *picture;
  }

 private:
  /// Extensions that are read. A file that uses another one gets a warning.
  static constexpr std::string_view kRead[] = {
      "KHR_lights_punctual",        "KHR_materials_emissive_strength",
      "KHR_materials_ior",          "KHR_materials_specular",
      "KHR_materials_transmission", "KHR_materials_unlit",
      "KHR_mesh_quantization",      "KHR_texture_transform"};
  /// Extensions that are not read but may be required: without them, surfaces are only plainer.
  static constexpr std::string_view kDispensable[] = {
      "KHR_materials_clearcoat", "KHR_materials_sheen", "KHR_materials_variants",
      "KHR_materials_volume"};
  static constexpr std::string_view kCompressions[] = {
      "KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression"};

  /// A component type, with the code that stands for 1 in normalized accessors.
  struct Component {
    int code;
    NumberType type;
    double one;
  };

  static bool is_in(std::span<const std::string_view> list, std::string_view extension) {
    return std::ranges::find(list, extension) != list.end();
  }

  /// Decodes the escapes %XX of a URI.
  static std::string decode_uri(std::string_view uri) {
    std::string text;
    for (std::size_t i = 0; i < uri.size(); ++i) {
      unsigned code = 0;
      const char* const digits = uri.data() + i + 1;
      if (uri[i] == '%' && i + 2 < uri.size() &&
          std::from_chars(digits, digits + 2, code, 16).ptr == digits + 2) {
        text += static_cast<char>(code);
        i += 2;
      } else {
        text += uri[i];
      }
    }
    return text;
  }

  /// Decodes base64 (RFC 4648) up to the first character that is no base64 digit.
  static std::string decode_base64(std::string_view text) {
    constexpr std::string_view kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string decoded;
    decoded.reserve(text.size() / 4 * 3);
    std::uint32_t bits = 0;
    int count = 0;
    for (const char digit : text) {
      const std::size_t value = kDigits.find(digit);
      if (value == kDigits.npos) break;
      bits = bits << 6 | static_cast<std::uint32_t>(value);
      count += 6;
      if (count < 8) continue;
      count -= 8;
      decoded += static_cast<char>(bits >> count & 0xFF);
    }
    return decoded;
  }

  std::string_view read(const std::filesystem::path& file) {
    const std::string& contents = contents_.emplace_back(read_file(file));
    files.push_back(file);
    bytes += contents.size();
    return contents;
  }

  /// Returns the bytes of a data URI, or of the file that the URI names; nullopt if there are none.
  std::optional<std::string_view> load(const std::string& uri) {
    constexpr std::string_view kBase64 = ";base64,";
    if (uri.starts_with("data:")) {
      const std::size_t at = uri.find(kBase64);
      if (at == std::string::npos) return std::nullopt;
      return contents_.emplace_back(
          decode_base64(std::string_view(uri).substr(at + kBase64.size())));
    }
    const auto file = find_file(folder_, decode_uri(uri), name + ": ", warnings_);
    if (!file) return std::nullopt;
    return read(*file);
  }

  void add_warning(const std::string& warning) {
    if (std::ranges::find(warnings_, warning) == warnings_.end()) warnings_.push_back(warning);
  }

  [[noreturn]] void fail_extension(const std::string& extension) const {
    fail("found the extension " + in_quotes(extension) + ", which is not read; expected " +
         (is_in(kCompressions, extension)
              ? "a file without compression: exported with Compression off, or as "
                "`npx @gltf-transform/cli copy in.glb out.glb` writes it"
              : "an export without it"));
  }

  [[nodiscard]] const Component& component_of(const Json& part, const std::string& place) const {
    static constexpr Component kComponents[] = {
        {5120, NumberType::kInt8, 127.0},          {5121, NumberType::kUint8, 255.0},
        {5122, NumberType::kInt16, 32767.0},       {5123, NumberType::kUint16, 65535.0},
        {5125, NumberType::kUint32, 4294967295.0}, {5126, NumberType::kFloat, 1.0}};
    const auto* const found =
        std::ranges::find(kComponents, index_in(part, "componentType"), &Component::code);
    if (found == std::end(kComponents)) fail(place + "of an unknown type");
    return *found;
  }

  /// Returns the bytes of the buffer view of `part`. Throws InputError, which names `place`, if
  /// `part` has no buffer view or the view exceeds its buffer.
  [[nodiscard]] std::string_view stored(const Json& part, const std::string& place) const {
    const int number = index_in(part, "bufferView");
    if (number < 0) fail(place + "found no buffer view, expected its number");
    const Json& view = at(list("bufferViews"), number, "buffer view");
    const int buffer = index_in(view, "buffer");
    if (buffer < 0 || static_cast<std::size_t>(buffer) >= buffers_.size()) {
      // The data may be compressed; then the extension's message is more helpful.
      for (const std::string& used : texts_in(json, "extensionsUsed")) {
        if (is_in(kCompressions, used)) fail_extension(used);
      }
      fail(place + "buffer " + std::to_string(buffer) + ", but the file has " +
           std::to_string(buffers_.size()));
    }
    const std::string_view data = buffers_[static_cast<std::size_t>(buffer)];
    const std::size_t offset = size_in(view, "byteOffset"), length = size_in(view, "byteLength");
    if (offset > data.size() || length > data.size() - offset) {
      fail(place + "beyond its buffer, which ends too soon");
    }
    return data.substr(offset, length);
  }

  /// Returns `count` elements of `width` numbers from `part`: an accessor, or the indices or values
  /// of a sparse accessor. Throws InputError if the elements exceed the buffer view.
  [[nodiscard]] std::vector<double> stored_numbers(const Json& part, const Component& component,
                                                   std::size_t width, std::size_t count,
                                                   const std::string& place) const {
    std::string_view data = stored(part, place);
    const Json& view = list("bufferViews")[std::size_t(index_in(part, "bufferView"))];
    const NumberType type = component.type;
    const std::size_t size = width * bytes_of(type), offset = size_in(part, "byteOffset"),
                      stride = std::max(size_in(view, "byteStride"), size);
    data.remove_prefix(std::min(offset, data.size()));
    const bool is_within =
        count > 0 && size <= data.size() && count - 1 <= (data.size() - size) / stride;
    if (!is_within) fail(place + "beyond its buffer, which ends too soon");
    std::vector<double> numbers;
    numbers.reserve(count * width);
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t k = 0; k < width; ++k) {
        numbers.push_back(number_at(data.data() + i * stride + k * bytes_of(type), type));
      }
    }
    return numbers;
  }

  std::filesystem::path folder_;
  std::vector<std::string>& warnings_;
  std::deque<std::string> contents_;  // of files and data URIs
  std::vector<std::string_view> buffers_;
};

}  // namespace raygate
