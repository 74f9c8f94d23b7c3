#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <iomanip>
#include <iterator>
#include <map>
#include <set>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "host/scene/io/mesh_builder.h"
#include "host/scene/io/scene_loader.h"
#include "host/scene/io/text.h"

namespace raygate {
namespace {

/// Names, numbered in the order of their first use.
using NameNumbers = std::map<std::string, std::uint32_t>;

std::uint32_t number_of(const std::string& name, NameNumbers& numbers) {
  return numbers.emplace(name, static_cast<std::uint32_t>(numbers.size())).first->second;
}

std::vector<std::string> in_order(const NameNumbers& numbers) {
  std::vector<std::string> names(numbers.size());
  for (const auto& [name, number] : numbers) names[number] = name;
  return names;
}

/// Reads v, vt, vn, f, g, o, s, usemtl and mtllib (Wavefront's "Object Files", version 3.0). Leaves
/// out other statements, such as lines and free-form surfaces, with one warning for each kind.
class ObjReader {
 public:
  ObjReader(const std::filesystem::path& file, Scene& scene)
      : lines_(file), folder_(file.parent_path()), mesh_(file.string()), scene_(scene) {}

  void read(const LoadOptions& options) {
    while (auto statement = lines_.next()) read_statement(*statement);
    mesh_.build(options, scene_);
    scene_.objects = in_order(objects_);
    scene_.files = {libraries_.begin(), libraries_.end()};
    scene_.files.emplace_back(mesh_.file_name());
    assign_materials();
    if (options.textures) load_textures(scene_);
  }

 private:
  void read_statement(Words& words) {
    const std::string_view keyword = words.take();
    if (keyword == "v") {
      const auto numbers = take_numbers(words, keyword, "x y z (and a weight or a colour)");
      mesh_.add_position({numbers[0], numbers[1], numbers[2]});
      if (numbers.size() >= 6) mesh_.add_color({numbers[3], numbers[4], numbers[5]});
      if (numbers.size() == 4 && numbers[3] != 1.0) {
        warn_once(keyword, words, "vertex weights are ignored: they concern curves alone");
      }
    } else if (keyword == "vn") {
      const auto numbers = take_numbers(words, keyword, "x y z");
      mesh_.add_normal({numbers[0], numbers[1], numbers[2]});
    } else if (keyword == "vt") {
      const auto numbers = take_numbers(words, keyword, "u v");
      mesh_.add_texcoord({numbers[0], numbers.size() > 1 ? numbers[1] : 0.0});
    } else if (keyword == "f" || keyword == "fo") {  // old files use fo for f
      words.drop_comment();
      corners_.clear();
      while (!words.at_end()) corners_.push_back(take_corner(words));
      set_object();
      mesh_.add_face(corners_, words.line(), face_);
    } else if (keyword == "g") {
      group_.clear();  // "a b" may be one name or two; it is taken as one
      while (!words.at_end()) group_.append(group_.empty() ? "" : " ").append(words.take());
      object_is_known_ = false;
    } else if (keyword == "o") {
      object_ = words.rest();
      object_is_known_ = false;
    } else if (keyword == "s") {
      set_smoothing(words);
    } else if (keyword == "usemtl") {
      face_.material = number_of(std::string(words.rest()), materials_);
      if (face_.material == first_uses_.size()) first_uses_.push_back(words.place());
    } else if (keyword == "mtllib") {
      load_libraries(words);
    } else {
      warn_once(keyword, words,
                in_quotes(keyword) + " statements are ignored: only polygons are rendered");
    }
  }

  /// Takes all numbers of v, vt or vn, at most seven.
  std::span<const double> take_numbers(Words& words, std::string_view keyword,
                                       const char* expected) {
    words.drop_comment();
    std::size_t count = 0;
    for (; !words.at_end(); ++count) {
      if (count == numbers_.size()) words.fail("too many numbers after " + in_quotes(keyword));
      // MeshBuilder leaves out normals, texture coordinates and colours that are not finite.
      const bool is_coordinate = keyword == "v" && count < 3;
      numbers_[count] = is_coordinate ? words.number(keyword) : words.any_number();
    }
    const bool is_right = keyword == "v"    ? count == 3 || count == 4 || count >= 6
                          : keyword == "vn" ? count == 3
                                            : count >= 1 && count <= 3;
    if (!is_right) {
      words.fail(std::string(keyword) + " with " + std::to_string(count) + " numbers, expected " +
                 expected);
    }
    return {numbers_.data(), count};
  }

  /// Takes a face corner: v, v/vt, v//vn or v/vt/vn, perhaps followed by slashes.
  FaceCorner take_corner(Words& words) const {
    const std::string_view corner = words.peek();
    const auto fail = [&](const std::string& what) {
      words.fail("face corner " + in_quotes(corner) + what);
    };
    const MeshBuilder::Counts counts = mesh_.counts();
    const std::size_t so_far[] = {counts.positions, counts.texcoords, counts.normals};
    std::array<std::uint32_t, 3> indices{kNoIndex, kNoIndex, kNoIndex};
    const char* at = corner.data();
    const char* const end = at + corner.size();
    for (std::size_t field = 0; field < 3; ++field) {
      if (field == 0 || (at != end && *at != '/')) {
        std::int32_t number = 0;
        const auto [rest, error] = std::from_chars(at, end, number);
        if (error == std::errc::invalid_argument) break;
        if (error == std::errc::result_out_of_range) fail(": an index beyond 2147483647");
        if (number == 0 && field == 0) {
          fail(": index 0, expected 1 for the first or -1 for the last so far");
        }
        const std::int64_t index =
            number > 0 ? number - 1 : static_cast<std::int64_t>(so_far[field]) + number;
        if (index < 0 && field == 0) {
          fail(", but the file has " + std::to_string(so_far[0]) + " vertices so far");
        }
        const bool is_none = number == 0 || index < 0;  // MeshBuilder warns of kNoIndex - 1
        indices[field] = is_none ? kNoIndex - 1 : static_cast<std::uint32_t>(index);
        at = rest;
      }
      if (at == end) {
        (void)words.take();
        return {indices[0], indices[1], indices[2]};
      }
      if (*at++ != '/') break;
    }
    fail(", expected v, v/vt, v//vn or v/vt/vn");
    return {};
  }

