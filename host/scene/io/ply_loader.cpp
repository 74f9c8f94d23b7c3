#include <algorithm>
#include <cmath>
#include <cstdio>
#include <initializer_list>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/base/input.h"
#include "host/base/input_error.h"
#include "host/exact/exact.h"
#include "host/scene/io/mesh_builder.h"
#include "host/scene/io/scene_loader.h"
#include "host/scene/io/text.h"

namespace raygate {
namespace {

/// Both names that PLY has for each NumberType.
constexpr std::string_view kTypeNames[][2] = {
    {"char", "int8"}, {"uchar", "uint8"}, {"short", "int16"},   {"ushort", "uint16"},
    {"int", "int32"}, {"uint", "uint32"}, {"float", "float32"}, {"double", "float64"}};

struct Property {
  std::string name;
  NumberType type = NumberType::kFloat;
  std::optional<NumberType> count_type;  // type of a list's length; none: not a list
  bool is_used = false;
  std::vector<double> values = {};  // of the last element read: one value, or a list
};

struct Element {
  std::string name;
  long long count = 0;
  std::vector<Property> properties = {};

  /// Returns and marks the named properties; none if one is missing or not as `are_lists` says.
  std::vector<Property*> use(std::initializer_list<std::string_view> names, bool are_lists) {
    std::vector<Property*> used;
    for (const std::string_view name : names) {
      const auto found = std::ranges::find(properties, name, &Property::name);
      if (found == properties.end() || found->count_type.has_value() != are_lists) return {};
      used.push_back(&*found);
    }
    for (Property* const property : used) property->is_used = true;
    return used;
  }
};

glm::dvec3 vector_of(const std::vector<Property*>& attribute) {
  glm::dvec3 vector(0.0);
  for (int k = 0; const Property* property : attribute) vector[k++] = property->values[0];
  return vector;
}

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
    for (Element& element : elements_) {
      if (element.name == "vertex" && !has_vertices) {
        read_vertices(element);
        has_vertices = true;
      } else if (element.name == "face" && has_vertices) {
        read_faces(element);
      } else if (!element.properties.empty()) {
        unread_.push_back("element " + in_quotes(element.name));
        for (long long i = 0; i < element.count; ++i) read_row(element);
      }
    }
    if (!unread_.empty()) {
      std::string all;
      for (const std::string& one : unread_) all.append(all.empty() ? "" : ", ").append(one);
      scene.warnings.push_back(name_ + ": not read: " + all);
    }
    mesh_.build_plain(options, scene);
    return scene;
  }

 private:
  // Header

  /// Sets words_ to the words of the next line and returns the first of them.
  std::string_view next_line() {
    words_ = Words(name_, "", ++lines_);
    const std::size_t length = text_.find(line_end_);
    if (length == text_.npos) words_.fail("the header has no end_header");
    words_ = Words(name_, text_.substr(0, length), lines_);
    text_.remove_prefix(length + 1);
    return words_.take();
  }

  void read_header(std::vector<std::string>& warnings) {
    // The first line determines the line ending: binary data after the header may resemble one.
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
        std::string_view file = words_.rest();  // may hold spaces
        while (file.ends_with('\r') || file.ends_with(' ')) file.remove_suffix(1);
        unread_.push_back("texture " + in_quotes(file));
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

  /// Reads one element: the values of all its properties.
  void read_row(Element& element) {
    row_line_ = words_.line();
    for (Property& property : element.properties) {
      const double count = property.count_type ? take_any(*property.count_type) : 1.0;
      if (!is_whole(count, 0xFFFF'FFFF)) {
        fail_row("a list's length: expected a whole number from 0 to 4294967295");
      }
      property.values.clear();
      const auto length = static_cast<std::uint32_t>(count);
      for (std::uint32_t k = 0; k < length; ++k) property.values.push_back(take_any(property.type));
    }
  }

  [[noreturn]] void fail_row(const std::string& what) const {
    throw InputError(name_, row_line_, what);
  }

  void note_unread(const Element& element) {
    for (const Property& property : element.properties) {
      if (property.is_used) continue;
      unread_.push_back(in_quotes(property.name) + " of " + element.name);
    }
  }

  void read_vertices(Element& element) {
    const auto position = element.use({"x", "y", "z"}, false),
               normal = element.use({"nx", "ny", "nz"}, false),
               color = element.use({"red", "green", "blue"}, false);
    if (position.empty()) words_.fail("vertices without x, y and z");
    has_normals_ = !normal.empty();
    note_unread(element);
    glm::dvec3 white(1.0);  // codes that stand for 1
    for (int k = 0; const Property* property : color) {
      if (property->type == NumberType::kUint8) white[k] = 255.0;
      if (property->type == NumberType::kUint16) white[k] = 65535.0;
      ++k;
    }
    for (long long i = 0; i < element.count; ++i) {
      read_row(element);
      const glm::dvec3 at = vector_of(position);
      if (!is_finite(at) || largest(at) > std::numeric_limits<float>::max()) {
        char found[64];
        std::snprintf(found, sizeof found, "%g %g %g", at.x, at.y, at.z);
        fail_row(std::string("a vertex: found ") + found +
                 ", expected numbers within the range of float");
      }
      mesh_.add_position(at);
      if (!color.empty()) mesh_.add_color(glm::vec3(vector_of(color) / white));
      if (has_normals_) mesh_.add_normal(vector_of(normal));
    }
  }

  void read_faces(Element& element) {
    auto indices = element.use({"vertex_indices"}, true);
    if (indices.empty()) indices = element.use({"vertex_index"}, true);
    if (indices.empty()) words_.fail("element face without a list vertex_indices");
    note_unread(element);
    std::vector<FaceCorner> corners;
    for (long long i = 0; i < element.count; ++i) {
      read_row(element);
      corners.clear();
      for (const double index : indices[0]->values) {
        if (!is_whole(index, 2147483646.0)) {
          fail_row("a vertex index: expected a whole number from 0 to 2147483646");
        }
        const auto at = static_cast<std::uint32_t>(index);
        corners.push_back({at, kNoIndex, has_normals_ ? at : kNoIndex});
      }
      mesh_.add_face(corners, row_line_);
    }
  }

  std::string name_;
  std::string_view text_;     // the unread part of the header or of binary data
  char line_end_ = '\n';      // of the header
  std::size_t lines_ = 0;     // number of the header's lines that were read
  Words words_;               // of the header's last line, or of all ASCII data
  std::size_t row_line_ = 0;  // of the element that was read last
  Format format_ = Format::kAscii;
  std::vector<Element> elements_;
  std::vector<std::string> unread_;  // properties and elements to warn about
  MeshBuilder mesh_;
  bool has_normals_ = false;
};

}  // namespace

Scene load_ply(const std::filesystem::path& file, const LoadOptions& options) {
  const std::string bytes = read_file(file);
  return PlyReader(file, bytes).read(options);
}

}  // namespace raygate
