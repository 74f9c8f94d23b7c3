#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>
#include <vector>

#include "host/base/file_bytes.h"
#include "host/base/input_error.h"
#include "host/scene/io/mesh_builder.h"
#include "host/scene/io/scene_loader.h"
#include "host/scene/io/token_reader.h"
#include "host/scene/io/tokens.h"

namespace raygate {
namespace {

enum class Type { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat, kDouble };

struct TypeName {
  std::string_view name, other;
  Type type;
  std::size_t size;
};
constexpr TypeName kTypes[] = {
    {"char", "int8", Type::kInt8, 1},      {"uchar", "uint8", Type::kUint8, 1},
    {"short", "int16", Type::kInt16, 2},   {"ushort", "uint16", Type::kUint16, 2},
    {"int", "int32", Type::kInt32, 4},     {"uint", "uint32", Type::kUint32, 4},
    {"float", "float32", Type::kFloat, 4}, {"double", "float64", Type::kDouble, 8}};

struct Property {
  std::string name;
  Type type = Type::kFloat;
  std::optional<Type> count_type;  // of a list
};

struct Element {
  std::string name;
  long long count = 0;
  std::vector<Property> properties;

  [[nodiscard]] std::optional<std::size_t> find(std::string_view property) const {
    const auto found = std::ranges::find(properties, property, &Property::name);
    if (found == properties.end()) return std::nullopt;
    return static_cast<std::size_t>(found - properties.begin());
  }
};

enum class Format { kAscii, kLittle, kBig };

struct Header {
  Format format = Format::kAscii;
  std::vector<Element> elements;
  std::size_t bytes = 0, lines = 0;  // that it takes
  std::vector<std::string> warnings;
};

/// A line of the header, without its end.
class HeaderReader {
 public:
  HeaderReader(std::string name, std::string_view text) : name_(std::move(name)), text_(text) {}

  Header read() {
    Header header;
    if (next() != "ply") fail("not a PLY file: its first line is not \"ply\"");
    bool has_format = false;
    for (std::string_view line = next(); line != "end_header"; line = next()) {
      const std::string_view keyword = take_token(line);
      if (keyword == "format") {
        header.format = read_format(line);
        has_format = true;
      } else if (keyword == "element") {
        header.elements.push_back(read_element(line));
      } else if (keyword == "property") {
        if (header.elements.empty()) fail("a property before the first element");
        header.elements.back().properties.push_back(read_property(line));
      } else if (keyword != "comment" && keyword != "obj_info" && !keyword.empty()) {
        header.warnings.push_back(InputError::location(name_, line_) + in_quotes(keyword) +
                                  " is no word of a PLY header, ignored");
      }
    }
    if (!has_format) fail("the header names no format");
    header.bytes = at_;
    header.lines = line_;
    return header;
  }

 private:
  std::string_view next() {
    ++line_;
    const std::size_t end = text_.find('\n', at_);
    if (end == std::string_view::npos) fail("the header has no end_header");
    std::string_view line = text_.substr(at_, end - at_);
    at_ = end + 1;
    while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.remove_suffix(1);
    return line;
  }
  [[noreturn]] void fail(const std::string& what) const { throw InputError(name_, line_, what); }

