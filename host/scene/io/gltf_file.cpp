#include "host/scene/io/gltf_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <map>
#include <span>
#include <utility>

#include "host/base/input.h"
#include "host/scene/io/scene_loader.h"
#include "host/scene/io/text.h"

namespace raygate {
namespace {

/// Extensions that are read. A file that uses another one gets a warning.
constexpr std::string_view kRead[] = {
    "KHR_lights_punctual",        "KHR_materials_emissive_strength",
    "KHR_materials_ior",          "KHR_materials_specular",
    "KHR_materials_transmission", "KHR_materials_unlit",
    "KHR_mesh_quantization",      "KHR_texture_transform"};

/// Extensions that are not read but may be required: without them, surfaces are only plainer.
constexpr std::string_view kDispensable[] = {"KHR_materials_clearcoat", "KHR_materials_sheen",
                                             "KHR_materials_variants", "KHR_materials_volume"};

constexpr std::string_view kCompressions[] = {"KHR_draco_mesh_compression",
                                              "EXT_meshopt_compression", "KHR_meshopt_compression"};

bool is_in(std::span<const std::string_view> list, std::string_view extension) {
  return std::ranges::find(list, extension) != list.end();
}

std::vector<std::string> texts_in(const Json& object, const char* key) {
  std::vector<std::string> texts;
  for (const Json& text : member(object, key)) {
    if (text.is_string()) texts.push_back(text);
  }
  return texts;
}

/// Returns a size or an offset; 0 if it is missing.
std::size_t size_in(const Json& object, const char* key) {
  const Json& value = member(object, key);
  return value.is_number_unsigned() ? value.get<std::size_t>() : 0;
}

/// Decodes the escapes %XX of a URI.
std::string decode_uri(std::string_view uri) {
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

/// Decodes base64 (RFC 4648) up to the first other character.
std::string decode_base64(std::string_view text) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::array<int, 256> values;
  values.fill(-1);
  for (std::size_t i = 0; i < kDigits.size(); ++i) {
    values[static_cast<unsigned char>(kDigits[i])] = static_cast<int>(i);
  }
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3);
  std::uint32_t bits = 0;
  int count = 0;
  for (const char digit : text) {
    const int value = values[static_cast<unsigned char>(digit)];
    if (value < 0) break;
    bits = bits << 6 | static_cast<std::uint32_t>(value);
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += static_cast<char>(bits >> count & 0xFF);
  }
  return bytes;
}

}  // namespace

const Json& extension(const Json& part, const char* name) {
  return member(member(part, "extensions"), name);
}

GltfFile::GltfFile(const std::filesystem::path& file, std::vector<std::string>& warnings)
    : name_(file.string()), folder_(file.parent_path()), warnings_(warnings) {
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
  json_ = parse_json(text, name_);
  const std::string version = text_in(list("asset"), "version");
  if (version.empty()) fail("not a glTF 2.0 file that can be read: no asset with a version");
  if (!version.starts_with("2.")) fail("glTF version " + in_quotes(version) + ", expected 2.0");
  for (const std::string& name : texts_in(json_, "extensionsRequired")) {
    if (!is_in(kRead, name) && !is_in(kDispensable, name)) fail_extension(name);
  }
  for (const std::string& name : texts_in(json_, "extensionsUsed")) {
    if (!is_in(kRead, name)) {
      warn_once("the extension " + in_quotes(name) + " is not read");
    }
  }
  if (binary.empty()) contents_.clear();
  for (const Json& buffer : list("buffers")) {
    const std::string uri = text_in(buffer, "uri");
    if (uri.empty()) {
      buffers_.push_back(buffers_.empty() ? binary : std::string_view());
    } else if (const auto bytes = load(uri)) {
      buffers_.push_back(*bytes);
    } else {
      fail("the buffer " + in_quotes(uri) + " is missing");
    }
  }
}

std::string_view GltfFile::read(const std::filesystem::path& file) {
  const std::string& bytes = contents_.emplace_back(read_file(file));
  files_.push_back(file);
  bytes_ += bytes.size();
  return bytes;
}

std::optional<std::string_view> GltfFile::load(const std::string& uri) {
  constexpr std::string_view kBase64 = ";base64,";
  if (uri.starts_with("data:")) {
    const std::size_t at = uri.find(kBase64);
    if (at == std::string::npos) return std::nullopt;
    return contents_.emplace_back(decode_base64(std::string_view(uri).substr(at + kBase64.size())));
  }
  const auto file = find_file(folder_, decode_uri(uri), name_ + ": ", warnings_);
  if (!file) return std::nullopt;
  return read(*file);
}

void GltfFile::add_warning(const std::string& warning) {
  if (std::ranges::find(warnings_, warning) == warnings_.end()) warnings_.push_back(warning);
}

