#include "host/scene/io/mesh_builder.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "host/base/input_error.h"
#include "host/base/srgb.h"
#include "host/base/threads.h"
#include "host/exact/exact.h"
#include "host/scene/io/ear_clipper.h"

namespace raygate {

namespace {

constexpr glm::vec3 kNoColor(-1.0f);
/// Marks a corner whose index in the file is out of range.
constexpr std::uint32_t kBadIndex = kNoIndex - 1;
constexpr std::size_t kCheckpointFaces = 4096;

}  // namespace

// Counts occurrences of a frequent problem, for one warning with its first line.
class MeshBuilder::WarningCount {
 public:
  void note(std::size_t line) {
    if (count_++ == 0) first_line_ = line;
  }
  void report(const MeshBuilder& mesh, const std::string& what, Scene& scene) const {
    if (count_ == 0) return;
    scene.warnings.push_back(mesh.location(first_line_) + what +
                             (count_ > 1 ? ", here and in " + std::to_string(count_ - 1) +
                                               " later face" + (count_ > 2 ? "s" : "")
                                         : ""));
  }

 private:
  std::size_t count_ = 0;
  std::size_t first_line_ = 0;
};

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
    // + 0.0 avoids a negative zero. Beyond 2^53 steps the centre is already on the grid, and the
    // quotient may overflow.
    origin[axis] = std::abs(steps) < 0x1p53 ? steps * step + 0.0 : centre[axis];
  }
  return origin;
}

