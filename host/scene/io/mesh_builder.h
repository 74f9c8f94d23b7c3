// MeshBuilder: collects the vertices and polygons of a file and builds a scene of triangles.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "host/scene/bounds.h"
#include "host/scene/io/scene_loader.h"

namespace raygate {

/// One corner of a polygon: indices into the builder's positions, texture coordinates and normals,
/// whose elements may be added later. kNoIndex stands for none.
struct FaceCorner {
  std::uint32_t position = 0, texcoord = kNoIndex, normal = kNoIndex;
};

struct FaceAttributes {
  std::uint32_t material = 0, object = 0;
  std::uint32_t group = 0;  ///< smoothing group; 0: flat
};

/// Collects vertices and polygons in the file's order and builds the scene at the end, when the
/// bounds (to recentre) and the number of vertices (which may follow their faces) are known.
class MeshBuilder {
 public:
  /// Origin of faces, for messages: "scene.obj:12: ..." or, for an array, "faces[12]: ...".
  enum class Source { kFile, kArray };

  explicit MeshBuilder(std::string file_name, Source source = Source::kFile)
      : file_name_(std::move(file_name)), source_(source) {}

  [[nodiscard]] const std::string& file_name() const { return file_name_; }

  void add_position(const glm::dvec3& position) { positions_.push_back(position); }
  /// Sets the colour of the last position: sRGB codes from 0 to 1, or from 0 to 255 if any colour
  /// of the file exceeds 1. After colors_are_linear(), colours are scene-linear RGB.
  void add_color(const glm::vec3& color);
  void colors_are_linear() { has_linear_colors_ = true; }
  void add_texcoord(const glm::vec2& texcoord) { texcoords_.push_back(texcoord); }
  /// Set the second coordinates and the opacity, in [0, 1], of the last texture coordinates.
  void add_second_texcoord(const glm::vec2& texcoord) {
    set_last(second_texcoords_, texcoords_.size(), texcoord, glm::vec2(0.0f));
  }
  void add_opacity(float opacity) { set_last(opacities_, texcoords_.size(), opacity, 1.0f); }
  void add_normal(const glm::dvec3& normal);
  /// Sets the tangent of the last normal, in the format of Scene::tangents.
  void add_tangent(const glm::vec4& tangent) {
    set_last(tangents_, normals_.size(), tangent, glm::vec4(0.0f));
  }

  /// Adds a polygon. build() leaves out, with a warning, polygons of fewer than three corners, and
  /// normals or texture coordinates that a face does not have at all corners. `line` is for
  /// messages: 0 in a file without lines; in an array, the row, counted from 1.
  void add_face(std::span<const FaceCorner> corners, std::size_t line,
                const FaceAttributes& attributes = {});
  [[nodiscard]] std::size_t face_count() const { return faces_.size(); }

  /// Numbers of positions, texture coordinates and normals.
  struct Counts {
    std::size_t positions = 0, texcoords = 0, normals = 0;
  };
  [[nodiscard]] Counts counts() const {
    return {positions_.size(), texcoords_.size(), normals_.size()};
  }

  /// Includes this box in the bounds by which the scene is recentred.
  void expand_extent(const Bounds3& box) {
    others_.expand(box.low);
    others_.expand(box.high);
  }
  /// Makes build() accept a scene in which no face has an area.
  void allow_empty() { may_be_empty_ = true; }

  /// Sets the scene's vertices, triangles and origin, and appends to its warnings. Throws
  /// InputError for an index out of range, and if there is no face with an area.
  void build(const LoadOptions& options, Scene& scene);
  /// Builds a scene in which all faces belong to one object of a default material.
  void build_plain(const LoadOptions& options, Scene& scene);

 private:
  struct Face {
    std::size_t end;  // end of its corners_; they begin at the previous face's end
    std::size_t line;
    FaceAttributes attributes;
  };

  /// Returns the prefix of messages about the face on this line.
  [[nodiscard]] std::string location(std::size_t line) const;
  /// Throws InputError with the location of the face that has this corner.
  [[noreturn]] void fail(std::vector<FaceCorner>::const_iterator corner,
                         const std::string& what) const;
  void recentre(Scene& scene);
  /// Sets the scene's positions to the builder's, relative to this origin.
  void place(const glm::dvec3& origin, bool keeps_rests, Scene& scene) const;
  [[nodiscard]] glm::vec3 linear_color(std::size_t position, float white) const;
  /// Returns whether a face has no area in the file's own numbers, before they are rounded.
  [[nodiscard]] bool was_flat(std::span<const FaceCorner> corners) const;
  /// Adds the triangles and returns their smoothing groups; empty: all are flat. With `gives_up`,
  /// returns nullopt if rounding to binary32 moves a corner too far (Vertices::kAsPictures).
  [[nodiscard]] std::optional<std::vector<std::uint32_t>> triangulate(Scene& scene,
                                                                      bool gives_up) const;

  std::string file_name_;
  Source source_;
  Bounds3 others_;
  bool may_be_empty_ = false;
  std::vector<glm::dvec3> positions_;
  std::vector<glm::vec3> colors_;  // of the first positions; kNoColor: white
  std::size_t bad_colors_ = 0;     // number of colours that are not finite
  bool has_linear_colors_ = false;
  std::vector<glm::vec3> normals_;
  std::vector<glm::vec4> tangents_;  // of the first normals
  std::vector<glm::vec2> texcoords_;
  std::vector<glm::vec2> second_texcoords_;  // of the first texture coordinates
  std::vector<float> opacities_;             // of the first texture coordinates
  std::vector<FaceCorner> corners_;
  std::vector<Face> faces_;
};

/// Returns the origin to subtract from all positions of a scene with these bounds: a point on a
/// grid whose step is a power of two about the box's size. The result is 0 for a box near the
/// world's origin. The subtraction is exact for coordinates that exceed three times the box's
/// extent, and no difference exceeds three times the extent.
[[nodiscard]] glm::dvec3 origin_for_box(const glm::dvec3& low, const glm::dvec3& high);

/// Sets the normals of triangles that have no normals and at least one smooth edge. The normal at a
/// corner is the weighted mean over the triangles that are connected there by smooth edges (weights
/// of N. Max, "Weights for computing vertex normals from facet normals", Journal of Graphics Tools
/// 4 (2), 1999; exact on spheres). An edge is smooth if exactly two triangles without normals share
/// it, with equal positions and in opposite directions, and
/// * the angle between their planes is at most `angle`, in degrees up to 180, if that is given;
/// * otherwise they have the same group in `groups`, other than 0.
void add_smooth_normals(std::span<const std::uint32_t> groups, std::optional<double> angle,
                        Scene& scene);

}  // namespace raygate
