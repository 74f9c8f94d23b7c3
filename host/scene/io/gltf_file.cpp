// GltfFile: parsing and checks. Texture decodes the images.
#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#include "host/scene/io/gltf_file.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <optional>
#include <utility>

#include "host/base/file_bytes.h"
#include "host/scene/io/find_file.h"
#include "host/scene/io/gltf_mending.h"
#include "host/scene/io/tokens.h"

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

/// State of the callbacks that read buffers and images.
struct Reading {
  std::string folder, place;
  std::vector<std::filesystem::path>* files;
  std::size_t* bytes;
  std::vector<std::string>* warnings;

  /// Returns the file for a path, which tinygltf has composed of the folder and a name.
  [[nodiscard]] std::optional<std::filesystem::path> find(
      const std::string& path, std::vector<std::string>& found_warnings) const {
    const std::string prefix = folder.empty() ? "" : folder + "/";
    if (!path.starts_with(prefix)) return find_exact_file("", path);
    return find_file(folder, path.substr(prefix.size()), place, found_warnings);
  }
};

tinygltf::FsCallbacks callbacks(Reading& reading) {
  tinygltf::FsCallbacks calls{};
  calls.FileExists = [](const std::string& path, void* user) {
    std::vector<std::string> ignored;
    return static_cast<const Reading*>(user)->find(path, ignored).has_value();
  };
  // Paths are not expanded: tinygltf's default passes them to a shell.
  calls.ExpandFilePath = [](const std::string& path, void*) { return path; };
  calls.ReadWholeFile = [](std::vector<unsigned char>* out, std::string* error,
                           const std::string& path, void* user) {
    const auto& read = *static_cast<Reading*>(user);
    try {
      const std::filesystem::path file = read.find(path, *read.warnings).value_or(path);
      const std::string bytes = read_file(file);
      out->assign(bytes.begin(), bytes.end());
      read.files->emplace_back(file);
      *read.bytes += bytes.size();
      return true;
    } catch (const InputError& reason) {
      if (error != nullptr) *error += reason.what();
      return false;
    }
  };
  calls.WriteWholeFile = [](std::string*, const std::string&, const std::vector<unsigned char>&,
                            void*) { return false; };
  calls.user_data = &reading;
  return calls;
}

/// Keeps an image's file undecoded. An image in a buffer view stays there, as tinygltf does not
/// check the view.
bool keep_picture(tinygltf::Image* image, int, std::string*, std::string*, int, int,
                  const unsigned char* bytes, int size, void*) {
  if (image->bufferView < 0) image->image.assign(bytes, bytes + size);
  return true;
}

constexpr std::size_t kJsonLength = 12, kJson = 20;  // offsets in a GLB file

/// Returns a GLB file with other JSON in place of the first `old_size` bytes of its own.
std::string glb_with(std::string_view glb, std::size_t old_size, std::string json) {
  json.resize((json.size() + 3) / 4 * 4, ' ');
  std::string result(glb.substr(0, kJson));
  result.append(json).append(glb.substr(kJson + old_size));
  const std::uint32_t size[] = {static_cast<std::uint32_t>(result.size())},
                      json_size[] = {static_cast<std::uint32_t>(json.size())};
  std::memcpy(result.data() + kJsonLength - sizeof size, size, sizeof size);
  std::memcpy(result.data() + kJsonLength, json_size, sizeof json_size);
  return result;
}

/// Returns whether JSON is nested so deeply that tinygltf's recursion could exhaust the stack.
bool is_deep(std::string_view json) {
  constexpr int kMost = 64;
  int depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (in_string && c == '\\') {
      ++i;
    } else if (c == '"') {
      in_string = !in_string;
    } else if (!in_string && (c == '{' || c == '[')) {
      if (++depth > kMost) return true;
    } else if (!in_string && (c == '}' || c == ']')) {
      --depth;
    }
  }
  return false;
}

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

}  // namespace