  /// Loads the files that a mtllib statement names: one file whose name may hold spaces, or several
  /// names, separated by spaces, some perhaps in quotes.
  void load_libraries(const Words& statement) {
    const std::string place = statement.place(), all(statement.rest());
    if (all.empty()) scene_.warnings.push_back(place + "mtllib without a file");
    if (const auto file = find_file(folder_, all, place, scene_.warnings)) return load(*file);
    std::istringstream names(all);
    for (std::string name; names >> std::quoted(name, '"', '\0');) {
      if (const auto file = find_file(folder_, name, place, scene_.warnings)) {
        load(*file);
        continue;
      }
      std::error_code error;
      const auto type = std::filesystem::status(folder_ / name, error).type();
      const bool is_known = type != std::filesystem::file_type::none;
      scene_.warnings.push_back(place + "material file " + in_quotes(name) +
                                (is_known ? " is missing" : " cannot be read: " + error.message()) +
                                ", default materials instead");
    }
  }

  void load(const std::filesystem::path& file) {
    if (!libraries_.insert(file.lexically_normal()).second) return;
    std::vector<Material> read = read_mtl(file, scene_.warnings);
    if (read.empty()) scene_.warnings.push_back(file.string() + ": defines no material");
    std::ranges::move(read, std::back_inserter(scene_.materials));
  }

  void warn_once(std::string_view keyword, const Words& words, const std::string& what) {
    if (warned_of_.emplace(keyword).second) scene_.warnings.push_back(words.place() + what);
  }

  void set_smoothing(Words& words) {
    words.drop_comment();
    const std::string_view word = words.peek();
    const char* const end = word.data() + word.size();
    face_.group = 0;
    const auto [rest, error] = std::from_chars(word.data(), end, face_.group);
    if (word == "off" || (error == std::errc() && rest == end)) return;
    face_.group = word == "on" ? 1 : 0;
    if (word == "on") return;
    warn_once("s", words,
              "s " + in_quotes(word) + ", expected the number of a group or off; taken as off");
  }

  /// Sets the object of the next face from the current o and g names, each of which may be empty.
  void set_object() {
    if (object_is_known_) return;
    const std::string between = object_.empty() || group_.empty() ? "" : "/";
    const std::string name = object_ + between + group_;
    face_.object = number_of(name.empty() ? "default" : name, objects_);
    object_is_known_ = true;
  }

  /// Resolves material names at the end of the file, because mtllib may come after usemtl.
  void assign_materials() {
    NameNumbers defined;  // the first of each name
    for (std::uint32_t i = 0; i < scene_.materials.size(); ++i) {
      Material& material = scene_.materials[i];
      defined.emplace(material.name, i);
      // With a texture, vertex colours are ignored: scanners repeat the texture's colours there.
      material.has_vertex_colors = material.diffuse_map.file.empty();
    }
    std::uint32_t default_material = kNoIndex;
    std::vector<std::uint32_t> materials;
    const std::vector<std::string> names = in_order(materials_);
    for (std::size_t i = 0; i < names.size(); ++i) {
      const auto found = defined.find(names[i]);
      materials.push_back(found == defined.end() ? kNoIndex : found->second);
      if (materials[i] == kNoIndex && !names[i].empty()) {
        scene_.warnings.push_back(first_uses_[i] + "material " + in_quotes(names[i]) +
                                  " is defined nowhere, the default instead");
      }
    }
    for (Triangle& triangle : scene_.triangles) {
      if (triangle.material != kNoIndex) triangle.material = materials[triangle.material];
      if (triangle.material != kNoIndex) continue;
      if (default_material == kNoIndex) {
        default_material = static_cast<std::uint32_t>(scene_.materials.size());
        Material& material = scene_.materials.emplace_back();
        material.name = "default";
        if (!scene_.colors.empty()) material.diffuse = glm::vec3(1.0f);
      }
      triangle.material = default_material;
    }
  }

  TextLines lines_;
  std::filesystem::path folder_;
  MeshBuilder mesh_;
  std::set<std::filesystem::path> libraries_;  // MTL files that were read
  Scene& scene_;
  NameNumbers objects_, materials_;               // materials_: names in usemtl
  std::vector<std::string> first_uses_;           // "file:line: " of the first use of each material
  std::string object_, group_;                    // current names of o and g; empty: none
  bool object_is_known_ = false;                  // whether face_.object is up to date with them
  FaceAttributes face_{.material = kNoIndex};     // of the next face; kNoIndex: no usemtl
  std::set<std::string, std::less<>> warned_of_;  // keywords
  std::array<double, 7> numbers_{};               // of one statement
  std::vector<FaceCorner> corners_;               // of one face
};

}  // namespace

Scene load_obj(const std::filesystem::path& file, const LoadOptions& options) {
  Scene scene;
  ObjReader(file, scene).read(options);
  return scene;
}

}  // namespace raygate
