#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
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

struct Property {
  std::string name;
  NumberType type = NumberType::kFloat;
  std::optional<NumberType> count_type;  // of a list
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

class PlyReader {
 public:
  PlyReader(const std::filesystem::path& file, const std::string& bytes)
      : name_(file.string()), text_(bytes), mesh_(name_), tokens_(name_, "") {}

  Scene read(const LoadOptions& options) {
    Scene scene;
    read_header(scene.warnings);
    if (format_ == Format::kAscii) tokens_ = TokenReader(name_, text_.substr(at_), line_ + 1);
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
  /// Returns the current line of the header, or of the next number after it; 0 in a binary file.
  [[nodiscard]] std::size_t line() const {
    return in_header_ ? line_ : format_ == Format::kAscii ? tokens_.line() : 0;
  }
  [[noreturn]] void fail(const std::string& what) const { throw InputError(name_, line(), what); }

  // Header

  std::string_view next_line() {
    ++line_;
    // The first line determines the line ending, as binary data after the header may resemble one.
    const bool is_old_mac = text_.starts_with("ply\r") && !text_.starts_with("ply\r\n");
    const std::size_t end = text_.find(is_old_mac ? '\r' : '\n', at_);
    if (end == std::string_view::npos) fail("the header has no end_header");
    std::string_view line = text_.substr(at_, end - at_);
    at_ = end + 1;
    while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.remove_suffix(1);
    return line;
  }

  void read_header(std::vector<std::string>& warnings) {
    if (next_line() != "ply") fail("not a PLY file: its first line is not \"ply\"");
    bool has_format = false;
    for (std::string_view line = next_line(); line != "end_header"; line = next_line()) {
      const std::string_view keyword = take_token(line);
      if (keyword == "format") {
        read_format(take_token(line));
        has_format = true;
      } else if (keyword == "element") {
        read_element(line);
      } else if (keyword == "property") {
        if (elements_.empty()) fail("a property before the first element");
        elements_.back().properties.push_back(read_property(line));
      } else if (keyword == "comment") {
        if (take_token(line) != "TextureFile") continue;
        if (texture_.empty()) {
          texture_ = line;
        } else {
          unread_.push_back("texture " + in_quotes(line));
        }
      } else if (keyword != "obj_info" && !keyword.empty()) {
        warnings.push_back(InputError::location(name_, line_) + in_quotes(keyword) +
                           " is no word of a PLY header, ignored");
      }
    }
    if (!has_format) fail("the header names no format");
    in_header_ = false;
  }

  void read_format(std::string_view format) {
    constexpr std::string_view kFormats[] = {"ascii", "binary_little_endian", "binary_big_endian"};
    const auto* const found = std::ranges::find(kFormats, format);
    if (found == std::end(kFormats)) {
      fail("format: found " + in_quotes(format) +
           ", expected ascii, binary_little_endian or binary_big_endian");
    }
    format_ = static_cast<Format>(found - std::begin(kFormats));
  }

  void read_element(std::string_view words) {
    Element& element = elements_.emplace_back();
    element.name = take_token(words);
    const auto count = to_number(take_token(words));
    if (!count || !(*count >= 0.0 && *count < 0x1p53) || std::floor(*count) != *count) {
      fail("element: expected its name and how many there are");
    }
    element.count = static_cast<long long>(*count);
  }

  NumberType read_type(std::string_view& words) {
    const std::string_view word = take_token(words);
    const auto* const found = std::ranges::find_if(
        kTypeNames, [&](const auto& names) { return word == names[0] || word == names[1]; });
    if (found == std::end(kTypeNames)) {
      fail("property: found " + in_quotes(word) + ", expected a type as int, uchar or float");
    }
    return static_cast<NumberType>(found - std::begin(kTypeNames));
  }

  Property read_property(std::string_view words) {
    Property property;
    std::string_view peeked = words;
    if (take_token(peeked) == "list") {
      words = peeked;
      property.count_type = read_type(words);
      if (*property.count_type >= NumberType::kFloat) {
        fail("property: a list's length of a type that is not whole");
      }
    }
    property.type = read_type(words);
    property.name = take_token(words);
    if (property.name.empty()) fail("property: without a name");
    return property;
  }

  // Data

  /// Takes a finite number within the range of float.
  double take(NumberType type, std::string_view of_what) {
    if (format_ == Format::kAscii) return tokens_.number(of_what);
    const double number = take_any(type);
    if (!(std::abs(number) <= std::numeric_limits<float>::max())) {
      fail(std::string(of_what) + ": not a finite number");
    }
    return number;
  }

  /// Takes any number; NaN for a word that is no number.
  double take_any(NumberType type) {
    if (format_ == Format::kAscii) {
      return to_number(tokens_.take()).value_or(std::numeric_limits<double>::quiet_NaN());
    }
    if (text_.size() - at_ < bytes_of(type)) fail("the file ends too soon");
    const char* const bytes = text_.data() + at_;
    at_ += bytes_of(type);
    return number_at(bytes, type, format_ == Format::kBig);
  }

  /// Takes the length of a list. If the file is shorter, taking its elements fails.
  long long take_count(const Property& list) {
    const double count = take(*list.count_type, "a list's length");
    if (!(count >= 0.0 && count <= 0xFFFF'FFFF) || std::floor(count) != count) {
      fail("a list's length: expected a whole number from 0 to 4294967295");
    }
    return static_cast<long long>(count);
  }

  void skip(const Property& property) {
    const long long count = property.count_type ? take_count(property) : 1;
    for (long long i = 0; i < count; ++i) (void)take_any(property.type);
  }

  void read_vertices(const Element& element) {
    constexpr std::string_view kNames[] = {"x",  "y",   "z",     "nx",        "ny",
                                           "nz", "red", "green", "blue",      "s",
                                           "t",  "u",   "v",     "texture_u", "texture_v"};
    constexpr int kColor = 6, kTexcoord = 9, kCount = 15;
    std::vector<int> place(element.properties.size(), -1);
    int found = 0;
    for (int i = 0; i < kCount; ++i) {
      const auto at = element.find(kNames[i]);
      if (!at || element.properties[*at].count_type) continue;
      place[*at] = i;
      found |= 1 << i;
    }
    if ((found & 7) != 7) fail("vertices without x, y and z");
    has_normals_ = (found & 070) == 070;
    const bool has_colors = (found & 0700) == 0700;
    int s = kTexcoord;  // index of the name of the first texture coordinate, if there are any
    while (s < kCount && (texture_.empty() || (found >> s & 3) != 3)) s += 2;
    has_texcoords_ = s < kCount;
    for (std::size_t p = 0; p < place.size(); ++p) {
      const bool is_read = place[p] < 3           ? true
                           : place[p] < kColor    ? has_normals_
                           : place[p] < kTexcoord ? has_colors
                                                  : place[p] == s || place[p] == s + 1;
      if (!is_read) place[p] = -1;
      if (place[p] < 0) note_unread(element, p);
    }
    for (long long i = 0; i < element.count; ++i) {
      double values[kCount] = {};
      for (std::size_t p = 0; p < element.properties.size(); ++p) {
        const Property& property = element.properties[p];
        const int at = place[p];
        if (at < 0) {
          skip(property);
        } else if (at >= kColor && at < kTexcoord) {
          values[at] = take_any(property.type) / largest_code(property.type);
        } else {
          values[at] = at < 3 ? take(property.type, property.name) : take_any(property.type);
        }
      }
      mesh_.add_position({values[0], values[1], values[2]});
      if (has_colors) mesh_.add_color({values[kColor], values[kColor + 1], values[kColor + 2]});
      if (has_normals_) mesh_.add_normal({values[3], values[4], values[5]});
      if (has_texcoords_) mesh_.add_texcoord({values[s], values[s + 1]});
    }
  }

  /// Returns the code of 1 in a colour of that type.
  [[nodiscard]] static double largest_code(NumberType type) {
    return type == NumberType::kUint8 ? 255.0 : type == NumberType::kUint16 ? 65535.0 : 1.0;
  }

  void note_unread(const Element& element, std::size_t property) {
    unread_.push_back(in_quotes(element.properties[property].name) + " of " + element.name);
  }

  /// Returns the index of the property with the vertices of a face. Notes all other
  /// properties except `also` as unread.
  [[nodiscard]] std::size_t index_list(const Element& element,
                                       std::optional<std::size_t> also = std::nullopt) {
    auto list = element.find("vertex_indices");
    if (!list) list = element.find("vertex_index");
    if (!list || !element.properties[*list].count_type) {
      fail("element " + element.name + " without a list vertex_indices");
    }
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
      if (p != *list && p != also) note_unread(element, p);
    }
    return *list;
  }

  /// Returns a vertex index counted from 1, as in FileCorner.
  [[nodiscard]] std::int32_t position_of(double index) const {
    if (!(index >= 0.0 && index < 2147483647.0) || std::floor(index) != index) {
      fail("a vertex index: expected a whole number from 0 to 2147483646");
    }
    return static_cast<std::int32_t>(index) + 1;
  }

  [[nodiscard]] FileCorner corner_of(std::int32_t position) const {
    return {position, has_texcoords_ ? position : 0, has_normals_ ? position : 0};
  }

  void read_faces(const Element& element) {
    // The texture coordinates of corners, in pairs, replace those of vertices.
    std::optional<std::size_t> texcoords = element.find("texcoord");
    if (texture_.empty() || !texcoords || !element.properties[*texcoords].count_type) {
      texcoords.reset();
    }
    const std::size_t list = index_list(element, texcoords);
    std::vector<FileCorner> corners;
    std::vector<double> pairs;
    for (long long i = 0; i < element.count; ++i) {
      const std::size_t face_line = line();
      for (std::size_t p = 0; p < element.properties.size(); ++p) {
        const Property& property = element.properties[p];
        if (p == list) {
          corners.clear();
          const long long count = take_count(property);
          for (long long k = 0; k < count; ++k) {
            const double index = take(property.type, "a vertex index");
            corners.push_back(corner_of(position_of(index)));
          }
        } else if (p == texcoords) {
          pairs.clear();
          const long long count = take_count(property);
          for (long long k = 0; k < count; ++k) pairs.push_back(take_any(property.type));
        } else {
          skip(property);
        }
      }
      for (std::size_t k = 0; texcoords && k < corners.size(); ++k) {
        corners[k].texcoord = 0;
        if (2 * k + 1 >= pairs.size()) continue;
        mesh_.add_texcoord({pairs[2 * k], pairs[2 * k + 1]});
        corners[k].texcoord = static_cast<std::int32_t>(mesh_.counts().texcoords);
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
    material.diffuse_map = find_file(folder, texture_, name_ + ": ", scene.warnings)
                               .value_or(folder / texture_)
                               .string();
    if (options.textures) load_textures(scene);
  }

  std::string name_;
  std::string_view text_;
  std::size_t at_ = 0, line_ = 0;  // numbers of bytes, and of lines of the header, that were read
  bool in_header_ = true;
  Format format_ = Format::kAscii;
  std::vector<Element> elements_;
  std::vector<std::string> unread_;  // properties and elements to warn about
  MeshBuilder mesh_;
  TokenReader tokens_;        // of an ASCII file, after the header
  std::string_view texture_;  // the file of the header's first "comment TextureFile"
  bool has_normals_ = false, has_texcoords_ = false;
};

}  // namespace

Scene load_ply(const std::filesystem::path& file, const LoadOptions& options) {
  const std::string bytes = read_file(file);
  return PlyReader(file, bytes).read(options);
}

}  // namespace raygate
