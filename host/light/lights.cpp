#include "host/light/lights.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include "host/exact/exact.h"
#include "host/scene/camera.h"
#include "host/scene/instances.h"

namespace raygate {
namespace {

bool emits(const Material& material) {
  return glm::any(glm::greaterThan(material.emission, glm::vec3(0.0f)));
}

double mean(const glm::dvec3& colour) { return (colour.x + colour.y + colour.z) / 3.0; }

/// In the order of the scene's triangles: lamps, and what is sampled of them, do not depend on how
/// the tree is built.
std::vector<std::uint32_t> emitting_slots(const Scene& scene, const Bvh& bvh) {
  std::vector<std::uint32_t> slots;
  for (std::uint32_t slot = 0; slot < bvh.slot_count(); ++slot) {
    if (emits(scene.materials[scene.triangles[bvh.triangle_of(slot)].material])) {
      slots.push_back(slot);
    }
  }
  std::ranges::sort(slots, {}, [&](std::uint32_t slot) { return bvh.triangle_of(slot); });
  return slots;
}

/// All faces in one plane, with one side in common: their middle is then among them or near.
void find_middle(const Bvh& bvh, AreaLight& light) {
  const glm::dvec3 normal = glm::normalize(triangle_normal(bvh.corners_of(light.slots[0])));
  glm::dvec3 sum(0.0);
  double before = 0.0;
  bool is_flat = true;
  for (std::size_t i = 0; i < light.slots.size(); ++i) {
    const Corners& t = bvh.corners_of(light.slots[i]);
    const glm::dvec3 middle = (glm::dvec3(t[0]) + glm::dvec3(t[1]) + glm::dvec3(t[2])) / 3.0;
    sum += (light.area_up_to[i] - before) * middle;
    before = light.area_up_to[i];
    const glm::dvec3 own = glm::normalize(triangle_normal(t));
    is_flat = is_flat && std::abs(glm::dot(own, normal)) > 1.0 - 1e-9;
  }
  light.is_flat = is_flat;
  // A little towards the first face: as a rule, the very middle of a lamp of two triangles is on
  // the edge between them, and exact arithmetic would have to say which one each ray meets.
  const Corners& first = bvh.corners_of(light.slots[0]);
  const glm::dvec3 inside =
      (glm::dvec3(first[0]) + glm::dvec3(first[1]) + glm::dvec3(first[2])) / 3.0;
  light.middle = glm::mix(sum / light.area(), inside, 0x1p-10);
  light.middle_normal = normal;
}

/// The reflected part of what one side of the lamps sends out, F r / (1 - r), over pi times all
/// area; r is the mean reflectance.
glm::dvec3 guessed_ambient(const Scene& scene, const std::vector<AreaLight>& lamps) {
  glm::dvec3 flux(0.0), reflecting(0.0);
  double area = 0.0;
  for (const AreaLight& lamp : lamps) flux += std::numbers::pi * lamp.area() * lamp.radiance;
  if (flux == glm::dvec3(0.0)) return flux;
  for_each_face(scene, [&](const Corners& corners, const Triangle& face) {
    const double own = 0.5 * glm::length(triangle_normal(corners));
    area += own;
    reflecting += own * glm::dvec3(scene.materials[face.material].diffuse);
  });
  const glm::dvec3 mean = glm::clamp(reflecting / area, glm::dvec3(0.0), glm::dvec3(0.9));
  return flux * mean / (1.0 - mean) / (std::numbers::pi * area);
}

/// No infinity.
float bounded(double x) {
  return static_cast<float>(std::min(x, double{std::numeric_limits<float>::max()}));
}
glm::vec3 bounded(const glm::dvec3& x) { return {bounded(x.x), bounded(x.y), bounded(x.z)}; }

/// A power of two about as long as the scene, its lights included.
double unit_of(const Scene& scene) {
  float size = 0.0f;
  if (!is_empty(scene)) {
    const PositionBox box = position_box(scene);
    size = static_cast<float>(std::max(largest(box.low), largest(box.high)));
  }
  for (const PointLight& light : scene.lights) size = std::max(size, largest(light.position));
  constexpr int kMostExponent = 126;  // the inverse is a float, too
  return size > 0.0f ? std::ldexp(1.0, std::clamp(std::ilogb(size), -kMostExponent, kMostExponent))
                     : 1.0;
}

/// Of the ball around the scene's box: what falls on it comes into the scene.
double cross_section_of(const Scene& scene) {
  if (is_empty(scene)) return 0.0;
  const auto [low, high] = position_box(scene);
  const double radius = 0.5 * glm::length(high - low);
  return std::numbers::pi * radius * radius;
}

/// In which a point light shines: all steradians, or those within the middle of a cone's border.
double solid_angle(const PointLight& light) {
  if (!light.spot) return 4.0 * std::numbers::pi;
  const double inner = sine_cosine(light.spot->inner / 360.0).cosine;
  const double outer = sine_cosine(light.spot->outer / 360.0).cosine;
  return 2.0 * std::numbers::pi * (1.0 - 0.5 * (inner + outer));
}

/// The corner of a parallelogram and its two sides. Its diagonal from that corner parts the
/// triangles: the first one has more of u than of v.
struct Parallelogram {
  glm::vec3 corner, u, v;
};

/// The parallelogram that two triangles make, both facing the same way.
std::optional<Parallelogram> parallelogram(const Corners& first, const Corners& second) {
  for (std::size_t k = 0; k < 3; ++k) {
    // The edge from `first`'s corner k + 2 to k is shared, and runs the other way in `second`.
    const glm::vec3 &corner = first[k], &side = first[(k + 1) % 3], &end = first[(k + 2) % 3];
    for (std::size_t j = 0; j < 3; ++j) {
      if (second[j] != corner || second[(j + 1) % 3] != end) continue;
      const glm::dvec3 u = glm::dvec3(side) - glm::dvec3(corner);
      const glm::dvec3 v = glm::dvec3(end) - glm::dvec3(side);
      const glm::dvec3 other = glm::dvec3(second[(j + 2) % 3]) - glm::dvec3(corner);
      if (largest(other - v) > 0x1p-20 * std::max(largest(u), largest(v))) return std::nullopt;
      return Parallelogram{corner, glm::vec3(u), glm::vec3(other)};
    }
  }
  return std::nullopt;
}

/// Lamps stand still while the camera is looked through: they are found from it.
class Studio {
 public:
  Studio(const Scene& scene, const Camera& camera) : camera_(camera) {
    const auto [low, high] = position_box(scene);
    const glm::dvec3 eye(camera.eye());
    middle_ = 0.5 * (low + high);
    size_ = glm::length(high - low);
    is_inside_ = glm::all(glm::lessThanEqual(low, eye)) && glm::all(glm::lessThanEqual(eye, high));
  }

