#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/base/file_bytes.h"
#include "host/base/input_error.h"
#include "host/scene/io/find_file.h"
#include "host/scene/io/mesh_builder.h"
#include "host/scene/io/scene_loader.h"
#include "host/scene/io/text.h"

namespace raygate {
namespace {

/// Both names of each NumberType.
constexpr std::string_view kTypeNames[][2] = {
    {"char", "int8"}, {"uchar", "uint8"}, {"short", "int16"},   {"ushort", "uint16"},
    {"int", "int32"}, {"uint", "uint32"}, {"float", "float32"}, {"double", "float64"}};

/// Attributes of vertices, with the names of their properties. There are three names for texture
/// coordinates, of which the first ones in this order are read.
enum Attribute { kPosition, kNormal, kColor, kTexcoord, kAttributes = kTexcoord + 3 };
constexpr std::array<std::string_view, 3> kAttributeNames[] = {
    {"x", "y", "z"}, {"nx", "ny", "nz"}, {"red", "green", "blue"},
    {"s", "t"},      {"u", "v"},         {"texture_u", "texture_v"}};

struct Property {
  std::string name;
  NumberType type = NumberType::kFloat;
  std::optional<NumberType> count_type;  // of a list
};

struct Element {
  std::string name;
  long long count = 0;
  std::vector<Property> properties;

  /// Returns the index of a property, which is a list or is none.
  [[nodiscard]] std::optional<std::size_t> find(std::string_view property, bool is_list) const {
    const auto found = std::ranges::find(properties, property, &Property::name);
    if (found == properties.end() || found->count_type.has_value() != is_list) return std::nullopt;
    return static_cast<std::size_t>(found - properties.begin());
  }
};

enum class Format { kAscii, kLittle, kBig };

bool is_whole(double number, double most) {
  return number >= 0.0 && number <= most && std::floor(number) == number;
}

class PlyReader {
 public:
  PlyReader(const std::filesystem::path& file, const std::string& bytes)
      : name_(file.string()), text_(bytes), words_(name_, ""), mesh_(name_) {}

  Scene read(const LoadOptions& options) {
    Scene scene;
    read_header(scene.warnings);
    // Messages about binary data name no line.
    words_ = format_ == Format::kAscii ? Words(name_, text_, lines_ + 1) : Words(name_, "");
    bool has_vertices = false;
    for (const Element& element : elements_) {
      if (element.name == "vertex" && !has_vertices) {
        read_vertices(element);
        has_vertices = true;
      } else if (element.name == "face" && has_vertices) {
        read_faces(element);
      } else if (!element.properties.empty()) {
        unread_.push_back("element " + in_quotes(element.name));
        for (long long i = 0; i < element.count; ++i) {
          for (const Property& property : element.properties) skip(property);
        }
      }
    }
    if (!texture_.empty() && !has_texcoords_) {
      unread_.push_back("texture " + in_quotes(texture_) + " without texture coordinates");
    }
    if (!unread_.empty()) {
      std::string all;
      for (const std::string& one : unread_) all.append(all.empty() ? "" : ", ").append(one);
      scene.warnings.push_back(name_ + ": not read: " + all);
    }
    mesh_.build_plain(options, scene);
    if (has_texcoords_) add_texture(options, scene);
    return scene;
  }

 private:
  // Header

  /// Sets words_ to those of the next line, and returns its first word.
  std::string_view next_line() {
    words_ = Words(name_, "", ++lines_);
    const std::size_t length = text_.find(line_end_);
    if (length == text_.npos) words_.fail("the header has no end_header");
    words_ = Words(name_, text_.substr(0, length), lines_);
    text_.remove_prefix(length + 1);
    return words_.take();
  }

  void read_header(std::vector<std::string>& warnings) {
    // The first line determines the line ending, as binary data after the header may resemble one.
    if (text_.starts_with("ply\r") && !text_.starts_with("ply\r\n")) line_end_ = '\r';
    if (next_line() != "ply") words_.fail("not a PLY file: its first line is not \"ply\"");
    bool has_format = false;
    for (std::string_view word = next_line(); word != "end_header"; word = next_line()) {
      if (word == "format") {
        read_format();
        has_format = true;
      } else if (word == "element") {
        read_element();
      } else if (word == "property") {
        if (elements_.empty()) words_.fail("a property before the first element");
        elements_.back().properties.push_back(read_property());
      } else if (word == "comment") {
        if (words_.take() != "TextureFile") continue;
        std::string_view file = words_.rest();
        while (file.ends_with('\r') || file.ends_with(' ')) file.remove_suffix(1);
        if (texture_.empty()) {
          texture_ = file;
        } else {
          unread_.push_back("texture " + in_quotes(file));
        }
      } else if (word != "obj_info" && !word.empty()) {
        warnings.push_back(words_.place() + in_quotes(word) +
                           " is no word of a PLY header, ignored");
      }
    }
    if (!has_format) words_.fail("the header names no format");
  }

