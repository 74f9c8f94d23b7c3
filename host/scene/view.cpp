#include "host/scene/view.h"

#include <algorithm>
#include <cmath>
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

/// Twice the area of a triangle as a vector along its normal; its corners.
struct Face {
  glm::dvec3 corners[3];
  glm::dvec3 normal;

  explicit Face(const Corners& triangle) {
    for (std::size_t k = 0; k < 3; ++k) corners[k] = triangle[k];
    normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
  }
};

/// The share of the box's lower end along `axis` that faces lying flat on it cover.
double standing(const Scene& scene, const Bounds3& box, int axis) {
  const glm::dvec3 size = box.high - box.low;
  const double end = box.low[axis] + 0.01 * size[axis];
  double area = 0.0;
  for_each_face(scene, [&](const Corners& triangle, const Triangle&) {
    const Face face(triangle);
    const bool is_low = std::ranges::all_of(
        face.corners, [&](const glm::dvec3& corner) { return corner[axis] <= end; });
    if (is_low) area += 0.5 * std::abs(face.normal[axis]);
  });
  const double whole = size[(axis + 1) % 3] * size[(axis + 2) % 3];
  return whole > 0.0 ? std::min(1.0, area / whole) : 0.0;
}

/// Of a scene whose up is `up`: right-handed, of length 1.
struct Axes {
  glm::dvec3 up, front, right;

  explicit Axes(const glm::dvec3& upwards) {
    up = unit(upwards);
    const glm::dvec3 near = std::abs(up.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(0, -1, 0);
    front = glm::normalize(near - glm::dot(near, up) * up);
    right = glm::cross(up, front);
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

// The volume that faces enclose is negative where they look inwards. A closed box without one of
// its walls has -5/6 of its volume, a ball turned inside out -0.52.
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
  return {kDefaultAzimuth, kDefaultElevation, up};
}

glm::dvec3 guess_up_axis(const Scene& scene) {
  if (scene.up) return *scene.up;
  const Bounds3 box = bounding_box(scene);
  constexpr double kClearly = 0.2;
  const bool is_z = standing(scene, box, 2) > standing(scene, box, 1) + kClearly;
  return is_z ? glm::dvec3(0.0, 0.0, 1.0) : glm::dvec3(0.0, 1.0, 0.0);
}

CameraSetting frame_scene(const Scene& scene, double aspect, double fov, const View& view,
                          FrameFit filling) {
  const Bounds3 box = bounding_box(scene);
  const glm::dvec3 centre = box.middle(), half = box.half_size();
  const Axes axes(view.up);
  const SineCosine<double> turned = sine_cosine(view.azimuth / 360.0);
  const SineCosine<double> raised = sine_cosine(view.elevation / 360.0);
  const glm::dvec3 level = turned.cosine * axes.front + turned.sine * axes.right;
  const glm::dvec3 towards_eye = raised.cosine * level + raised.sine * axes.up;
  constexpr double kSteep = 89.0;  // up is along the view, or nearly
  const glm::dvec3 up = std::abs(view.elevation) < kSteep
                            ? axes.up
                            : glm::dvec3(raised.cosine * axes.up - raised.sine * level);
  const double size = std::max({half.x, half.y, half.z});
  const Camera at_centre = Camera::look_at(centre + towards_eye * size, centre, up, fov, aspect);

  // The least distance at which all points are within the four sides of the view.
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
  } else if (filling == FrameFit::kBox) {
    for (int corner = 0; corner < 8; ++corner) {
      show(half * glm::dvec3(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1));
    }
  } else {
    const glm::dvec3 height = glm::dot(half, glm::abs(axes.up)) * axes.up;
    const double radius = glm::length(half - half * glm::abs(axes.up));
    constexpr int kSides = 32;
    for (int side = 0; side < kSides; ++side) {
      const SineCosine<double> turn = sine_cosine(static_cast<double>(side) / kSides);
      const glm::dvec3 outwards = radius * (turn.cosine * axes.front + turn.sine * axes.right);
      show(outwards + height);
      show(outwards - height);
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
  // A floor of the scene's own is seen, not this one.
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
    if (!is_finite(rounded)) {
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