  Format read_format(std::string_view words) {
    const std::string_view format = take_token(words);
    if (format == "ascii") return Format::kAscii;
    if (format == "binary_little_endian") return Format::kLittle;
    if (format == "binary_big_endian") return Format::kBig;
    fail("format: found " + in_quotes(format) +
         ", expected ascii, binary_little_endian or binary_big_endian");
  }
  Element read_element(std::string_view words) {
    Element element;
    element.name = take_token(words);
    const auto count = to_number(take_token(words));
    if (!count || !(*count >= 0.0 && *count < 0x1p53) || std::floor(*count) != *count) {
      fail("element: expected its name and how many there are");
    }
    element.count = static_cast<long long>(*count);
    return element;
  }
  Type read_type(std::string_view& words) {
    const std::string_view word = take_token(words);
    for (const TypeName& type : kTypes) {
      if (word == type.name || word == type.other) return type.type;
    }
    fail("property: found " + in_quotes(word) + ", expected a type as int, uchar or float");
  }
  Property read_property(std::string_view words) {
    Property property;
    std::string_view peeked = words;
    if (take_token(peeked) == "list") {
      words = peeked;
      property.count_type = read_type(words);
      if (*property.count_type == Type::kFloat || *property.count_type == Type::kDouble) {
        fail("property: a list's length of a type that is not whole");
      }
    }
    property.type = read_type(words);
    property.name = take_token(words);
    if (property.name.empty()) fail("property: without a name");
    return property;
  }

  std::string name_;
  std::string_view text_;
  std::size_t at_ = 0, line_ = 0;
};

/// The numbers after the header, one after the other.
class Numbers {
 public:
  Numbers(std::string name, std::string_view bytes, const Header& header)
      : name_(std::move(name)),
        bytes_(bytes.substr(header.bytes)),
        format_(header.format),
        tokens_(name_, format_ == Format::kAscii ? bytes_ : std::string_view(), header.lines + 1) {}

  /// A finite number within the range of float.
  [[nodiscard]] double take(Type type, std::string_view of_what) {
    if (format_ == Format::kAscii) return tokens_.number(of_what);
    const double number = take_any(type);
    if (!(std::abs(number) <= std::numeric_limits<float>::max())) {
      fail(std::string(of_what) + ": not a finite number");
    }
    return number;
  }
  /// Whatever is there; NaN for what is no number.
  [[nodiscard]] double take_any(Type type) {
    if (format_ == Format::kAscii) {
      return to_number(tokens_.take()).value_or(std::numeric_limits<double>::quiet_NaN());
    }
    const std::size_t size = kTypes[static_cast<std::size_t>(type)].size;
    if (bytes_.size() - at_ < size) throw InputError(name_ + ": the file ends too soon");
    const char* const at = bytes_.data() + at_;
    at_ += size;
    return at_place(at, type);
  }
  [[nodiscard]] const std::string& name() const { return name_; }
  /// Of the next number; 0 in a binary file.
  [[nodiscard]] std::size_t line() const { return format_ == Format::kAscii ? tokens_.line() : 0; }
  [[noreturn]] void fail(const std::string& what) const { throw InputError(name_, line(), what); }

 private:
  [[nodiscard]] double at_place(const char* at, Type type) const {
    const bool is_big = format_ == Format::kBig;
    switch (type) {
      case Type::kInt8:
        return number_at<std::int8_t>(at, is_big);
      case Type::kUint8:
        return number_at<std::uint8_t>(at, is_big);
      case Type::kInt16:
        return number_at<std::int16_t>(at, is_big);
      case Type::kUint16:
        return number_at<std::uint16_t>(at, is_big);
      case Type::kInt32:
        return number_at<std::int32_t>(at, is_big);
      case Type::kUint32:
        return number_at<std::uint32_t>(at, is_big);
      case Type::kFloat:
        return number_at<float>(at, is_big);
      case Type::kDouble:
        return number_at<double>(at, is_big);
    }
    return 0.0;
  }