  void read_format() {
    constexpr std::string_view kFormats[] = {"ascii", "binary_little_endian", "binary_big_endian"};
    const std::string_view format = words_.take();
    const auto* const found = std::ranges::find(kFormats, format);
    if (found == std::end(kFormats)) {
      words_.fail("format: found " + in_quotes(format) +
                  ", expected ascii, binary_little_endian or binary_big_endian");
    }
    format_ = static_cast<Format>(found - std::begin(kFormats));
  }

  void read_element() {
    Element& element = elements_.emplace_back();
    element.name = words_.take();
    const double count = words_.any_number();
    if (!is_whole(count, 0x1p53)) words_.fail("element: expected its name and how many there are");
    element.count = static_cast<long long>(count);
  }

  NumberType read_type() {
    const std::string_view word = words_.take();
    const auto* const found = std::ranges::find_if(
        kTypeNames, [&](const auto& names) { return word == names[0] || word == names[1]; });
    if (found == std::end(kTypeNames)) {
      words_.fail("property: found " + in_quotes(word) +
                  ", expected a type as int, uchar or float");
    }
    return static_cast<NumberType>(found - std::begin(kTypeNames));
  }

  Property read_property() {
    Property property;
    if (words_.take_if("list")) {
      property.count_type = read_type();
      if (*property.count_type >= NumberType::kFloat) {
        words_.fail("property: a list's length of a type that is not whole");
      }
    }
    property.type = read_type();
    property.name = words_.take();
    if (property.name.empty()) words_.fail("property: without a name");
    return property;
  }

  // Data

  /// Takes a finite number within the range of float.
  double take(NumberType type, std::string_view what) {
    if (format_ == Format::kAscii) return words_.number(what);
    const double number = take_any(type);
    if (!(std::abs(number) <= std::numeric_limits<float>::max())) {
      words_.fail(std::string(what) + ": not a finite number");
    }
    return number;
  }

  /// Takes any number; NaN for a word that is no number.
  double take_any(NumberType type) {
    const bool is_ascii = format_ == Format::kAscii;
    if (is_ascii ? words_.at_end() : text_.size() < bytes_of(type)) {
      words_.fail("the file ends too soon");
    }
    if (is_ascii) return words_.any_number();
    const char* const bytes = text_.data();
    text_.remove_prefix(bytes_of(type));
    return number_at(bytes, type, format_ == Format::kBig);
  }