void GltfFile::fail_extension(const std::string& extension) const {
  fail("found the extension " + in_quotes(extension) + ", which is not read; expected " +
       (is_in(kCompressions, extension)
            ? "a file without compression: exported with Compression off, or as "
              "`npx @gltf-transform/cli copy in.glb out.glb` writes it"
            : "an export without it"));
}

void GltfFile::fail(const std::string& what) const { throw InputError(name_ + ": " + what); }

const Json& GltfFile::at(const Json& list, int index, const char* what) const {
  const std::size_t size = list.is_array() ? list.size() : 0;
  if (index >= 0 && static_cast<std::size_t>(index) < size) {
    return list[static_cast<std::size_t>(index)];
  }
  fail(std::string(what) + " " + std::to_string(index) + ", but the file has " +
       std::to_string(size));
}

std::string_view GltfFile::picture_bytes(int number) {
  const Json& image = at(list("images"), number, "image");
  const std::string place = "image " + std::to_string(number);
  if (!member(image, "bufferView").is_null()) {
    return stored(index_in(image, "bufferView"), place + ": ");
  }
  const std::string uri = text_in(image, "uri");
  const auto bytes = uri.empty() ? std::nullopt : load(uri);
  if (!bytes && !uri.empty()) fail("the texture " + in_quotes(uri) + " is missing");
  if (!bytes || bytes->empty()) fail(place + " has no picture");
  return *bytes;
}

std::size_t GltfFile::count(int accessor) const {
  return size_in(this->accessor(accessor), "count");
}

/// A component type, with the code that stands for 1 in normalized accessors.
struct GltfFile::Component {
  int code;
  NumberType type;
  double one;
};

std::string_view GltfFile::stored(int buffer_view, const std::string& place) const {
  if (buffer_view < 0) fail(place + "found no buffer view, expected its number");
  const Json& view = at(list("bufferViews"), buffer_view, "buffer view");
  const int buffer = index_in(view, "buffer");
  if (buffer < 0 || static_cast<std::size_t>(buffer) >= buffers_.size()) {
    // The data may be compressed; then the extension's message is more helpful.
    for (const std::string& name : texts_in(json_, "extensionsUsed")) {
      if (is_in(kCompressions, name)) fail_extension(name);
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

std::vector<double> GltfFile::stored_numbers(const Json& part, const Component& component,
                                             std::size_t width, std::size_t count,
                                             const std::string& place) const {
  const int number = index_in(part, "bufferView");
  std::string_view bytes = stored(number, place);
  const Json& view = list("bufferViews").at(static_cast<std::size_t>(number));
  const NumberType type = component.type;
  const std::size_t size = width * bytes_of(type), offset = size_in(part, "byteOffset"),
                    stride = std::max(size_in(view, "byteStride"), size);
  bytes.remove_prefix(std::min(offset, bytes.size()));
  const bool is_within =
      count > 0 && size <= bytes.size() && count - 1 <= (bytes.size() - size) / stride;
  if (!is_within) fail(place + "beyond its buffer, which ends too soon");
  std::vector<double> numbers;
  numbers.reserve(count * width);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < width; ++k) {
      numbers.push_back(number_at(bytes.data() + i * stride + k * bytes_of(type), type));
    }
  }
  return numbers;
}

const GltfFile::Component& GltfFile::component_of(const Json& part,
                                                  const std::string& place) const {
  static constexpr Component kComponents[] = {
      {5120, NumberType::kInt8, 127.0},          {5121, NumberType::kUint8, 255.0},
      {5122, NumberType::kInt16, 32767.0},       {5123, NumberType::kUint16, 65535.0},
      {5125, NumberType::kUint32, 4294967295.0}, {5126, NumberType::kFloat, 1.0}};
  const auto* const found =
      std::ranges::find(kComponents, index_in(part, "componentType"), &Component::code);
  if (found == std::end(kComponents)) fail(place + "of an unknown type");
  return *found;
}

std::vector<double> GltfFile::elements(int accessor, std::size_t wanted, const char* what,
                                       bool are_indices) const {
  static const std::map<std::string, std::size_t> kTypes = {
      {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT2", 4}, {"MAT3", 9}, {"MAT4", 16}};
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
  } else {  // they are 0, apart from sparse ones
    constexpr std::size_t kMost = 1'000'000;
    if (count > kMost + bytes_) fail(place + "too many elements without a buffer");
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

std::vector<double> GltfFile::optional_numbers(int accessor, int width, const char* what,
                                               std::size_t vertices) {
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

std::vector<double> GltfFile::numbers(int accessor, int width, const char* what) const {
  return elements(accessor, static_cast<std::size_t>(width), what, false);
}

std::vector<std::uint32_t> GltfFile::indices(int accessor) const {
  const std::vector<double> all = elements(accessor, 1, "indices", true);
  return {all.begin(), all.end()};
}

glm::dmat4 local_matrix(const Json& node) {
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

}  // namespace raygate
