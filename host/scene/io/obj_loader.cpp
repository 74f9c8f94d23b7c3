#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <exception>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "host/base/threads.h"
#include "host/scene/io/material_library.h"
#include "host/scene/io/mesh_builder.h"
#include "host/scene/io/scene_loader.h"
#include "host/scene/io/text.h"

namespace raygate {
namespace {

template <std::size_t size>
bool is_one_of(const std::array<std::string_view, size>& list, std::string_view keyword) {
  return std::find(list.begin(), list.end(), keyword) != list.end();
}

// Statements of shapes other than polygons.
constexpr std::array<std::string_view, 26> kOtherShapes{
    "p",     "l",    "vp",   "cstype", "deg",  "bmat", "step", "curv", "curv2",
    "surf",  "parm", "trim", "hole",   "scrv", "sp",   "end",  "con",  "ctech",
    "stech", "bsp",  "bzp",  "cdc",    "cdp",  "res",  "t",    "vw"};

// Statements that affect neither polygons nor materials: merging groups, display attributes.
constexpr std::array<std::string_view, 9> kOfNoConsequence{
    "mg", "bevel", "c_interp", "d_interp", "lod", "shadow_obj", "trace_obj", "usemap", "maplib"};

/// Parses vertices and faces of a part of a file. Chunks can be read concurrently. Statements about
/// materials, groups and other files depend on earlier chunks, so they are kept for ObjReader.
class ObjChunk {
 public:
  /// A statement other than a vertex or a face.
  struct Rest {
    std::string statement;
    std::size_t line;
    std::size_t faces;  ///< number of the chunk's faces before it
  };

  /// `earlier` counts the elements of earlier chunks, if they are known.
  explicit ObjChunk(TextLines lines, std::optional<MeshBuilder::Counts> earlier = {})
      : lines_(std::move(lines)), mesh_(lines_.file_name()) {
    mesh_.begin_after(earlier);
  }

  /// Reads v, vt, vn and f. Checks the count of numbers, that those of vertices are finite, and
  /// that no vertex index is 0. Stops at the first error.
  void read() {
    try {
      while (const auto statement = lines_.next()) read_statement(*statement);
    } catch (...) {
      error_ = std::current_exception();
    }
  }

  [[nodiscard]] std::size_t lines() const { return lines_.lines_taken(); }
  [[nodiscard]] MeshBuilder& mesh() { return mesh_; }
  [[nodiscard]] const std::vector<Rest>& rest() const { return rest_; }
  /// Returns the InputError at which read() stopped, if it did.
  [[nodiscard]] const std::exception_ptr& error() const { return error_; }

 private:
  void read_statement(std::string_view statement);
  std::span<const double> read_numbers(std::string_view keyword, std::string_view words);
  void read_face(std::string_view corners);
  FileCorner read_corner(std::string_view corner) const;
  void keep(std::string_view statement);
  void keep_once(std::string_view keyword);