GltfFile::GltfFile(const std::filesystem::path& file) : name_(file.string()), files_{file} {
  const std::string bytes = read_file(file);
  bytes_ = bytes.size();
  const bool is_binary = bytes.starts_with("glTF");
  if (bytes_ > std::numeric_limits<unsigned>::max()) fail("more than 4 GB, expected less");
  std::string_view json = bytes;
  if (is_binary) {
    if (bytes_ < kJson) fail("a GLB file that ends too soon");
    json = json.substr(kJson, number_at<std::uint32_t>(bytes.data() + kJsonLength));
  }
  if (is_deep(json)) fail("JSON of more than 64 levels, expected fewer");
  const std::string folder = file.parent_path().string();
  std::string error;
  const auto load = [&](const std::string& from) {
    model_ = {};
    files_ = {file};
    bytes_ = bytes.size();
    warnings_.clear();
    error.clear();
    Reading reading{folder, name_ + ": ", &files_, &bytes_, &warnings_};
    tinygltf::TinyGLTF loader;
    loader.SetFsCallbacks(callbacks(reading));
    loader.SetImageLoader(keep_picture, nullptr);
    std::string ignored;
    const auto size = static_cast<unsigned>(from.size());
    try {
      return is_binary
                 ? loader.LoadBinaryFromMemory(&model_, &error, &ignored,
                                               reinterpret_cast<const unsigned char*>(from.data()),
                                               size, folder)
                 : loader.LoadASCIIFromString(&model_, &error, &ignored, from.data(), size, folder);
    } catch (const std::exception& thrown) {
      error = thrown.what();
      return false;
    }
  };
  bool is_read = load(bytes);
  if (!is_read) {
    std::vector<std::string> mended;
    std::string text = mend_gltf(json, mended);
    if (is_binary) text = glb_with(bytes, json.size(), text);
    const std::string first_error = std::exchange(error, "");
    is_read = load(text);
    if (!is_read) error = first_error;
    for (const std::string& what : mended) warn_once(what, warnings_);
  }
  if (!is_read) {
    // The file may be compressed; then the extension's message is more helpful.
    for (const std::string_view extension : kCompressions) {
      if (json.find(extension) != std::string_view::npos) fail_extension(std::string(extension));
    }
    fail("not a glTF 2.0 file that can be read: " + first_line(error));
  }
  if (!model_.asset.version.starts_with("2.")) {
    fail("glTF version " + in_quotes(model_.asset.version) + ", expected 2.0");
  }
  const auto is_in = [](const auto& list, const std::string& extension) {
    return std::ranges::find(list, extension) != std::end(list);
  };
  for (const std::string& extension : model_.extensionsRequired) {
    if (!is_in(kRead, extension) && !is_in(kDispensable, extension)) fail_extension(extension);
  }
  for (const std::string& extension : model_.extensionsUsed) {
    if (is_in(kRead, extension)) continue;
    warn_once("the extension " + in_quotes(extension) + " is not read", warnings_);
  }
}

void GltfFile::fail_extension(const std::string& extension) const {
  const bool is_compressed = std::ranges::find(kCompressions, extension) != std::end(kCompressions);
  fail("found the extension " + in_quotes(extension) + ", which is not read; expected " +
       (is_compressed ? "a file without compression: exported with Compression off, or as "
                        "`npx @gltf-transform/cli copy in.glb out.glb` writes it"
                      : "an export without it"));
}

void GltfFile::warn_once(const std::string& what, std::vector<std::string>& warnings) const {
  warn_once(InputError(name_ + ": " + what), "", warnings);
}

void GltfFile::warn_once(const InputError& error, const char* instead,
                         std::vector<std::string>& warnings) {
  const std::string warning = error.what() + std::string(*instead == 0 ? "" : ", ") + instead;
  if (std::ranges::find(warnings, warning) == warnings.end()) warnings.push_back(warning);
}

void GltfFile::fail(const std::string& what) const {
  std::string line = what;
  for (char& c : line) {
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  }
  throw InputError(name_ + ": " + line);
}

void GltfFile::fail_index(const char* what, int index, std::size_t count) const {
  fail(std::string(what) + " " + std::to_string(index) + ", but the file has " +
       std::to_string(count));
}