  /// Takes the length of a list. If the file is shorter, taking its elements fails.
  long long take_count(const Property& list) {
    const double count = take(*list.count_type, "a list's length");
    if (!is_whole(count, 0xFFFF'FFFF)) {
      words_.fail("a list's length: expected a whole number from 0 to 4294967295");
    }
    return static_cast<long long>(count);
  }

  void skip(const Property& property) {
    const long long count = property.count_type ? take_count(property) : 1;
    for (long long i = 0; i < count; ++i) (void)take_any(property.type);
  }

  void read_vertices(const Element& element) {
    struct Slot {
      int attribute = -1, component = 0;
    };
    std::vector<Slot> slots(element.properties.size());
    const auto find_all = [&](int attribute) {
      std::vector<std::size_t> found;
      for (const std::string_view name : kAttributeNames[attribute]) {
        if (name.empty()) continue;
        const auto property = element.find(name, false);
        if (!property) return false;
        found.push_back(*property);
      }
      for (int k = 0; const std::size_t property : found) slots[property] = {attribute, k++};
      return true;
    };
    if (!find_all(kPosition)) words_.fail("vertices without x, y and z");
    has_normals_ = find_all(kNormal);
    const bool has_colors = find_all(kColor);
    int texcoord = kTexcoord;
    while (texcoord < kAttributes && (texture_.empty() || !find_all(texcoord))) ++texcoord;
    has_texcoords_ = texcoord < kAttributes;
    for (std::size_t p = 0; p < slots.size(); ++p) {
      if (slots[p].attribute < 0) note_unread(element, p);
    }
    for (long long i = 0; i < element.count; ++i) {
      glm::dvec3 values[kAttributes]{};
      for (std::size_t p = 0; p < slots.size(); ++p) {
        const Property& property = element.properties[p];
        const auto [attribute, component] = slots[p];
        if (attribute < 0) {
          skip(property);
        } else if (attribute == kPosition) {
          values[attribute][component] = take(property.type, property.name);
        } else {
          const double one = attribute == kColor ? largest_code(property.type) : 1.0;
          values[attribute][component] = take_any(property.type) / one;
        }
      }
      mesh_.add_position(values[kPosition]);
      if (has_colors) mesh_.add_color(glm::vec3(values[kColor]));
      if (has_normals_) mesh_.add_normal(values[kNormal]);
      if (has_texcoords_) mesh_.add_texcoord(glm::vec2(values[texcoord]));
    }
  }

  /// Returns the code of 1 in a colour of that type.
  [[nodiscard]] static double largest_code(NumberType type) {
    return type == NumberType::kUint8 ? 255.0 : type == NumberType::kUint16 ? 65535.0 : 1.0;
  }

  void note_unread(const Element& element, std::size_t property) {
    unread_.push_back(in_quotes(element.properties[property].name) + " of " + element.name);
  }

  [[nodiscard]] std::uint32_t take_index(NumberType type) {
    const double index = take(type, "a vertex index");
    if (!is_whole(index, 2147483646.0)) {
      words_.fail("a vertex index: expected a whole number from 0 to 2147483646");
    }
    return static_cast<std::uint32_t>(index);
  }

  void read_faces(const Element& element) {
    auto indices = element.find("vertex_indices", true);
    if (!indices) indices = element.find("vertex_index", true);
    if (!indices) words_.fail("element face without a list vertex_indices");
    // The texture coordinates of corners, in pairs, replace those of vertices.
    std::optional<std::size_t> texcoords;
    if (!texture_.empty()) texcoords = element.find("texcoord", true);
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
      if (p != indices && p != texcoords) note_unread(element, p);
    }
    std::vector<FaceCorner> corners;
    std::vector<double> pairs;
    for (long long i = 0; i < element.count; ++i) {
      const std::size_t face_line = words_.line();
      for (std::size_t p = 0; p < element.properties.size(); ++p) {
        const Property& property = element.properties[p];
        if (p == indices) {
          corners.clear();
          for (long long count = take_count(property); count > 0; --count) {
            const std::uint32_t at = take_index(property.type);
            corners.push_back({at, has_texcoords_ ? at : kNoIndex, has_normals_ ? at : kNoIndex});
          }
        } else if (p == texcoords) {
          pairs.clear();
          for (long long count = take_count(property); count > 0; --count) {
            pairs.push_back(take_any(property.type));
          }
        } else {
          skip(property);
        }
      }
      for (std::size_t k = 0; texcoords && k < corners.size(); ++k) {
        corners[k].texcoord = kNoIndex;
        if (2 * k + 1 >= pairs.size()) continue;
        corners[k].texcoord = static_cast<std::uint32_t>(mesh_.counts().texcoords);
        mesh_.add_texcoord({pairs[2 * k], pairs[2 * k + 1]});
      }
      mesh_.add_face(corners, face_line);
    }
    has_texcoords_ = has_texcoords_ || texcoords;
  }

  /// Sets the texture of the material.
  void add_texture(const LoadOptions& options, Scene& scene) {
    const std::filesystem::path folder = std::filesystem::path(name_).parent_path();
    Material& material = scene.materials[0];
    material.diffuse = glm::vec3(1.0f);
    material.has_vertex_colors = false;  // scanners duplicate the image's colours at the vertices
    material.diffuse_map.file = find_file(folder, texture_, name_ + ": ", scene.warnings)
                                    .value_or(folder / texture_)
                                    .string();
    if (options.textures) load_textures(scene);
  }

  std::string name_;
  std::string_view text_;  // the unread part of the header or of binary data
  char line_end_ = '\n';   // of the header
  std::size_t lines_ = 0;  // number of the header's lines that were read
  Words words_;            // of the header's last line, or of all ASCII data
  Format format_ = Format::kAscii;
  std::vector<Element> elements_;
  std::vector<std::string> unread_;  // properties and elements to warn about
  MeshBuilder mesh_;
  std::string_view texture_;  // the file of the header's first "comment TextureFile"
  bool has_normals_ = false, has_texcoords_ = false;
};

}  // namespace

Scene load_ply(const std::filesystem::path& file, const LoadOptions& options) {
  const std::string bytes = read_file(file);
  return PlyReader(file, bytes).read(options);
}

}  // namespace raygate