  [[nodiscard]] bool is_inside() const { return is_inside_; }
  [[nodiscard]] double size() const { return size_; }

  /// From the upper left of the camera, or from the camera.
  [[nodiscard]] PointLight key() const {
    // In the middle of the scene a white wall that faces the lamp has radiance 0.8 from it.
    if (is_inside_) return lamp(glm::dvec3(camera_.eye()), 0.35 * size_, 0.8);
    const glm::dvec3 at = place(-0.8, 1.2);
    return lamp(at, glm::length(at - middle_), 0.8);
  }
  /// From the right of the camera.
  [[nodiscard]] PointLight fill() const {
    const glm::dvec3 at = place(1.4, 0.3);
    return lamp(at, glm::length(at - middle_), 0.25);
  }

 private:
  [[nodiscard]] glm::dvec3 place(double right, double up) const {
    return middle_ +
           size_ * (up * camera_.up() + right * camera_.right() - 1.3 * camera_.forward());
  }
  [[nodiscard]] static PointLight lamp(const glm::dvec3& at, double distance, double radiance) {
    return {glm::vec3(at), glm::dvec3(radiance * std::numbers::pi * distance * distance)};
  }

  const Camera& camera_;
  glm::dvec3 middle_;
  double size_;
  bool is_inside_;
};

/// Neither lights nor faces that emit.
bool has_no_lamp(const Scene& scene) {
  return scene.lights.empty() && scene.directional_lights.empty() && !scene.environment &&
         std::ranges::none_of(scene.triangles, [&](const Triangle& face) {
           return emits(scene.materials[face.material]);
         });
}

/// Radiance times area of all faces that emit.
double emitted(const Scene& scene) {
  double sum = 0.0;
  for (const Triangle& face : scene.triangles) {
    const Material& material = scene.materials[face.material];
    if (!emits(material)) continue;
    const auto& [a, b, c] = face.vertices;
    sum +=
        0.5 * mean(glm::dvec3(material.emission)) *
        glm::length(triangle_normal({scene.positions[a], scene.positions[b], scene.positions[c]}));
  }
  return sum;
}

constexpr glm::vec3 kDimSky(0.18f, 0.2f, 0.24f);

}  // namespace

void light_if_dark(Scene& scene, const Camera& camera) {
  if (is_empty(scene) || scene.background != glm::vec3(0.0f) || !has_no_lamp(scene)) return;
  scene.lights.push_back(Studio(scene, camera).key());
  scene.background = kDimSky;
}

bool light_first_look(Scene& scene, const Camera& camera) {
  if (is_empty(scene) || !scene.lights.empty() || !scene.directional_lights.empty() ||
      scene.environment) {
    return false;
  }
  const Studio studio(scene, camera);
  // Labels and the like that glow are no lamps: not a hundredth of what the key lamp does.
  constexpr double kGlow = 0.01;
  if (emitted(scene) > kGlow * studio.size() * studio.size()) return false;
  scene.lights.push_back(studio.key());
  if (!studio.is_inside()) scene.lights.push_back(studio.fill());
  if (scene.background == glm::vec3(0.0f)) scene.background = kDimSky;
  return true;
}

Lights::Lights(const Scene& scene, const Bvh& bvh) : scene_(scene), bvh_(bvh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> known;
  for (const std::uint32_t slot : emitting_slots(scene, bvh)) {
    const Triangle& face = scene.triangles[bvh.triangle_of(slot)];
    const Material& material = scene.materials[face.material];
    if (lamp_of_slot_.empty()) lamp_of_slot_.assign(bvh.slot_count(), kNoIndex);
    const auto [at, is_new] = known.try_emplace({face.object, face.material}, areas_.size());
    if (is_new) {
      areas_.emplace_back();
      areas_.back().radiance = glm::dvec3(material.emission);
    }
    lamp_of_slot_[slot] = static_cast<std::uint32_t>(points().size() + at->second);
    AreaLight& light = areas_[at->second];
    const Corners corners = bvh.corners_of(slot);
    if (is_new) light.low = light.high = corners[0];
    for (const glm::vec3& corner : corners) {
      light.low = glm::min(light.low, corner);
      light.high = glm::max(light.high, corner);
    }
    const double area = 0.5 * glm::length(triangle_normal(corners));
    light.area_up_to.push_back((light.slots.empty() ? 0.0 : light.area()) + area);
    light.slots.push_back(slot);
  }
  const double unit = unit_of(scene);
  per_unit_ = static_cast<float>(1.0 / unit);
  std::vector<double> power_up_to;
  double power = 0.0;
  for (const PointLight& light : scene.lights) {
    Lamp& lamp = lamps_.emplace_back();
    lamp.light = bounded(light.intensity / unit / unit);
    lamp.position = light.position;
    lamp.is_spot = light.spot.has_value();
    if (lamp.is_spot) lamp.spot = SpotRamp(*light.spot);
    power += solid_angle(light) * mean(light.intensity);
    power_up_to.push_back(power);
  }
  for (AreaLight& light : areas_) {
    find_middle(bvh, light);
    Lamp& lamp = lamps_.emplace_back();
    lamp.kind = Kind::kArea;
    lamp.light = bounded(light.radiance);
    lamp.area = bounded(light.area() / unit / unit);
    add_patches(light, lamp);
    power += 2.0 * std::numbers::pi * light.area() * mean(light.radiance);
    power_up_to.push_back(power);
  }
  const double cross_section = cross_section_of(scene);
  for (const DirectionalLight& light : scene.directional_lights) {
    Lamp& lamp = lamps_.emplace_back();
    lamp.kind = Kind::kDirection;
    lamp.light = light.irradiance;
    lamp.position = glm::vec3(-light.direction);
    power += cross_section * mean(glm::dvec3(light.irradiance));
    power_up_to.push_back(power);
  }
  if (scene.environment) {
    environment_.emplace(*scene.environment);
    lamps_.emplace_back().kind = Kind::kEnvironment;
    power += cross_section * 4.0 * std::numbers::pi * mean(environment_->mean_radiance());
    power_up_to.push_back(power);
  }
  any_power_ = power > 0.0;
  for (std::size_t i = 0; any_power_ && i < lamps_.size(); ++i) {
    const double chance = (power_up_to[i] - (i == 0 ? 0.0 : power_up_to[i - 1])) / power;
    lamps_[i].chance = static_cast<float>(chance);
    if (lamps_[i].patches != 0) {
      lamps_[i].chance_of_place =
          bounded(chance / areas_[i - points().size()].area() * unit * unit);
    }
    chance_up_to_.push_back(static_cast<float>(power_up_to[i] / power));
  }
  ambient_ =
      background() != glm::vec3(0.0f) ? glm::dvec3(background()) : guessed_ambient(scene, areas_);
}

/// Two triangles in a row that share an edge and are opposite corners' halves of a parallelogram
/// are one patch: points of the square are spread over it without a bend.
void Lights::add_patches(const AreaLight& light, Lamp& lamp) {
  lamp.first_patch = static_cast<std::uint32_t>(patches_.size());
  for (std::size_t i = 0; i < light.slots.size(); ++i) {
    const Corners t = bvh_.corners_of(light.slots[i]);
    Patch patch;
    patch.slot = patch.slot_beyond = light.slots[i];
    patch.begin = i == 0 ? 0.0f : static_cast<float>(light.area_up_to[i - 1] / light.area());
    patch.normal = glm::vec3(glm::normalize(triangle_normal(t)));
    patch.corner = t[0];
    patch.u = t[1] - t[0];
    patch.v = t[2] - t[0];
    if (i + 1 < light.slots.size()) {
      const auto sides = parallelogram(t, bvh_.corners_of(light.slots[i + 1]));
      if (sides) {
        ++i;
        patch.is_triangle = false;
        patch.corner = sides->corner;
        patch.u = sides->u;
        patch.v = sides->v;
        patch.slot_beyond = light.slots[i];
      }
    }
    patch.end = static_cast<float>(light.area_up_to[i] / light.area());
    patches_.push_back(patch);
    patch_ends_.push_back(patch.end);
    ++lamp.patches;
  }
}

}  // namespace raygate