  std::string name_;
  std::string_view bytes_;
  Format format_;
  std::size_t at_ = 0;
  TokenReader tokens_;
};

/// How long a list is; a list of so many numbers is there, or the reading fails at its end.
long long take_count(Numbers& numbers, const Property& list) {
  const double count = numbers.take(*list.count_type, "a list's length");
  if (!(count >= 0.0) || std::floor(count) != count) {
    numbers.fail("a list's length: expected a whole number from 0");
  }
  return static_cast<long long>(count);
}

void skip(Numbers& numbers, const Property& property) {
  const long long count = property.count_type ? take_count(numbers, property) : 1;
  for (long long i = 0; i < count; ++i) (void)numbers.take_any(property.type);
}

/// Returns whether the vertices have normals.
bool read_vertices(Numbers& numbers, const Element& element, MeshBuilder& mesh) {
  constexpr std::string_view kNames[] = {"x", "y", "z", "nx", "ny", "nz"};
  std::vector<int> place(element.properties.size(), -1);
  int found = 0;
  for (int i = 0; i < 6; ++i) {
    const auto at = element.find(kNames[i]);
    if (!at || element.properties[*at].count_type) continue;
    place[*at] = i;
    found |= 1 << i;
  }
  if ((found & 7) != 7) numbers.fail("vertices without x, y and z");
  const bool has_normals = found == 63;
  for (long long i = 0; i < element.count; ++i) {
    double values[6] = {};
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
      if (place[p] < 0 || (place[p] >= 3 && !has_normals)) {
        skip(numbers, element.properties[p]);
      } else {
        const Property& property = element.properties[p];
        values[place[p]] = place[p] < 3 ? numbers.take(property.type, property.name)
                                        : numbers.take_any(property.type);
      }
    }
    mesh.add_position({values[0], values[1], values[2]});
    if (!has_normals) continue;
    const glm::dvec3 normal(values[3], values[4], values[5]);
    mesh.add_normal(std::isfinite(normal.x + normal.y + normal.z) ? normal : glm::dvec3(0.0));
  }
  return has_normals;
}

void read_faces(Numbers& numbers, const Element& element, bool has_normals, MeshBuilder& mesh) {
  auto list = element.find("vertex_indices");
  if (!list) list = element.find("vertex_index");
  if (!list || !element.properties[*list].count_type) {
    numbers.fail("faces without a list vertex_indices");
  }
  std::vector<FileCorner> corners;
  for (long long i = 0; i < element.count; ++i) {
    const std::size_t line = numbers.line();
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
      if (p != *list) {
        skip(numbers, element.properties[p]);
        continue;
      }
      corners.clear();
      const long long count = take_count(numbers, element.properties[p]);
      for (long long k = 0; k < count; ++k) {
        const double index = numbers.take(element.properties[p].type, "a vertex index");
        if (!(index >= 0.0 && index < 2147483647.0) || std::floor(index) != index) {
          numbers.fail("a vertex index: expected a whole number from 0 to 2147483646");
        }
        const auto position = static_cast<std::int32_t>(index) + 1;
        corners.push_back({position, 0, has_normals ? position : 0});
      }
    }
    if (corners.size() < 3) {
      throw InputError(
          numbers.name(), line,
          "face with " + std::to_string(corners.size()) + " corners, expected at least 3");
    }
    mesh.add_face(corners, line);
  }
}

}  // namespace

Scene load_ply(const std::filesystem::path& file, const LoadOptions& options) {
  const std::string bytes = read_file(file), name = file.string();
  const Header header = HeaderReader(name, bytes).read();
  Numbers numbers(name, bytes, header);
  MeshBuilder mesh(name);
  Scene scene;
  scene.warnings = header.warnings;
  bool has_vertices = false, has_normals = false;
  for (const Element& element : header.elements) {
    if (element.name == "vertex" && !has_vertices) {
      has_normals = read_vertices(numbers, element, mesh);
      has_vertices = true;
      if (element.find("red")) {
        scene.warnings.push_back(name + ": colours of vertices are not read");
      }
    } else if (element.name == "face" && has_vertices) {
      read_faces(numbers, element, has_normals, mesh);
    } else if (!element.properties.empty()) {
      for (long long i = 0; i < element.count; ++i) {
        for (const Property& property : element.properties) skip(numbers, property);
      }
    }
  }
  mesh.build(options, scene);
  scene.materials.emplace_back().name = "default";
  scene.objects = {"default"};
  scene.files = {file};
  return scene;
}

}  // namespace raygate
