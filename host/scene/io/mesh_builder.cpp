#include "host/scene/io/mesh_builder.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "host/base/elementary.h"
#include "host/base/input_error.h"
#include "host/base/threads.h"
#include "host/exact/exact.h"
#include "host/scene/io/ear_clipper.h"

namespace raygate {
namespace {

constexpr std::size_t kSpare = 64;  // capacity for area lights and the ground
constexpr glm::vec3 kNoColor(-1.0f);
constexpr std::size_t kCheckpointFaces = 4096;

/// A kind of flaw. One warning gives the number of faces with the flaw and the first face's line.
struct Flaw {
  std::string text;
  std::size_t count = 0, first_line = 0;

  void note(std::size_t line) {
    if (count++ == 0) first_line = line;
  }
};

}  // namespace

glm::dvec3 origin_for_box(const glm::dvec3& low, const glm::dvec3& high) {
  const glm::dvec3 half = 0.5 * high - 0.5 * low;
  const double radius = std::max({half.x, half.y, half.z});
  if (radius == 0.0) return low;
  // The least power of two that is at least 4 radius.
  int exponent = 0;
  const double part = std::frexp(4.0 * radius, &exponent);
  const double step = std::ldexp(1.0, part == 0.5 ? exponent - 1 : exponent);
  const glm::dvec3 centre = 0.5 * high + 0.5 * low;
  glm::dvec3 origin;
  for (int axis = 0; axis < 3; ++axis) {
    const double steps = std::nearbyint(centre[axis] / step);
    // + 0.0 avoids a negative zero. Beyond 2^53 steps the centre is already on the grid.
    origin[axis] = std::abs(steps) < 0x1p53 ? steps * step + 0.0 : centre[axis];
  }
  return origin;
}

void MeshBuilder::add_color(const glm::vec3& color) {
  if (!is_finite(color)) ++bad_colors_;
  set_last(colors_, positions_.size(),
           is_finite(color) ? glm::max(color, glm::vec3(0.0f)) : kNoColor, kNoColor);
}

glm::vec3 MeshBuilder::linear_color(std::size_t position, float white) const {
  if (position >= colors_.size() || colors_[position] == kNoColor) return glm::vec3(1.0f);
  glm::vec3 color = colors_[position];
  if (has_linear_colors_) return color;
  for (int k = 0; k < 3; ++k) {
    color[k] = static_cast<float>(srgb_to_linear(255.0 * double{color[k]} / double{white}));
  }
  return color;
}

void MeshBuilder::add_normal(const glm::dvec3& normal) {
  const bool has_direction = is_finite(normal) && normal != glm::dvec3(0.0);
  normals_.push_back(has_direction ? glm::vec3(unit(normal)) : glm::vec3(0.0f));
}

void MeshBuilder::add_face(std::span<const FaceCorner> corners, std::size_t line,
                           const FaceAttributes& attributes) {
  if (faces_.size() % kCheckpointFaces == 0) checkpoint();
  corners_.insert(corners_.end(), corners.begin(), corners.end());
  faces_.push_back({corners_.size(), line, attributes});
}

std::string MeshBuilder::location(std::size_t line) const {
  if (source_ == Source::kFile) return InputError::location(file_name_, line);
  return file_name_ + "[" + std::to_string(line - 1) + "]: ";
}

void MeshBuilder::fail(std::vector<FaceCorner>::const_iterator corner,
                       const std::string& what) const {
  const auto number = static_cast<std::size_t>(corner - corners_.begin());
  throw InputError(location(std::ranges::upper_bound(faces_, number, {}, &Face::end)->line) + what);
}

// Keeps the positions that faces use, relative to the origin, and renumbers the corners.
void MeshBuilder::recentre(Scene& scene) {
  std::vector<std::uint32_t> new_index(positions_.size(), kNoIndex);
  for (const FaceCorner& corner : corners_) new_index[corner.position] = 0;
  const bool is_bytes = std::ranges::any_of(colors_, [](const glm::vec3& color) {
    return glm::any(glm::greaterThan(color, glm::vec3(1.0f)));
  });
  Bounds3 box = others_;
  std::uint32_t used = 0;
  for (std::size_t i = 0; i < positions_.size(); ++i) {
    if (new_index[i] == kNoIndex) continue;
    if (!colors_.empty()) scene.colors.push_back(linear_color(i, is_bytes ? 255.0f : 1.0f));
    box.expand(positions_[i]);
    positions_[used] = positions_[i];
    new_index[i] = used++;
  }
  positions_.resize(used);
  for (FaceCorner& corner : corners_) corner.position = new_index[corner.position];

  const glm::dvec3 origin = box.is_empty() ? glm::dvec3(0.0) : origin_for_box(box.low, box.high);
  const auto far = std::ranges::find_if(positions_, [&](const glm::dvec3& position) {
    return !(largest(position - origin) <= kMostCoordinate);
  });
  if (far != positions_.end()) {
    const auto index = static_cast<std::uint32_t>(far - positions_.begin());
    fail(std::ranges::find(corners_, index, &FaceCorner::position),
         "found a corner farther than 2^126 from the scene's middle, expected a nearer one");
  }
  place(origin, false, scene);
}

void MeshBuilder::place(const glm::dvec3& origin, bool keeps_rests, Scene& scene) const {
  scene.origin = origin;
  scene.rounding = {};
  scene.positions.clear();
  scene.positions.reserve(positions_.size() + kSpare);
  scene.rests.reserve(positions_.size() + kSpare);
  for (std::uint32_t i = 0; i < positions_.size(); ++i) {
    double error = scene.add_vertex(positions_[i]);
    if (!keeps_rests) error += largest(glm::dvec3(scene.positions[i]) - scene.vertex(i));
    scene.rounding.add({error != 0.0, error});
  }
  if (!keeps_rests) scene.rests = {};
  scene.drop_zero_rests();
}

// Returns whether a polygon has no area in the file, up to the rounding of decimals to double.
bool MeshBuilder::was_flat(std::span<const FaceCorner> corners) const {
  const glm::dvec3& first = positions_[corners[0].position];
  glm::dvec3 area(0.0), size(0.0), reach = glm::abs(first);
  for (std::size_t i = 1; i < corners.size(); ++i) {
    const glm::dvec3 &p = positions_[corners[i - 1].position], &q = positions_[corners[i].position];
    area += glm::cross(p - first, q - first);
    size = glm::max(size, glm::abs(q - first));
    reach = glm::max(reach, glm::abs(q));
  }
  const auto products = [](const glm::dvec3& a, const glm::dvec3& b) {
    return glm::dvec3(a.y * b.z, a.z * b.x, a.x * b.y);
  };
  const glm::dvec3 bound = products(reach, size) + products(size, reach);
  return glm::all(
      glm::lessThanEqual(glm::abs(area), 0x1p-50 * static_cast<double>(corners.size()) * bound));
}

std::optional<std::vector<std::uint32_t>> MeshBuilder::triangulate(Scene& scene,
                                                                   bool gives_up) const {
  char most[32];
  std::snprintf(most, sizeof most, "%.3g", scene.rounding.most);
  Flaw no_area{"face of zero area, left out"},
      flattened{"face flattened by rounding to binary32, left out"},
      too_short{"face of fewer than 3 corners, left out"},
      moved{std::string("corners moved by up to ") + most +
            ", more than a hundredth of their face, by rounding to binary32"},
      touching{"polygon crosses or touches itself, cut as well as can be"},
      no_direction{"normal without a direction, the face is taken as flat"},
      no_normal{"face corner without a normal, the face is taken as flat"},
      no_texcoord{"face corner without texture coordinates, the face has no texture"};
  std::vector<std::uint32_t> groups;
  EarClipper clipper;
  std::vector<glm::dvec3> polygon;
  scene.triangles.reserve(std::max(corners_.size(), 2 * faces_.size()) - 2 * faces_.size() +
                          kSpare);
  std::size_t begin = 0;
  for (const Face& face : faces_) {
    const std::span<const FaceCorner> corners(corners_.data() + begin, face.end - begin);
    begin = face.end;
    if (scene.triangles.size() % kCheckpointFaces == 0) checkpoint();
    if (corners.size() < 3) {
      too_short.note(face.line);
      continue;
    }
    polygon.clear();
    double error = 0.0, size = 0.0;
    for (const FaceCorner& corner : corners) {
      polygon.push_back(scene.vertex(corner.position));
      if (scene.rounding.corners == 0) continue;
      const glm::dvec3& given = positions_[corner.position];
      error = std::max(error, largest(polygon.back() - (given - scene.origin)));
      size = std::max(size, largest(given - positions_[corners[0].position]));
    }
    const bool is_moved = error > 0.01 * size;

    static constexpr EarClipper::Triangle kWhole{0, 1, 2};
    std::span<const EarClipper::Triangle> pieces(&kWhole, 1);
    PolygonKind kind = PolygonKind::kSimple;
    if (polygon.size() > 3) {
      kind = clipper.cut(polygon);
      pieces = clipper.triangles();
    } else if (triangle_normal({polygon[0], polygon[1], polygon[2]}) == glm::dvec3(0.0)) {
      kind = PolygonKind::kZeroArea;
    }
    Triangle whole{.material = face.attributes.material, .object = face.attributes.object};
    if (kind == PolygonKind::kZeroArea) {
      const bool is_flattened = !was_flat(corners);
      if (is_flattened && is_moved && gives_up) return std::nullopt;
      (is_flattened ? flattened : no_area).note(face.line);
      whole.vertices.fill(corners[0].position);
      scene.triangles.insert(scene.triangles.end(), corners.size() - 2, whole);
      continue;
    }
    if (is_moved && gives_up) return std::nullopt;
    if (kind == PolygonKind::kSelfTouching) touching.note(face.line);
    if (is_moved) moved.note(face.line);

    // A face has normals or texture coordinates if all of its corners have valid ones.
    bool has_normals = true, has_texcoords = true, has_direction = true;
    bool names_normal = false, names_texcoord = false;
    for (const FaceCorner& corner : corners) {
      names_normal |= corner.normal != kNoIndex;
      names_texcoord |= corner.texcoord != kNoIndex;
      has_normals &= corner.normal < normals_.size();
      has_direction &= !has_normals || normals_[corner.normal] != glm::vec3(0.0f);
      has_texcoords &= corner.texcoord < texcoords_.size() &&
                       is_finite(glm::vec3(texcoords_[corner.texcoord], 0.0f));
    }
    if (names_normal && !has_normals) no_normal.note(face.line);
    if (has_normals && !has_direction) no_direction.note(face.line);
    if (names_texcoord && !has_texcoords) no_texcoord.note(face.line);
    for (const EarClipper::Triangle& piece : pieces) {
      Triangle& triangle = scene.triangles.emplace_back(whole);
      if (face.attributes.group != 0 || !groups.empty()) {
        set_last(groups, scene.triangles.size(), face.attributes.group, 0u);
      }
      for (int i = 0; i < 3; ++i) {
        const FaceCorner& corner = corners[piece[i]];
        triangle.vertices[i] = corner.position;
        if (has_texcoords) triangle.texcoords[i] = corner.texcoord;
        if (has_normals && has_direction) triangle.normals[i] = corner.normal;
      }
    }
  }
  for (const Flaw* flaw : {&no_area, &flattened, &too_short, &moved, &touching, &no_direction,
                           &no_normal, &no_texcoord}) {
    if (flaw->count == 0) continue;
    std::string text = location(flaw->first_line) + flaw->text;
    if (const std::size_t more = flaw->count - 1; more > 0) {
      text += ", here and in " + std::to_string(more) + " later face" + (more > 1 ? "s" : "");
    }
    scene.warnings.push_back(text);
  }
  return groups;
}

void MeshBuilder::build(const LoadOptions& options, Scene& scene) {
  if (faces_.empty() && !may_be_empty_) {
    throw InputError(file_name_ + ": no faces, expected at least one polygon");
  }
  const auto bad = std::ranges::find_if(
      corners_, [&](const FaceCorner& corner) { return corner.position >= positions_.size(); });
  if (bad != corners_.end()) {
    fail(bad, "vertex index " + std::to_string(bad->position + std::uint64_t{1}) +
                  " in a face, but the file has " + std::to_string(positions_.size()));
  }
  if (bad_colors_ > 0) {
    scene.warnings.push_back(file_name_ + ": " + std::to_string(bad_colors_) +
                             " colours of vertices that are not finite numbers, taken as white");
  }
  recentre(scene);
  if (options.vertices == Vertices::kBinary64 && scene.rounding.corners > 0) {
    place(exact_origin(positions_), true, scene);
  }
  auto groups = triangulate(scene, options.vertices == Vertices::kAsPictures);
  if (!groups) {
    place(exact_origin(positions_), true, scene);
    scene.triangles.clear();
    groups = triangulate(scene, false);
  }
  if (is_empty(scene) && !may_be_empty_) {
    throw InputError(location(faces_.empty() ? 0 : faces_[0].line) + "no face has an area");
  }
  scene.normals = std::move(normals_);
  scene.tangents = std::move(tangents_);
  scene.texcoords = std::move(texcoords_);
  scene.second_texcoords = std::move(second_texcoords_);
  scene.opacities = std::move(opacities_);
  if (options.smooth || !groups->empty()) {
    add_smooth_normals(*groups, options.smooth, scene);
  }
}

void MeshBuilder::build_plain(const LoadOptions& options, Scene& scene) {
  build(options, scene);
  Material& material = scene.materials.emplace_back();
  material.name = "default";
  if (!scene.colors.empty()) material.diffuse = glm::vec3(1.0f);
  scene.objects = {"default"};
  scene.files = {file_name_};
}

}  // namespace raygate