void MeshBuilder::add_color(const glm::vec3& color) {
  colors_.resize(positions_.size() - 1, kNoColor);
  if (!is_finite(color)) ++bad_colors_;
  colors_.push_back(is_finite(color) ? glm::max(color, glm::vec3(0.0f)) : kNoColor);
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

void MeshBuilder::add_tangent(const glm::vec4& tangent) {
  tangents_.resize(normals_.size() - 1, glm::vec4(0.0f));
  tangents_.push_back(tangent);
}

void MeshBuilder::add_second_texcoord(const glm::vec2& texcoord) {
  second_texcoords_.resize(texcoords_.size() - 1, glm::vec2(0.0f));
  second_texcoords_.push_back(texcoord);
}

void MeshBuilder::add_opacity(float opacity) {
  opacities_.resize(texcoords_.size() - 1, 1.0f);
  opacities_.push_back(opacity);
}

std::uint32_t MeshBuilder::resolve(std::int32_t index, std::size_t count, std::size_t field) {
  if (index == 0) return kNoIndex;
  if (index > 0) return static_cast<std::uint32_t>(index - 1);
  const std::ptrdiff_t from_start = static_cast<std::ptrdiff_t>(count) + index;
  if (is_relative_) {
    relative_.push_back(3 * corners_.size() + field);
    if (field == 0) first_position_ = std::min(first_position_, from_start);
  } else if (from_start < 0) {
    return kBadIndex;
  }
  return static_cast<std::uint32_t>(from_start);
}

void MeshBuilder::add_face(std::span<const FileCorner> corners, std::size_t line) {
  if (faces_.size() % kCheckpointFaces == 0) checkpoint();
  for (const FileCorner& corner : corners) {
    const std::size_t vertices = earlier_.positions + positions_.size();
    const std::uint32_t position = resolve(corner.position, vertices, 0);
    if (position == kBadIndex) {
      fail(line, "vertex index " + std::to_string(corner.position) +
                     " in a face, but the file has " + std::to_string(vertices) + " so far");
    }
    corners_.push_back({position,
                        resolve(corner.texcoord, earlier_.texcoords + texcoords_.size(), 1),
                        resolve(corner.normal, earlier_.normals + normals_.size(), 2)});
  }
  faces_.push_back({corners_.size(), line});
}

void MeshBuilder::assign_faces(std::size_t begin, std::size_t end, std::uint32_t material,
                               std::uint32_t object, std::uint32_t group) {
  for (std::size_t i = begin; i < end; ++i) {
    faces_[i].material = material;
    faces_[i].object = object;
    faces_[i].group = group;
  }
}

void MeshBuilder::append(MeshBuilder&& part, std::size_t line) {
  const std::size_t earlier[] = {positions_.size(), texcoords_.size(), normals_.size()};
  for (const std::size_t slot : part.relative_) {
    std::uint32_t& index = part.corners_[slot / 3].*kFields[slot % 3];
    const std::ptrdiff_t in_file =
        static_cast<std::int32_t>(index) + static_cast<std::ptrdiff_t>(earlier[slot % 3]);
    index = in_file < 0 ? kBadIndex : static_cast<std::uint32_t>(in_file);
  }
  const auto add = [](auto& all, auto& more) {
    if (all.empty()) {
      all = std::move(more);
    } else {
      all.insert(all.end(), more.begin(), more.end());
    }
  };
  const std::size_t corners = corners_.size();
  bad_colors_ += part.bad_colors_;
  for (Face& face : part.faces_) {
    face.end += corners;
    face.line += line;
  }
  if (!part.colors_.empty()) colors_.resize(positions_.size(), kNoColor);
  add(colors_, part.colors_);
  add(positions_, part.positions_);
  add(normals_, part.normals_);
  add(texcoords_, part.texcoords_);
  add(corners_, part.corners_);
  add(faces_, part.faces_);
}

std::string MeshBuilder::location(std::size_t line) const {
  if (source_ == Source::kFile) return InputError::location(file_name_, line);
  return file_name_ + "[" + std::to_string(line - 1) + "]: ";
}

void MeshBuilder::fail(std::size_t line, const std::string& what) const {
  throw InputError(location(line) + what);
}

void MeshBuilder::fail_strictly(std::size_t line, const std::string& what) const {
  fail(line, what + (source_ == Source::kFile ? ", as --strict asks" : ", as strict=True asks"));
}

void MeshBuilder::check_indices() const {
  std::size_t i = 0;
  for (const Face& face : faces_) {
    for (; i < face.end; ++i) {
      if (corners_[i].position < positions_.size()) continue;
      fail(face.line, "vertex index " + std::to_string(corners_[i].position + std::uint64_t{1}) +
                          " in a face, but the file has " + std::to_string(positions_.size()));
    }
  }
}

void MeshBuilder::fail_far(std::size_t position) const {
  std::size_t i = 0;
  while (corners_[i].position != position) ++i;
  const auto face = std::ranges::upper_bound(faces_, i, {}, &Face::end);
  fail(face->line,
       "found a corner farther than 2^126 from the scene's middle, expected a nearer one");
}

// Keeps the positions that a face uses, relative to the origin, and renumbers the corners.
void MeshBuilder::recentre(Scene& scene) {
  std::vector<std::uint32_t> new_index(positions_.size(), kNoIndex);
  for (const Corner& corner : corners_) new_index[corner.position] = 0;
  Bounds3 box = others_;
  std::uint32_t used = 0;
  for (std::size_t i = 0; i < positions_.size(); ++i) {
    if (new_index[i] == kNoIndex) continue;
    new_index[i] = used++;
    box.expand(positions_[i]);
  }
  scene.origin = box.is_empty() ? glm::dvec3(0.0) : origin_for_box(box.low, box.high);
  scene.positions.resize(used);
  scene.colors.resize(colors_.empty() ? 0 : used);
  const bool is_bytes = std::ranges::any_of(colors_, [](const glm::vec3& color) {
    return glm::any(glm::greaterThan(color, glm::vec3(1.0f)));
  });
  for (std::size_t i = 0; i < positions_.size(); ++i) {
    if (new_index[i] == kNoIndex) continue;
    if (!(largest(positions_[i] - scene.origin) <= kMostCoordinate)) fail_far(i);
    const auto [position, error] = recentred(positions_[i], scene.origin);
    scene.positions[new_index[i]] = position;
    scene.rounding.add({error != 0.0, error});
    positions_[new_index[i]] = positions_[i];
    if (!colors_.empty()) scene.colors[new_index[i]] = linear_color(i, is_bytes ? 255.0f : 1.0f);
  }
  for (Corner& corner : corners_) corner.position = new_index[corner.position];
}

// Returns whether a polygon has no area in its file, up to the rounding of decimals to double.
bool MeshBuilder::was_flat(std::span<const Corner> corners) const {
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

std::vector<std::uint32_t> MeshBuilder::triangulate(const LoadOptions& options,
                                                    Scene& scene) const {
  std::vector<std::uint32_t> groups;
  EarClipper clipper;
  std::vector<glm::vec3> polygon;
  WarningCount dropped, flattened, moved, too_short, touching, no_direction, no_normal, no_texcoord;
  const auto has_all = [](std::span<const Corner> corners, std::uint32_t Corner::*index,
                          std::size_t count) {
    return std::ranges::all_of(corners, [&](const Corner& c) { return c.*index < count; });
  };
  const auto has_none = [](std::span<const Corner> corners, std::uint32_t Corner::*index) {
    return std::ranges::all_of(corners, [&](const Corner& c) { return c.*index == kNoIndex; });
  };
  scene.triangles.reserve(std::max(corners_.size(), 2 * faces_.size()) - 2 * faces_.size());
  std::size_t begin = 0;
  for (const Face& face : faces_) {
    const std::span<const Corner> corners(corners_.data() + begin, face.end - begin);
    begin = face.end;
    if (scene.triangles.size() % kCheckpointFaces == 0) checkpoint();
    if (corners.size() < 3) {
      if (options.strict) {
        fail_strictly(face.line, "face with " + std::to_string(corners.size()) +
                                     " corners, expected at least 3");
      }
      too_short.note(face.line);
      continue;
    }
    polygon.clear();
    for (const Corner& corner : corners) polygon.push_back(scene.positions[corner.position]);

    static constexpr std::array<std::uint32_t, 3> kWhole{0, 1, 2};
    std::span<const std::array<std::uint32_t, 3>> pieces(&kWhole, 1);
    PolygonKind kind = PolygonKind::kSimple;
    if (polygon.size() > 3) {
      kind = clipper.cut(polygon);
      pieces = clipper.triangles();
    } else if (collinear(polygon[0], polygon[1], polygon[2])) {
      kind = PolygonKind::kZeroArea;
    }
    if (kind == PolygonKind::kZeroArea) {
      const bool is_flat = was_flat(corners);
      if (options.strict) {
        fail_strictly(face.line,
                      is_flat
                          ? "face of zero area (its corners are on one line, or cancel out), "
                            "expected one with an area"
                          : "face flattened by rounding to binary32, expected one with an area");
      }
      (is_flat ? dropped : flattened).note(face.line);
      Triangle left_out{.material = face.material, .object = face.object};
      left_out.vertices.fill(corners[0].position);
      scene.triangles.insert(scene.triangles.end(), corners.size() - 2, left_out);
      continue;
    }
    if (kind == PolygonKind::kSelfTouching) touching.note(face.line);
    double error = 0.0, size = 0.0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      error = std::max(error, recentred(positions_[corners[i].position], scene.origin).error);
      size = std::max(size, largest(glm::dvec3(polygon[i]) - glm::dvec3(polygon[0])));
    }
    if (error > 0.01 * size) moved.note(face.line);

    bool has_normals = has_all(corners, &Corner::normal, normals_.size());
    if (!has_normals && !has_none(corners, &Corner::normal)) no_normal.note(face.line);
    if (has_normals && std::ranges::any_of(corners, [&](const Corner& corner) {
          return normals_[corner.normal] == glm::vec3(0.0f);
        })) {
      no_direction.note(face.line);
      has_normals = false;
    }
    const bool has_texcoords = has_all(corners, &Corner::texcoord, texcoords_.size()) &&
                               std::ranges::all_of(corners, [&](const Corner& corner) {
                                 return is_finite(glm::vec3(texcoords_[corner.texcoord], 0.0f));
                               });
    if (!has_texcoords && !has_none(corners, &Corner::texcoord)) no_texcoord.note(face.line);
    for (const auto& piece : pieces) {
      Triangle& triangle = scene.triangles.emplace_back();
      triangle.material = face.material;
      triangle.object = face.object;
      if (face.group != 0 || !groups.empty()) {
        groups.resize(scene.triangles.size() - 1);
        groups.push_back(face.group);
      }
      for (int i = 0; i < 3; ++i) {
        const Corner& corner = corners[piece[i]];
        triangle.vertices[i] = corner.position;
        if (has_texcoords) triangle.texcoords[i] = corner.texcoord;
        if (has_normals) triangle.normals[i] = corner.normal;
      }
    }
  }
  dropped.report(*this, "face of zero area, left out", scene);
  too_short.report(*this, "face of fewer than 3 corners, left out", scene);
  flattened.report(*this, "face flattened by rounding to binary32, left out", scene);
  char most[32];
  std::snprintf(most, sizeof most, "%.3g", scene.rounding.most);
  moved.report(*this,
               std::string("corners moved by up to ") + most +
                   ", more than a hundredth of their face, by rounding to binary32",
               scene);
  touching.report(*this, "polygon crosses or touches itself, cut as well as can be", scene);
  no_direction.report(*this, "normal without a direction, the face is taken as flat", scene);
  no_normal.report(*this, "face corner without a normal, the face is taken as flat", scene);
  no_texcoord.report(*this, "face corner without texture coordinates, the face has no texture",
                     scene);
  return groups;
}

void MeshBuilder::build(const LoadOptions& options, Scene& scene) {
  if (faces_.empty() && !may_be_empty_) {
    throw InputError(file_name_ + ": no faces, expected at least one polygon");
  }
  check_indices();
  if (bad_colors_ > 0) {
    scene.warnings.push_back(file_name_ + ": " + std::to_string(bad_colors_) +
                             " colours of vertices that are not finite numbers, taken as white");
  }
  recentre(scene);
  const std::vector<std::uint32_t> groups = triangulate(options, scene);
  if (is_empty(scene) && !may_be_empty_) {
    fail(faces_.empty() ? 0 : faces_[0].line, "no face has an area");
  }
  scene.normals = std::move(normals_);
  scene.tangents = std::move(tangents_);
  scene.texcoords = std::move(texcoords_);
  scene.second_texcoords = std::move(second_texcoords_);
  scene.opacities = std::move(opacities_);
  if (options.smooth || !groups.empty()) {
    add_smooth_normals(groups, options.smooth, scene);
  } else if (options.smooth_if_unsaid && !is_smoothing_said_ && scene.normals.empty()) {
    add_smooth_normals(groups, LoadOptions::kSmoothAngle, scene, FlatFaces::kStayFlat);
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