std::string GltfFile::picture_bytes(int number) const {
  constexpr std::string_view kBase64 = ";base64,";
  const tinygltf::Image& image = at(model_.images, number, "image");
  if (image.bufferView >= 0) {
    return std::string(stored(image.bufferView, "image " + std::to_string(number) + ": "));
  }
  const std::size_t at = image.uri.find(kBase64);
  if (image.image.empty() && image.uri.starts_with("data:") && at != std::string::npos) {
    return tinygltf::base64_decode(image.uri.substr(at + kBase64.size()));
  }
  return {image.image.begin(), image.image.end()};
}

std::size_t GltfFile::count(int accessor) const {
  return at(model_.accessors, accessor, "accessor").count;
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
  bool normalized;
  std::vector<char> own;  // the elements, if they are sparse or have no buffer

  [[nodiscard]] std::size_t size() const {
    return bytes_of(component->type) * static_cast<std::size_t>(components);
  }
};

std::string_view GltfFile::stored(int buffer_view, const std::string& place) const {
  if (buffer_view < 0) fail(place + "found no buffer view, expected its number");
  const tinygltf::BufferView& view = at(model_.bufferViews, buffer_view, "buffer view");
  const std::vector<unsigned char>& data = at(model_.buffers, view.buffer, "buffer").data;
  if (view.byteOffset > data.size() || view.byteLength > data.size() - view.byteOffset) {
    fail(place + "beyond its buffer, which ends too soon");
  }
  return {reinterpret_cast<const char*>(data.data()) + view.byteOffset, view.byteLength};
}

void GltfFile::find_stored(int buffer_view, std::size_t offset, const std::string& number,
                           Elements& elements) const {
  const std::string_view bytes = stored(buffer_view, number);
  const std::size_t element = elements.size(),
                    stride = at(model_.bufferViews, buffer_view, "buffer view").byteStride;
  elements.stride = stride == 0 ? element : stride;
  const bool is_within = offset <= bytes.size() && elements.count > 0 &&
                         element <= bytes.size() - offset &&
                         elements.count - 1 <= (bytes.size() - offset - element) / elements.stride;
  if (!is_within) fail(number + "beyond its buffer, which ends too soon");
  elements.first = bytes.data() + offset;
}

