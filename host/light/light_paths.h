// Light paths: paths from lights to the camera, aimed at mirrors and glass.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "host/light/prepared_scene.h"
#include "host/light/ray_batch.h"
#include "host/scene/camera.h"

namespace raygate {

/// Returns the MIS weight of emission that a camera path meets after a mirror or glass. `density()`
/// returns the density of light paths that start at the emitter and go back along the path's ray.
template <class Density>
RAYGATE_INLINE float caustic_weight(const PathState& state, const Density& density) {
  if (!(state.light_over_camera_pdf > 0.0f) || state.pdf > 0.0f || state.specular_history == 1)
    return 1.0f;
  const float ratio = state.light_over_camera_pdf * density();
  return 1.0f / (1.0f + ratio * ratio);
}

/// Lower limit to which densities clamp the cosines at the ends of path edges.
inline constexpr float kLeastCosine = 0x1p-20f;

/// The part of the frame that light paths target, in camera coordinates from 0 to 1.
struct FrameView {
  const Camera& camera;  ///< a perspective camera
  int width = 1, height = 1;
  glm::dvec2 low{0.0}, high{1.0};  ///< contributions outside of this range are discarded
};

/// Samples and returns densities of starts of light paths, and connects path ends to the camera.
///
/// Here, mirrors and glass are smooth; rough surfaces sample lights instead. A light path counts
/// only if its first surface is a mirror or glass. Lights are therefore chosen by the flux that
/// they send to the bounding spheres of the scene's mirrors and glass. Rays from a light at finite
/// distance are uniform in the solid angles of the spheres. Rays from a distant light are uniform
/// over the spheres' discs. Lengths are in scene units, densities per squared unit of Lights.
///
/// A path that both camera paths and light paths can find is weighted by multiple importance
/// sampling with the power heuristic (Veach, "Robust Monte Carlo methods for light transport
/// simulation", 1997, chapters 9 and 10). On a camera path, PathState::light_over_camera_pdf is the
/// density of light paths over the density of camera paths for the path so far; on a light path, it
/// is the inverse (as in "Implementing vertex connection and merging", Georgiev 2012). Each vertex
/// multiplies it by back / pdf * out / in, mirrors and smooth glass by out / in. `in` and `out` are
/// the cosines of the incoming and the outgoing edge. `pdf` is the density per solid angle of
/// sampling the outgoing edge; `back`, of sampling the incoming edge on the reverse path.
class LightPaths {
 public:
  /// The references must outlive this object.
  LightPaths(const PreparedScene& prepared, const Lights& lights, const FrameView& frame);

  /// Returns whether light paths exist: requires an emitting light, and a mirror or smooth glass.
  [[nodiscard]] bool exist() const { return !source_cdf_.empty(); }
  /// Returns the number of light paths for one sample of every pixel of the frame.
  [[nodiscard]] std::uint64_t count() const { return count_; }

  struct Start {
    Ray ray;
    PathState state;  ///< its throughput is flux
  };
  /// Returns the start of path `number` of an image, or nullopt if it carries no light.
  [[nodiscard]] std::optional<Start> start(std::uint64_t number, std::uint64_t seed) const;

  /// Returns the density of light paths that start at `point` of a source in this unit direction,
  /// per area and solid angle: the sum for all count() paths.
  [[nodiscard]] float density(std::uint32_t source, const glm::vec3& point,
                              const glm::vec3& direction) const;
  /// Returns the density of light paths from the environment that go through `point` against the
  /// unit vector `towards`, per area perpendicular to `towards`: the sum for all count() paths.
  [[nodiscard]] float environment_density(const glm::vec3& point, const glm::vec3& towards) const;

  /// Returns PathState::light_over_camera_pdf of camera rays with these unit directions, without
  /// the factor of their hits' squared distance.
  template <class T>
  [[nodiscard]] RAYGATE_INLINE T camera_ratio(const Triple<T>& direction) const {
    const T cosine = dot(direction, spread<T>(glm::vec3(frame_.camera.forward())));
    return cosine * cosine * cosine * area_per_pixel_;
  }

  /// The connection of a point to the camera.
  struct View {
    glm::vec3 lens{0.0f};  ///< point of the lens
    /// Pixels per area perpendicular to the connection; 0: not in the frame.
    float per_area = 0.0f;
  };
  [[nodiscard]] View view_of(const glm::vec3& point, const glm::vec2& lens) const;

 private:
  /// Bounding sphere of an object's mirrors and glass.
  struct Ball {
    glm::dvec3 middle{0.0};
    double radius = 0.0;
    /// Returns the sphere's solid angle seen from a point.
    [[nodiscard]] double solid_angle(const glm::dvec3& point) const;
    /// Returns whether a ray, or with `both_ways` a line, meets the sphere.
    [[nodiscard]] bool meets(const glm::dvec3& point, const glm::dvec3& direction,
                             bool both_ways) const;
  };
  void find_balls(const PreparedScene& prepared);
  void weigh_sources();
  [[nodiscard]] double solid_angle(const glm::dvec3& point) const;
  [[nodiscard]] double meetings(const glm::dvec3& point, const glm::dvec3& direction,
                                bool both_ways) const;
  template <class Size>
  [[nodiscard]] const Ball& choose_ball(double u, const Size& size) const;
  [[nodiscard]] glm::dvec3 direction_from(const glm::dvec3& point, double choice,
                                          const SquarePoint<float>& u) const;
  [[nodiscard]] double pmf(std::uint32_t source) const {
    return source_cdf_[source] - (source == 0 ? 0.0 : source_cdf_[source - 1]);
  }

  const Lights& lights_;
  std::uint64_t count_;
  FrameView frame_;
  float area_per_pixel_;  // area of a pixel on the image plane at distance 1
  std::vector<Ball> balls_;
  double discs_ = 0.0;              // total area of the spheres' discs, in square units
  double reach_ = 0.0;              // larger than any distance within the scene
  std::vector<double> source_cdf_;  // by source of Lights
};

}  // namespace raygate
