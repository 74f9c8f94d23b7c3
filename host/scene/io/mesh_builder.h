// MeshBuilder: collects the vertices and polygons of a file and triangulates them into a scene.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

#include "host/scene/bounds.h"
#include "host/scene/io/scene_loader.h"
#include "host/scene/scene.h"

namespace raygate {

/// One corner of a polygon: indices as the file has them, from 1, or below 0 counted from the last
/// one so far; 0: none.
struct FileCorner {
  std::int32_t position = 0, texcoord = 0, normal = 0;
};

/// Collects what a file holds, in its order, and builds the scene at its end: only then are the
/// extent (to recentre) and the number of vertices (faces may come before theirs) known.
class MeshBuilder {
 public:
  /// Where faces come from, for messages: "scene.obj:12: ..." or, of an array, "faces[12]: ...".
  enum class Source { kFile, kArray };

  explicit MeshBuilder(std::string file_name, Source source = Source::kFile)
      : file_name_(std::move(file_name)), source_(source) {}

  void add_position(const glm::dvec3& position) { positions_.push_back(position); }
  /// Gives the last position a colour: of sRGB codes from 0 to 1 or, where the file has one above
  /// 1, to 255; or scene-linear.
  void add_color(const glm::vec3& color);
  void colors_are_linear() { has_linear_colors_ = true; }
  void add_texcoord(const glm::vec2& texcoord) { texcoords_.push_back(texcoord); }
  void add_normal(const glm::dvec3& normal);
  /// Gives the last normal a tangent; the last texture coordinate those of a second set, or an
  /// opacity (as Scene has them).
  void add_tangent(const glm::vec4& tangent);
  void add_second_texcoord(const glm::vec2& texcoord);
  void add_opacity(float opacity);

  /// Adds a polygon. One of fewer than three corners is left out by build(), with a warning; a
  /// corner whose normal or texture coordinate does not exist costs the face all of these. `line`
  /// is for messages: 0 in a file without lines; of an array the row, counted from 1.
  void add_face(std::span<const FileCorner> corners, std::size_t line);
  [[nodiscard]] std::size_t face_count() const { return faces_.size(); }
  /// Gives faces by number, from `begin` to `end`, their material, object and smoothing group; 0
  /// before. Group 0 is flat.
  void assign_faces(std::size_t begin, std::size_t end, std::uint32_t material,
                    std::uint32_t object, std::uint32_t group = 0);

  /// What a file has of vertices.
  struct Counts {
    std::size_t positions = 0, texcoords = 0, normals = 0;

    Counts& operator+=(const Counts& other) {
      positions += other.positions;
      texcoords += other.texcoords;
      normals += other.normals;
      return *this;
    }
  };
  [[nodiscard]] Counts counts() const {
    return {positions_.size(), texcoords_.size(), normals_.size()};
  }
  /// Where the file's earlier parts, which have so many, go to other builders: before all else.
  void begin_after(const Counts& earlier) { earlier_ = earlier; }
  /// Adds what the file's next part gave, whose builder began after this one's counts.
  void append(MeshBuilder&& part);

  /// Recentres the scene with this box, too.
  void expand_extent(const Bounds3& box) {
    others_.expand(box.low);
    others_.expand(box.high);
  }
  /// The file says what is smooth, if only that nothing is.
  void smoothing_is_said() { is_smoothing_said_ = true; }
  /// No face with an area is no error.
  void allow_empty() { may_be_empty_ = true; }

  /// Fills positions, normals, texcoords, triangles and origin, and appends to the warnings.
  /// Throws InputError: an index of nothing, a face without area, no face at all.
  void build(const LoadOptions& options, Scene& scene);
  /// The same where all faces are one object of a default material: a whole scene of one file.
  void build_plain(const LoadOptions& options, Scene& scene);

 private:
  struct Corner {
    std::uint32_t position, texcoord, normal;  // from 0, or kNoIndex
  };
  struct Face {
    std::size_t end;  // of its corners; they begin where the last face's end
    std::size_t line;
    std::uint32_t material = 0, object = 0, group = 0;
  };
  class WarningCount;

  [[nodiscard]] static std::uint32_t resolve(std::int32_t index, std::size_t count);
  /// Throws the InputError of a face; what --strict refuses says so.
  [[noreturn]] void fail(std::size_t line, const std::string& what) const;
  [[noreturn]] void fail_strictly(std::size_t line, const std::string& what) const;
  /// The beginning of messages about the face of this line.
  [[nodiscard]] std::string location(std::size_t line) const;
  void check_indices() const;
  void recentre(Scene& scene);
  [[noreturn]] void fail_far(std::size_t position) const;
  [[nodiscard]] bool was_flat(std::span<const Corner> corners) const;
  [[nodiscard]] glm::vec3 linear_color(std::size_t position, float white) const;
  /// Returns the smoothing groups of the triangles; empty: all are flat.
  [[nodiscard]] std::vector<std::uint32_t> triangulate(const LoadOptions& options,
                                                       Scene& scene) const;

  std::string file_name_;
  Source source_;
  Bounds3 others_;
  bool may_be_empty_ = false, is_smoothing_said_ = false;
  Counts earlier_;
  std::vector<glm::dvec3> positions_;
  std::vector<glm::vec3> colors_;  // of the first positions; kNoColor: white
  std::size_t bad_colors_ = 0;     // that are not finite
  bool has_linear_colors_ = false;
  std::vector<glm::vec3> normals_;
  std::vector<glm::vec4> tangents_;  // of the first normals
  std::vector<glm::vec2> texcoords_;
  std::vector<glm::vec2> second_texcoords_;
  std::vector<float> opacities_;  // of the first texture coordinates
  std::vector<Corner> corners_;
  std::vector<Face> faces_;
};

/// A point to subtract from all others, on a power-of-two grid about as coarse as the box is
/// large: zero for a box near the world's origin; and for a coordinate farther from it than three
/// times the box's extent the subtraction is exact. No result exceeds three times the extent.
[[nodiscard]] glm::dvec3 origin_for_box(const glm::dvec3& low, const glm::dvec3& high);

}  // namespace raygate