GltfFile::Elements GltfFile::elements(int accessor, const char* what) const {
  static constexpr Component kComponents[] = {
      {TINYGLTF_COMPONENT_TYPE_BYTE, NumberType::kInt8, 127.0},
      {TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, NumberType::kUint8, 255.0},
      {TINYGLTF_COMPONENT_TYPE_SHORT, NumberType::kInt16, 32767.0},
      {TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, NumberType::kUint16, 65535.0},
      {TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, NumberType::kUint32, 4294967295.0},
      {TINYGLTF_COMPONENT_TYPE_FLOAT, NumberType::kFloat, 1.0}};
  const std::string number = "accessor " + std::to_string(accessor) + " (" + what + "): ";
  const tinygltf::Accessor& a = at(model_.accessors, accessor, "accessor");
  const auto typed = [&](int component_type, int components, std::size_t count) {
    const auto* const component = std::ranges::find(kComponents, component_type, &Component::code);
    if (component == std::end(kComponents) || components <= 0) fail(number + "of an unknown type");
    return Elements{nullptr, 0, count, component, components, a.normalized, {}};
  };
  Elements result =
      typed(a.componentType, tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(a.type)),
            a.count);
  if (a.bufferView >= 0) find_stored(a.bufferView, a.byteOffset, number, result);
  if (a.bufferView >= 0 && !a.sparse.isSparse) return result;
  // Elements without a buffer are 0; then the sparse ones are replaced.
  constexpr std::size_t kMost = 1'000'000;
  if (a.count > kMost + bytes_) fail(number + "too many elements without a buffer");
  const std::size_t size = result.size();
  std::vector<char> own(size * a.count);
  for (std::size_t i = 0; result.first != nullptr && i < a.count; ++i) {
    std::copy_n(result.first + i * result.stride, size, own.data() + i * size);
  }
  if (a.sparse.isSparse && a.sparse.count > 0) {
    const auto count = static_cast<std::size_t>(a.sparse.count);
    Elements places = typed(a.sparse.indices.componentType, 1, count);
    Elements values = typed(a.componentType, result.components, count);
    find_stored(a.sparse.indices.bufferView, static_cast<std::size_t>(a.sparse.indices.byteOffset),
                number, places);
    find_stored(a.sparse.values.bufferView, static_cast<std::size_t>(a.sparse.values.byteOffset),
                number, values);
    for (std::size_t i = 0; i < count; ++i) {
      const double place = number_at(places.first + i * places.stride, places.component->type);
      if (!(place >= 0.0 && place < static_cast<double>(a.count))) {
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
                                               std::size_t vertices,
                                               std::vector<std::string>& warnings) const {
  if (accessor < 0) return {};
  try {
    if (count(accessor) == vertices) return numbers(accessor, width, what);
    warn_once(std::string(what) + ": found " + std::to_string(count(accessor)) + ", expected " +
                  std::to_string(vertices) + ", left out",
              warnings);
  } catch (const InputError& error) {
    warn_once(error, "left out", warnings);
  }
  return {};
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
  std::vector<double> numbers;
  numbers.reserve(from.count * static_cast<std::size_t>(width));
  for (std::size_t i = 0; i < from.count; ++i) {
    const char* at = from.first + i * from.stride;
    for (int k = 0; k < width; ++k, at += bytes_of(type)) {
      double number = number_at(at, type);
      if (from.normalized) number = std::max(number / one, -1.0);
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

glm::dmat4 local_matrix(const tinygltf::Node& node) {
  glm::dmat4 matrix(1.0);
  if (node.matrix.size() == 16) {
    for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = node.matrix[static_cast<std::size_t>(i)];
    return matrix;
  }
  if (const auto& t = node.translation; t.size() == 3) {
    matrix[3] = glm::dvec4(t[0], t[1], t[2], 1.0);
  }
  if (const auto& r = node.rotation; r.size() == 4) {
    const glm::dquat turn(r[3], r[0], r[1], r[2]);
    const double length = glm::length(turn);
    if (length > 0.0) matrix = matrix * glm::mat4_cast(turn / length);
  }
  if (const auto& s = node.scale; s.size() == 3) {
    for (int axis = 0; axis < 3; ++axis) matrix[axis] *= s[static_cast<std::size_t>(axis)];
  }
  return matrix;
}

std::vector<glm::dmat4> GltfFile::instance_transforms(const tinygltf::Node& node) const {
  const auto extension = node.extensions.find("EXT_mesh_gpu_instancing");
  if (extension == node.extensions.end() || !extension->second.Has("attributes")) {
    return {glm::dmat4(1.0)};
  }
  const tinygltf::Value& attributes = extension->second.Get("attributes");
  std::vector<tinygltf::Node> nodes;
  const auto read = [&](const char* name, std::size_t width,
                        std::vector<double>(tinygltf::Node::*to)) {
    if (!attributes.Has(name) || !attributes.Get(name).IsInt()) return;
    const std::vector<double> all =
        vectors(attributes.Get(name).GetNumberAsInt(), static_cast<int>(width), name);
    const std::size_t count = all.size() / width;
    if (!nodes.empty() && count != nodes.size()) {
      fail("instances: not as many of each attribute");
    }
    nodes.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      const double* const first = all.data() + width * i;
      (nodes[i].*to).assign(first, first + width);
    }
  };
  read("TRANSLATION", 3, &tinygltf::Node::translation);
  read("ROTATION", 4, &tinygltf::Node::rotation);
  read("SCALE", 3, &tinygltf::Node::scale);
  std::vector<glm::dmat4> all;
  all.reserve(nodes.size());
  for (const tinygltf::Node& one : nodes) all.push_back(local_matrix(one));
  return all;
}

}  // namespace raygate
