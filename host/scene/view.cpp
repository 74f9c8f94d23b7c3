#include "host/scene/view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>

#include "host/base/elementary.h"
#include "host/base/input_error.h"
#include "host/scene/bounds.h"
#include "host/scene/camera.h"

namespace raygate {
namespace {

Bounds3 bounding_box(const Scene& scene) {
  if (is_empty(scene)) throw InputError("cannot frame a scene without faces");
  return triangle_bounds(scene);
}

/// Corners of a triangle, and its normal with a length of twice its area.
struct Face {
  glm::dvec3 corners[3];
  glm::dvec3 normal;

  explicit Face(const Corners& triangle) {
    for (std::size_t k = 0; k < 3; ++k) corners[k] = triangle[k];
    normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
  }
};

/// Stability of a scene on the lower end of one axis.
struct Stand {
  /// Tangent of the smallest tilt angle at which the scene falls; negative if it falls untilted.
  double steadiness = 0.0;
  double flat_share = 0.0;  ///< fraction of the lower face covered by triangles in it
};

Stand stand(const Scene& scene, const Bounds3& box, const glm::dvec3& centre_of_mass, int axis) {
  constexpr int kDirections = 64;  // directions of falling
  constexpr double kTouching = 0.01;
  const glm::dvec3 size = box.high - box.low;
  const int right = (axis + 1) % 3, ahead = (axis + 2) % 3;
  const double ground = box.low[axis] + kTouching * std::max({size.x, size.y, size.z});
  const double flat = box.low[axis] + kTouching * size[axis];
  std::array<SineCosine<double>, kDirections> directions;
  std::array<double, kDirections> reach;  // extent of the contact points from the centre of mass
  reach.fill(-std::numeric_limits<double>::infinity());
  for (int k = 0; k < kDirections; ++k) {
    directions[k] = sine_cosine(static_cast<double>(k) / kDirections);
  }
  double area = 0.0;
  for_each_face(scene, [&](const Corners& triangle, const Triangle&) {
    const Face face(triangle);
    bool is_flat = true;
    for (const glm::dvec3& corner : face.corners) {
      is_flat = is_flat && corner[axis] <= flat;
      if (corner[axis] > ground) continue;
      const glm::dvec3 way = corner - centre_of_mass;
      for (int k = 0; k < kDirections; ++k) {
        reach[k] =
            std::max(reach[k], way[right] * directions[k].cosine + way[ahead] * directions[k].sine);
      }
    }
    if (is_flat) area += 0.5 * std::abs(face.normal[axis]);
  });
  return {*std::ranges::min_element(reach) / (centre_of_mass[axis] - box.low[axis]),
          std::min(1.0, area / (size[right] * size[ahead]))};
}

/// Returns the centre of mass of the surface, as a thin sheet.
glm::dvec3 centre_of_mass(const Scene& scene) {
  glm::dvec3 sum(0.0);
  double area = 0.0;
  for_each_face(scene, [&](const Corners& triangle, const Triangle&) {
    const Face face(triangle);
    const double weight = glm::length(face.normal);
    sum += weight / 3.0 * (face.corners[0] + face.corners[1] + face.corners[2]);
    area += weight;
  });
  return sum / area;
}

/// The axes of a scene with this up direction: right-handed, of unit length.
struct Axes {
  glm::dvec3 up, front, right;