  TextLines lines_;
  MeshBuilder mesh_;
  std::vector<Rest> rest_;
  std::set<std::string, std::less<>> kept_;  // keywords passed to keep_once()
  std::exception_ptr error_;
  std::array<double, 7> numbers_{};  // of one statement
  std::vector<FileCorner> corners_;  // of one face
};

void ObjChunk::read_statement(std::string_view statement) {
  std::string_view words = statement;
  const std::string_view keyword = take_token(words);
  if (keyword == "v") {
    const auto numbers = read_numbers(keyword, words);
    mesh_.add_position({numbers[0], numbers[1], numbers[2]});
    if (numbers.size() >= 6) mesh_.add_color({numbers[3], numbers[4], numbers[5]});
  } else if (keyword == "vn") {
    const auto numbers = read_numbers(keyword, words);
    mesh_.add_normal({numbers[0], numbers[1], numbers[2]});
  } else if (keyword == "vt") {
    const auto numbers = read_numbers(keyword, words);
    mesh_.add_texcoord({numbers[0], numbers.size() > 1 ? numbers[1] : 0.0});
  } else if (keyword == "f" || keyword == "fo") {  // old files use fo for f
    read_face(words);
  } else if (keyword == "g" || keyword == "o" || keyword == "s" || keyword == "usemtl" ||
             keyword == "mtllib") {
    keep(statement);
  } else if (is_one_of(kOtherShapes, keyword)) {
    keep_once(keyword);
  } else if (keyword == "call" || keyword == "csh") {
    lines_.fail(in_quotes(keyword) + " (another file, a command) is not supported");
  } else if (!is_one_of(kOfNoConsequence, keyword)) {
    lines_.fail(in_quotes(keyword) +
                " is no OBJ statement, expected v, vt, vn, f, g, o, usemtl, "
                "mtllib, # or the like");
  }
}

void ObjChunk::keep(std::string_view statement) {
  rest_.push_back({std::string(statement), lines_.line(), mesh_.face_count()});
}

/// Keeps the keyword of the first statement with this keyword.
void ObjChunk::keep_once(std::string_view keyword) {
  if (kept_.emplace(keyword).second) keep(keyword);
}

std::span<const double> ObjChunk::read_numbers(std::string_view keyword, std::string_view words) {
  std::size_t count = 0;
  for (std::string_view word = take_token_before_comment(words); !word.empty();
       word = take_token_before_comment(words)) {
    if (count == numbers_.size()) lines_.fail("too many numbers after " + in_quotes(keyword));
    // MeshBuilder leaves out normals, texture coordinates and colours that are not finite.
    const bool must_be_finite = keyword == "v" && count < 3;
    numbers_[count++] = must_be_finite
                            ? lines_.number(word, keyword)
                            : to_number(word).value_or(std::numeric_limits<double>::quiet_NaN());
  }
  const auto expect = [&](bool right, const char* what) {
    if (!right) {
      lines_.fail(std::string(keyword) + " with " + std::to_string(count) + " numbers, expected " +
                  what);
    }
  };
  if (keyword == "v") {
    expect(count == 3 || count == 4 || count >= 6, "x y z (and a weight or a colour)");
    if (count == 4 && numbers_[3] != 1.0) {
      keep_once(keyword);
    }
  } else if (keyword == "vn") {
    expect(count == 3, "x y z");
  } else {
    expect(count >= 1 && count <= 3, "u v");
  }
  return {numbers_.data(), count};
}

void ObjChunk::read_face(std::string_view words) {
  corners_.clear();
  for (std::string_view corner = take_token_before_comment(words); !corner.empty();
       corner = take_token_before_comment(words)) {
    // "1/" and "1//" have no texture coordinate and no normal.
    std::string_view plain = corner;
    while (plain.size() > 1 && plain.back() == '/' && corner.size() - plain.size() < 2) {
      plain.remove_suffix(1);
    }
    corners_.push_back(read_corner(plain));
  }
  mesh_.add_face(corners_, lines_.line());
}

FileCorner ObjChunk::read_corner(std::string_view corner) const {
  const auto malformed = [&] {
    lines_.fail("face corner " + in_quotes(corner) + ", expected v, v/vt, v//vn or v/vt/vn");
  };
  const char* at = corner.data();
  const char* const end = at + corner.size();
  std::array<std::int32_t, 3> indices{};  // position, texture coordinate, normal
  for (std::size_t field = 0; field < 3; ++field) {
    if (field == 1 && at != end && *at == '/') {  // v//vn
      ++at;
      continue;
    }
    std::int32_t& index = indices[field];
    const auto [rest, error] = std::from_chars(at, end, index);
    if (error == std::errc::invalid_argument) malformed();
    if (error == std::errc::result_out_of_range || index == INT32_MIN) {
      lines_.fail("face corner " + in_quotes(corner) + ": an index beyond 2147483647");
    }
    if (index == 0 && field == 0) {
      lines_.fail("face corner " + in_quotes(corner) +
                  ": index 0, expected 1 for the first or -1 for the last so far");
    }
    if (index == 0) index = INT32_MIN;  // refers to no element
    at = rest;
    if (at == end) return {indices[0], indices[1], indices[2]};
    if (*at++ != '/') malformed();
  }
  malformed();
  return {};
}

/// Numbers names in the order of their first use.
class NameTable {
 public:
  std::uint32_t number_of(const std::string& name) {
    const auto [entry, added] = numbers_.emplace(name, static_cast<std::uint32_t>(names_.size()));
    if (added) names_.push_back(name);
    return entry->second;
  }
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }

 private:
  std::map<std::string, std::uint32_t> numbers_;
  std::vector<std::string> names_;
};

/// Reads v, vt, vn, f, g, o, s, usemtl and mtllib; vertices and faces on several threads (see
/// ObjChunk). Leaves out points, lines and free-form curves and surfaces, with a warning, and
/// statements that only concern a modelling program, without one. Throws InputError for any other
/// statement. (The statements are those of Wavefront's "Object Files", version 3.0.)
class ObjReader final : public StatementReader {
 public:
  ObjReader(const std::filesystem::path& file, Scene& scene)
      : StatementReader(file, scene.warnings),
        mesh_(file.string()),
        mtl_(file.parent_path(), lines(), scene.warnings),
        scene_(scene) {}

  void read(const LoadOptions& options) {
    read_statements(options);
    mesh_.build(options, scene_);
    scene_.objects = NameList(objects_.names());
    scene_.files = {mtl_.files().begin(), mtl_.files().end()};
    scene_.files.emplace_back(lines().file_name());
    assign_materials();
    if (options.textures) load_textures(scene_);
  }

