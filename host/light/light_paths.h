// Light paths: paths that begin at lights, aimed at mirrors and glass, and end at the camera.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "host/exact/exact.h"
#include "host/light/lights.h"
#include "host/light/prepared_scene.h"
#include "host/light/ray_batch.h"
#include "host/scene/camera.h"

namespace raygate {

/// The MIS weight of light that a camera path meets after a mirror or glass, where light paths go
/// from that place of the light against its ray as densely as `density()` says.
template <class Density>
RAYGATE_INLINE float caustic_weight(const PathState& state, const Density& density) {
  if (!(state.light_over_camera_pdf > 0.0f) || state.pdf > 0.0f || state.history == 1) return 1.0f;
  const float ratio = state.light_over_camera_pdf * density();
  return 1.0f / (1.0f + ratio * ratio);
}

/// Cosines of edges count as at least this, in densities.
inline constexpr float kLeastCosine = 0x1p-20f;

/// The frame that light paths are seen in: places are the camera's, from 0 to 1.
struct FrameView {
  const Camera& camera;  ///< perspective
  int width = 1, height = 1;
  glm::dvec2 low{0.0}, high{1.0};  ///< places beyond these do not count
};

/// Mirrors and glass here are smooth: rough ones ask lights for light.
///
/// Where light paths begin, how likely each beginning is, and how the camera sees where they end.
///
/// A light path counts if the first surface that scatters it is a mirror or glass: all others find
/// their light well by asking for it. So paths begin by the light that a light sends to the balls
/// around the scene's mirrors and glass, and go towards these: from lights at a place, uniformly in
/// the angles that the balls take up; from light that is infinitely far away, uniformly across
/// their discs. All lengths here are those of the scene, all densities per square unit of Lights.
///
/// A path of both kinds, from the camera and from a light, is weighted by multiple importance
/// sampling with the power heuristic (Veach, "Robust Monte Carlo methods for light transport
/// simulation", 1997, chapters 9 and 10). PathState::light_over_camera_pdf is the quotient of both
/// densities as far as the path is known, so that no path is looked at twice (as "Implementing
/// vertex connection and merging", Georgiev 2012, has it for more techniques). At a vertex with the
/// cosines `in` and `out` of its edges and the densities `pdf` and `back` per solid angle of the
/// ways on and back, it is multiplied by back / pdf * out / in: what both share is left out, and
/// mirrors and smooth glass have neither density.
class LightPaths {
 public:
  /// The references must outlive this.
  LightPaths(const PreparedScene& prepared, const Lights& lights, const FrameView& frame);

  /// Whether there is a light that shines, and a mirror or glass.
  [[nodiscard]] bool exist() const { return !source_cdf_.empty(); }
  /// How many begin for each sample of all pixels of the frame.
  [[nodiscard]] std::uint64_t count() const { return count_; }

  struct Start {
    Ray ray;
    PathState state;  ///< its throughput is flux
  };
  /// Path `number` of a picture; none where the light sends nothing that way.
  [[nodiscard]] std::optional<Start> start(std::uint64_t number, std::uint64_t seed) const;

  /// How many light paths of a sample begin at `point` of a light, per area and per solid angle
  /// around the unit vector `direction`.
  [[nodiscard]] float density(std::uint32_t source, const glm::vec3& point,
                              const glm::vec3& direction) const;
  /// The same of paths that come from infinitely far away, against the unit vector `towards`
  /// through `point`, per area across that.
  [[nodiscard]] float environment_density(const glm::vec3& point, const glm::vec3& towards) const;
  /// Whether a mirror or glass may be in that direction, a unit vector.
  [[nodiscard]] bool may_meet(const glm::vec3& point, const glm::vec3& direction) const {
    return meetings(glm::dvec3(point), glm::dvec3(direction), false) > 0.0;
  }

  /// PathState::light_over_camera_pdf of camera rays with these unit directions, which lacks the
  /// squared distance of what they meet.
  template <class T>
  [[nodiscard]] RAYGATE_INLINE T camera_ratio(const Triple<T>& direction) const {
    const T cosine = dot(direction, spread<T>(glm::vec3(frame_.camera.forward())));
    return cosine * cosine * cosine * area_per_pixel_;
  }

  /// How the camera sees a point.
  struct View {
    glm::vec3 lens{0.0f};   ///< the point of the lens that sees it
    float per_area = 0.0f;  ///< pixels to an area across the way to it; 0: it is not in the frame
  };
  [[nodiscard]] View view_of(const glm::vec3& point, const glm::vec2& lens) const;

 private:
  /// Around what is mirror or glass of an object.
  struct Ball {
    glm::dvec3 middle;
    double radius;
    /// The solid angle that it takes up, seen from a point.
    [[nodiscard]] double solid_angle(const glm::dvec3& point) const;
    /// Whether a ray meets it; or, `both_ways`, the line.
    [[nodiscard]] bool meets(const glm::dvec3& point, const glm::dvec3& direction,
                             bool both_ways) const;
  };
  void find_balls(const PreparedScene& prepared);
  void weigh_sources();
  [[nodiscard]] double solid_angle(const glm::dvec3& point) const;
  [[nodiscard]] double nearest_middle(const glm::dvec3& point) const;
  [[nodiscard]] double meetings(const glm::dvec3& point, const glm::dvec3& direction,
                                bool both_ways) const;
  [[nodiscard]] glm::dvec3 direction_from(const glm::dvec3& point, const SquarePoint<float>& choice,
                                          const SquarePoint<float>& u) const;
  [[nodiscard]] glm::dvec3 point_across(const glm::dvec3& towards, const SquarePoint<float>& choice,
                                        const SquarePoint<float>& u) const;
  [[nodiscard]] double pmf(std::uint32_t source) const {
    return source_cdf_[source] - (source == 0 ? 0.0 : source_cdf_[source - 1]);
  }

  const Lights& lights_;
  std::uint64_t count_;
  FrameView frame_;
  float area_per_pixel_;  // of the picture at distance 1
  std::vector<Ball> balls_;
  double discs_ = 0.0;              // the areas of all, in square units
  double reach_ = 0.0;              // from any point of the scene beyond all others
  std::vector<double> source_cdf_;  // of the sources of Lights
};

}  // namespace raygate
