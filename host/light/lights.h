// Where light comes from.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "host/scene/scene.h"
#include "host/tree/bvh.h"

namespace raygate {

class Camera;

/// Adds light to a scene that has none (no lights, no face that emits, no background): one lamp to
/// the upper left of the camera, or at the camera where that stands within the scene, and a dim
/// sky.
void light_if_dark(Scene& scene, const Camera& camera);

/// The emitting faces of one object and material: one lamp, which shines to both sides of each
/// face. Each part of its area is as likely to be sampled as any other.
struct AreaLight {
  std::vector<std::uint32_t> slots;
  std::vector<double> area_up_to;  ///< of the slots so far, each included
  glm::dvec3 radiance{0.0};
  bool is_flat = false;
  glm::dvec3 middle{0.0}, middle_normal{0.0};  ///< of a flat one

  [[nodiscard]] double area() const { return area_up_to.back(); }
};

/// A point of a lamp.
struct LightPoint {
  glm::dvec3 position{0.0}, normal{0.0};  ///< the normal to one of both sides
  std::uint32_t slot = 0;
};

/// All lights of a scene, ready for use.
class Lights {
 public:
  /// The references must outlive this.
  Lights(const Scene& scene, const Bvh& bvh);

  [[nodiscard]] std::span<const PointLight> points() const { return scene_.lights; }
  [[nodiscard]] std::span<const AreaLight> areas() const { return areas_; }
  [[nodiscard]] glm::dvec3 background() const { return glm::dvec3(scene_.background); }
  /// Radiance from all sides that may stand for light that goes from surface to surface: the
  /// background's or, where that is black, what the lamps' flux would come to after many
  /// reflections if it were spread evenly over all surfaces ("A progressive refinement approach to
  /// fast radiosity image generation", Cohen, Chen, Wallace and Greenberg 1988, has such a term).
  [[nodiscard]] const glm::dvec3& ambient() const { return ambient_; }
  /// Points first, then areas.
  [[nodiscard]] std::size_t count() const { return points().size() + areas_.size(); }

  /// A point of an area light, uniform in area, for a point of the unit square.
  [[nodiscard]] LightPoint sample(const AreaLight& light, const glm::dvec2& u) const;
  /// The middle of a flat light, or very near, as a sample. Its slot is one of the light's.
  [[nodiscard]] static LightPoint middle(const AreaLight& light);

  /// Which area light a slot belongs to; nullptr for none.
  [[nodiscard]] const AreaLight* area_of(std::uint32_t slot) const;

  /// Whether there is a light, and not all are dark.
  [[nodiscard]] bool any_power() const { return !power_up_to_.empty() && power_up_to_.back() > 0; }
  /// One light, chosen by its power: index as in count(). Only where any_power().
  [[nodiscard]] std::size_t choose(double u) const;
  /// How likely choose() is to give that one.
  [[nodiscard]] double chance(std::size_t light) const;
  /// The same of an area light of areas().
  [[nodiscard]] double chance(const AreaLight& light) const {
    return chance(points().size() + static_cast<std::size_t>(&light - areas_.data()));
  }

 private:
  const Scene& scene_;
  const Bvh& bvh_;
  std::vector<AreaLight> areas_;
  std::vector<std::uint32_t> area_of_slot_;  // index into areas_, or kNoIndex; empty: none at all
  std::vector<double> power_up_to_;          // each light included
  glm::dvec3 ambient_{0.0};
};

}  // namespace raygate
