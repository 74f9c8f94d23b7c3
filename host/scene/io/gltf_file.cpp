#include "host/scene/io/gltf_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <span>

#include "host/base/file_bytes.h"
#include "host/scene/io/find_file.h"
#include "host/scene/io/text.h"

namespace raygate {
namespace {

/// Extensions that are read. A file that uses another one gets a warning.
constexpr std::string_view kRead[] = {
    "EXT_mesh_gpu_instancing",    "KHR_lights_punctual",
    "KHR_materials_clearcoat",    "KHR_materials_emissive_strength",
    "KHR_materials_ior",          "KHR_materials_specular",
    "KHR_materials_transmission", "KHR_materials_unlit",
    "KHR_mesh_quantization",      "KHR_texture_transform"};

/// Extensions that are not read but may be required: without them, surfaces are only plainer.
constexpr std::string_view kDispensable[] = {"KHR_materials_sheen", "KHR_materials_variants",
                                             "KHR_materials_volume"};

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

/// Returns a transform of a translation, a rotation (a quaternion x, y, z, w) and a scale, each of
/// which may be empty.
glm::dmat4 matrix_of(std::span<const double> t, std::span<const double> r,
                     std::span<const double> s) {
  glm::dmat4 matrix(1.0);
  if (t.size() == 3) matrix[3] = glm::dvec4(t[0], t[1], t[2], 1.0);
  if (r.size() == 4) {
    const glm::dquat turn(r[3], r[0], r[1], r[2]);
    const double length = glm::length(turn);
    if (length > 0.0) matrix = matrix * glm::mat4_cast(turn / length);
  }
  if (s.size() == 3) {
    for (int axis = 0; axis < 3; ++axis) matrix[axis] *= s[static_cast<std::size_t>(axis)];
  }
  return matrix;
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

/// The location of an accessor's elements, which is within their buffer.
struct GltfFile::Elements {
  const char* first;
  std::size_t stride, count;
  const Component* component;
  int components;
  std::vector<char> own = {};  // the elements, if they are sparse or have no buffer

  [[nodiscard]] std::size_t size() const {
    return bytes_of(component->type) * static_cast<std::size_t>(components);
  }
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

void GltfFile::find_stored(const Json& part, const std::string& number, Elements& elements) const {
  const int buffer_view = index_in(part, "bufferView");
  const std::string_view bytes = stored(buffer_view, number);
  const std::size_t element = elements.size(), offset = size_in(part, "byteOffset"),
                    stride = size_in(list("bufferViews").at(static_cast<std::size_t>(buffer_view)),
                                     "byteStride");
  elements.stride = stride == 0 ? element : stride;
  const bool is_within = offset <= bytes.size() && elements.count > 0 &&
                         element <= bytes.size() - offset &&
                         elements.count - 1 <= (bytes.size() - offset - element) / elements.stride;
  if (!is_within) fail(number + "beyond its buffer, which ends too soon");
  elements.first = bytes.data() + offset;
}

GltfFile::Elements GltfFile::elements(int accessor, const char* what) const {
  static constexpr Component kComponents[] = {
      {5120, NumberType::kInt8, 127.0},          {5121, NumberType::kUint8, 255.0},
      {5122, NumberType::kInt16, 32767.0},       {5123, NumberType::kUint16, 65535.0},
      {5125, NumberType::kUint32, 4294967295.0}, {5126, NumberType::kFloat, 1.0}};
  static constexpr std::pair<std::string_view, int> kTypes[] = {
      {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT2", 4}, {"MAT3", 9}, {"MAT4", 16}};
  const std::string number = "accessor " + std::to_string(accessor) + " (" + what + "): ";
  const Json& a = this->accessor(accessor);
  const auto* const type =
      std::ranges::find(kTypes, text_in(a, "type"), &std::pair<std::string_view, int>::first);
  const auto typed = [&](const Json& part, int components, std::size_t count) {
    const auto* const component =
        std::ranges::find(kComponents, index_in(part, "componentType"), &Component::code);
    if (component == std::end(kComponents) || components == 0) fail(number + "of an unknown type");
    return Elements{nullptr, 0, count, component, components};
  };
  Elements result = typed(a, type == std::end(kTypes) ? 0 : type->second, count(accessor));
  const bool has_view = !member(a, "bufferView").is_null();
  const Json& sparse = member(a, "sparse");
  if (has_view) find_stored(a, number, result);
  if (has_view && !sparse.is_object()) return result;
  // Elements without a buffer are 0; then the sparse ones are replaced.
  constexpr std::size_t kMost = 1'000'000;
  if (result.count > kMost + bytes_) fail(number + "too many elements without a buffer");
  const std::size_t size = result.size();
  std::vector<char> own(size * result.count);
  for (std::size_t i = 0; result.first != nullptr && i < result.count; ++i) {
    std::copy_n(result.first + i * result.stride, size, own.data() + i * size);
  }
  if (sparse.is_object()) {
    const std::size_t count = size_in(sparse, "count");
    Elements places = typed(member(sparse, "indices"), 1, count);
    Elements values = typed(a, result.components, count);
    find_stored(member(sparse, "indices"), number, places);
    find_stored(member(sparse, "values"), number, values);
    for (std::size_t i = 0; i < count; ++i) {
      const double place = number_at(places.first + i * places.stride, places.component->type);
      if (!(place >= 0.0 && place < static_cast<double>(result.count))) {
        fail(number + "a sparse element beyond its end");
      }
      std::copy_n(values.first + i * values.stride, size,
                  own.data() + static_cast<std::size_t>(place) * size);
    }
  }
  result.own = std::move(own);
  result.first = result.own.data();
  result.stride = size;
  return result;
}

std::vector<double> GltfFile::vectors(int accessor, int width, const char* what) const {
  std::vector<double> all = numbers(accessor, width, what);
  if (!std::ranges::all_of(all, [](double number) { return std::isfinite(number); })) {
    fail("accessor " + std::to_string(accessor) + " (" + what + "): a number that is not finite");
  }
  return all;
}

std::vector<double> GltfFile::optional_vectors(int accessor, int width, const char* what,
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
  const Elements from = elements(accessor, what);
  const auto fail_here = [&](const char* found) {
    fail("accessor " + std::to_string(accessor) + " (" + what + "): " + found);
  };
  if (from.components < width) fail_here("too few components");
  if (from.component->type == NumberType::kUint32) {
    fail_here("numbers of a type that is not expected there");
  }
  const auto [ignored, type, one] = *from.component;
  const Json& normalized = member(this->accessor(accessor), "normalized");
  const bool is_normalized = normalized.is_boolean() && normalized.get<bool>();
  std::vector<double> numbers;
  numbers.reserve(from.count * static_cast<std::size_t>(width));
  for (std::size_t i = 0; i < from.count; ++i) {
    const char* at = from.first + i * from.stride;
    for (int k = 0; k < width; ++k, at += bytes_of(type)) {
      double number = number_at(at, type);
      if (is_normalized) number = std::max(number / one, -1.0);
      numbers.push_back(number);
    }
  }
  return numbers;
}

std::vector<std::uint32_t> GltfFile::indices(int accessor) const {
  const Elements from = elements(accessor, "indices");
  const NumberType type = from.component->type;
  if (type != NumberType::kUint8 && type != NumberType::kUint16 && type != NumberType::kUint32) {
    fail("accessor " + std::to_string(accessor) + " (indices): not of whole numbers");
  }
  std::vector<std::uint32_t> numbers;
  numbers.reserve(from.count);
  for (std::size_t i = 0; i < from.count; ++i) {
    numbers.push_back(static_cast<std::uint32_t>(number_at(from.first + i * from.stride, type)));
  }
  return numbers;
}

glm::dmat4 local_matrix(const Json& node) {
  const std::vector<double> numbers = numbers_in(node, "matrix");
  if (numbers.size() == 16) return glm::make_mat4(numbers.data());
  return matrix_of(numbers_in(node, "translation"), numbers_in(node, "rotation"),
                   numbers_in(node, "scale"));
}

std::vector<glm::dmat4> GltfFile::instance_transforms(const Json& node) const {
  const Json& attributes =
      member(raygate::extension(node, "EXT_mesh_gpu_instancing"), "attributes");
  if (!attributes.is_object()) return {glm::dmat4(1.0)};
  std::optional<std::size_t> count;
  const auto read = [&](const char* name, int width) {
    const int accessor = index_in(attributes, name);
    if (accessor < 0) return std::vector<double>();
    std::vector<double> all = vectors(accessor, width, name);
    const std::size_t found = all.size() / static_cast<std::size_t>(width);
    if (count.value_or(found) != found) fail("instances: not as many of each attribute");
    count = found;
    return all;
  };
  const std::vector<double> places = read("TRANSLATION", 3), turns = read("ROTATION", 4),
                            scales = read("SCALE", 3);
  const auto part = [](const std::vector<double>& all, std::size_t i, std::size_t width) {
    return std::span(all).subspan(all.empty() ? 0 : i * width, all.empty() ? 0 : width);
  };
  std::vector<glm::dmat4> transforms;
  for (std::size_t i = 0; i < count.value_or(0); ++i) {
    transforms.push_back(matrix_of(part(places, i, 3), part(turns, i, 4), part(scales, i, 3)));
  }
  return transforms;
}

}  // namespace raygate