  explicit Axes(const glm::dvec3& upwards) {
    up = unit(upwards);
    const glm::dvec3 near = std::abs(up.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(0, -1, 0);
    front = glm::normalize(near - glm::dot(near, up) * up);
    right = glm::cross(up, front);
  }

  /// Returns the direction with these angles in degrees, as in View.
  [[nodiscard]] glm::dvec3 direction(double azimuth, double elevation) const {
    const SineCosine<double> turned = sine_cosine(azimuth / 360.0);
    const SineCosine<double> raised = sine_cosine(elevation / 360.0);
    return raised.cosine * (turned.cosine * front + turned.sine * right) + raised.sine * up;
  }
};

}  // namespace

View front_view(const Scene& scene, const glm::dvec3& up) {
  const glm::dvec3 half = bounding_box(scene).half_size(), upright = glm::abs(Axes(up).up);
  const glm::dvec3 across = half * (1.0 - upright);
  const double flatness =
      1.0 - std::min(1.0, glm::dot(half, upright) / std::max({across.x, across.y, across.z}));
  return {0.0, 3.0 + 27.0 * flatness, up};
}

// The enclosed volume is negative if triangles face inwards. A closed box without one of its walls
// has -5/6 of its volume, a sphere turned inside out -0.52.
bool is_interior(const Scene& scene) {
  const Bounds3 box = bounding_box(scene);
  const glm::dvec3 size = box.high - box.low, middle = box.middle();
  double volume = 0.0;
  for_each_face(scene, [&](const Corners& triangle, const Triangle&) {
    const Face face(triangle);
    volume += glm::dot(face.corners[0] - middle, face.normal) / 6.0;
  });
  return volume < -0.6 * size.x * size.y * size.z;
}

View default_view(const Scene& scene, const glm::dvec3& up) {
  if (is_interior(scene)) return front_view(scene, up);
  // For each of the four sides, the fraction of the scene's area that is visible; for a box, half.
  constexpr double kAzimuths[] = {kDefaultAzimuth, -kDefaultAzimuth, 90.0 + kDefaultAzimuth,
                                  -90.0 - kDefaultAzimuth};
  constexpr double kEdgeOn = 0.2;
  double seen[std::size(kAzimuths)] = {}, area = 0.0;
  glm::dvec3 towards_eye[std::size(kAzimuths)];
  for (std::size_t k = 0; k < std::size(kAzimuths); ++k) {
    towards_eye[k] = Axes(up).direction(kAzimuths[k], kDefaultElevation);
  }
  for_each_face(scene, [&](const Corners& triangle, const Triangle&) {
    const Face face(triangle);
    area += glm::length(face.normal);
    for (std::size_t k = 0; k < std::size(kAzimuths); ++k) {
      seen[k] += std::abs(glm::dot(face.normal, towards_eye[k]));
    }
  });
  const bool is_edge_on = seen[0] < kEdgeOn * area;
  const auto best = is_edge_on ? std::ranges::max_element(seen) - seen : 0;
  return {kAzimuths[best], kDefaultElevation, up};
}

glm::dvec3 guess_up_axis(const Scene& scene) {
  if (scene.up) return *scene.up;
  const glm::dvec3 axes[] = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
  const int usual = scene.is_usually_z_up ? 2 : 1, other = 3 - usual;
  const Bounds3 box = bounding_box(scene);
  const glm::dvec3 size = box.high - box.low, mass = centre_of_mass(scene);
  if (std::min({size.x, size.y, size.z}) <= 0.0 || !is_finite(glm::vec3(mass))) return axes[usual];
  constexpr double kFalls = 0.035, kStands = 0.09, kClearly = 0.3;  // tilts of 2 and 5 degrees
  const Stand usually = stand(scene, box, mass, usual), else_ = stand(scene, box, mass, other);
  const bool is_other = (usually.steadiness < kFalls && else_.steadiness > kStands) ||
                        else_.flat_share > usually.flat_share + kClearly;
  return axes[is_other ? other : usual];
}

CameraSetting frame_scene(const Scene& scene, double aspect, double fov, const View& view,
                          FrameFit filling) {
  const Bounds3 box = bounding_box(scene);
  const glm::dvec3 centre = box.middle(), half = box.half_size();
  const Axes axes(view.up);
  const glm::dvec3 towards_eye = axes.direction(view.azimuth, view.elevation);
  constexpr double kSteep = 89.0;  // up is (almost) parallel to the view
  const glm::dvec3 up = std::abs(view.elevation) < kSteep
                            ? axes.up
                            : axes.direction(view.azimuth, view.elevation + 90.0);
  const double size = std::max({half.x, half.y, half.z});
  const Camera at_centre = Camera::look_at(centre + towards_eye * size, centre, up, fov, aspect);

  // The smallest distance at which all points are within the four sides of the view frustum.
  constexpr double kFilled = 0.96;
  const double half_height = at_centre.half_height(), half_width = half_height * aspect;
  double distance = 0.0;
  const auto show = [&](const glm::dvec3& offset) {
    const double nearer = -glm::dot(offset, at_centre.forward());
    const double across = std::abs(glm::dot(offset, at_centre.right())) / half_width;
    const double upwards = std::abs(glm::dot(offset, at_centre.up())) / half_height;
    distance = std::max(distance, std::max(across, upwards) / kFilled + nearer);
  };
  if (filling == FrameFit::kVertices) {
    for_each_face(scene, [&](const Corners& triangle, const Triangle&) {
      for (const glm::vec3& corner : triangle) show(glm::dvec3(corner) - centre);
    });
  } else {
    for (int corner = 0; corner < 8; ++corner) {
      show(half * glm::dvec3(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1));
    }
  }
  return {centre + distance * towards_eye, centre, up, fov};
}

Camera front_camera(const Scene& scene, double aspect, double fov) {
  return Camera::look_at(frame_scene(scene, aspect, fov, front_view(scene), FrameFit::kBox),
                         aspect);
}

void add_ground(Scene& scene, const glm::dvec3& up) {
  if (is_empty(scene)) return;
  const glm::dvec3 upright = unit(up);
  const Bounds3 box = position_bounds(scene);
  double lowest = std::numeric_limits<double>::infinity();
  for_each_position(scene, [&](const glm::vec3& position) {
    lowest = std::min(lowest, glm::dot(glm::dvec3(position), upright));
  });
  // Slightly below the lowest point, so that a floor of the scene hides this one.
  constexpr double kBelow = 0x1p-11, kHalfSide = 16.0;
  const double size = glm::length(box.high - box.low);
  const glm::dvec3 middle = box.middle();
  const glm::dvec3 centre = middle + (lowest - kBelow * size - glm::dot(middle, upright)) * upright;
  const glm::dvec3 across = std::abs(upright.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 v = kHalfSide * size * glm::normalize(glm::cross(across, upright));
  const glm::dvec3 u = glm::cross(v, upright);
  const auto first = static_cast<std::uint32_t>(scene.positions.size());
  for (const glm::dvec3& corner : {-u - v, u - v, u + v, v - u}) {
    const glm::vec3 rounded(centre + corner);
    if (!(largest(rounded) <= kMostCoordinate)) {
      scene.positions.resize(first);
      return;
    }
    scene.positions.push_back(rounded);
  }
  for (const std::uint32_t second : {1u, 2u}) {
    Triangle& triangle = scene.triangles.emplace_back();
    triangle.vertices = {first, first + second, first + second + 1};
    triangle.material = static_cast<std::uint32_t>(scene.materials.size());
    triangle.object = static_cast<std::uint32_t>(scene.objects.size());
  }
  Material& material = scene.materials.emplace_back();
  material.name = "ground";
  material.illumination_model = 10;
  scene.objects.push_back("ground");
}

}  // namespace raygate