 private:
  void read_statements(const LoadOptions& options) {
    const std::size_t most = options.threads > 1 ? std::size_t{4} * options.threads : 1;
    const std::vector<TextLines> parts = lines().split(most, options.chunk_size);
    std::vector<ObjChunk> chunks(parts.begin(), parts.end());
    for_each_on_threads(options.threads, chunks.size(), [&](std::size_t i) { chunks[i].read(); });
    std::size_t line = 0;
    for (std::size_t i = 0; i < chunks.size(); ++i) {
      if (chunks[i].error() || !chunks[i].mesh().can_follow(mesh_)) {
        // Read it again, as messages need the numbers of lines and of elements in the whole file.
        TextLines again = parts[i];
        again.begin_after(line);
        chunks[i] = ObjChunk(std::move(again), mesh_.counts());
        chunks[i].read();
        take(chunks[i], 0);
        line = chunks[i].lines();
      } else {
        take(chunks[i], line);
        line += chunks[i].lines();
      }
    }
  }

  /// Appends a chunk. `line` is added to its line numbers.
  void take(ObjChunk& chunk, std::size_t line) {
    const std::size_t first = mesh_.face_count();
    std::size_t done = first;
    mesh_.append(std::move(chunk.mesh()), line);
    for (const ObjChunk::Rest& rest : chunk.rest()) {
      assign_faces(done, first + rest.faces);
      done = first + rest.faces;
      lines().go_to(line + rest.line);
      read_statement(rest.statement);
    }
    assign_faces(done, mesh_.face_count());
    if (chunk.error()) std::rethrow_exception(chunk.error());
  }

  /// Sets the material and the object of the faces in [begin, end) to the current ones.
  void assign_faces(std::size_t begin, std::size_t end) {
    if (begin == end) return;
    if (!object_is_known_) {
      const std::string between = object_.empty() || group_.empty() ? "" : "/";
      const std::string name = object_ + between + group_;
      object_number_ = objects_.number_of(name.empty() ? "default" : name);
      object_is_known_ = true;
    }
    mesh_.assign_faces(begin, end, material_number_, object_number_, smoothing_group_);
  }

  void read_statement(std::string_view statement) {
    const std::string_view keyword = take_token(statement);
    if (keyword == "g") {
      set_group(statement);
    } else if (keyword == "o") {
      object_ = statement;
      object_is_known_ = false;
    } else if (keyword == "s") {
      set_smoothing(statement);
    } else if (keyword == "usemtl") {
      material_number_ = materials_.number_of(std::string(statement));
      if (material_number_ == first_uses_.size()) first_uses_.push_back(lines().place());
    } else if (keyword == "mtllib") {
      mtl_.load_library(statement);
    } else if (keyword == "v") {
      warn_once(keyword, "vertex weights are ignored: they concern curves alone");
    } else {
      warn_once(keyword,
                std::string(keyword) + " statements are ignored: only polygons are rendered");
    }
  }

  /// Sets the group. "a b" may be one name or two; it is taken as one.
  void set_group(std::string_view names) {
    group_.clear();
    for (std::string_view name = take_token(names); !name.empty(); name = take_token(names)) {
      group_.append(group_.empty() ? "" : " ").append(name);
    }
    object_is_known_ = false;
  }

  void set_smoothing(std::string_view words) {
    mesh_.smoothing_is_said();
    const std::string_view word = take_token_before_comment(words);
    const char* const end = word.data() + word.size();
    smoothing_group_ = 0;
    const auto [rest, error] = std::from_chars(word.data(), end, smoothing_group_);
    if (word == "off" || (error == std::errc() && rest == end)) return;
    smoothing_group_ = word == "on" ? 1 : 0;
    if (word != "on") {
      warn_once("s",
                "s " + in_quotes(word) + ", expected the number of a group or off; taken as off");
    }
  }

  /// Resolves the names of materials at the end of the file, as mtllib may come after usemtl.
  void assign_materials() {
    scene_.materials = mtl_.materials();
    // Scanners duplicate the texture's colours at the vertices.
    for (Material& material : scene_.materials) {
      material.has_vertex_colors = material.diffuse_map.empty();
    }
    std::uint32_t default_material = kNoIndex;
    std::vector<std::uint32_t> materials;
    const std::vector<std::string>& names = materials_.names();
    for (std::size_t i = 0; i < names.size(); ++i) {
      materials.push_back(mtl_.find(names[i]).value_or(kNoIndex));
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

  MeshBuilder mesh_;
  MaterialLibrary mtl_;
  Scene& scene_;
  NameTable objects_;
  NameTable materials_;                  // of usemtl; faces store their indices (kNoIndex: none)
  std::vector<std::string> first_uses_;  // "file:line: " of the first use of each material
  std::string object_, group_;           // the current ones; empty: none
  std::uint32_t object_number_ = 0;
  bool object_is_known_ = false;
  std::uint32_t material_number_ = kNoIndex;
  std::uint32_t smoothing_group_ = 0;
};

}  // namespace

Scene load_obj(const std::filesystem::path& file, const LoadOptions& options) {
  Scene scene;
  ObjReader(file, scene).read(options);
  return scene;
}

}  // namespace raygate
