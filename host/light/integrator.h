// How a picture follows from hits: what becomes of light where a ray meets a surface.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "host/light/bsdf.h"
#include "host/light/departure.h"
#include "host/light/integrator_kind.h"
#include "host/light/lights.h"
#include "host/light/sampler.h"
#include "host/light/shadow_rays.h"
#include "host/light/skips.h"
#include "host/light/surface.h"

namespace raygate {

/// A ray on its way, and what its light counts for.
struct LightRay {
  Ray ray;
  std::uint32_t sample = 0;  ///< of a pixel: whose radiance it adds to
  std::uint32_t stream = 0;  ///< of random numbers, its own in the sample
  int depth = 0;             ///< surfaces behind it; 0: from the camera
  glm::dvec3 weight{1.0};
  /// Where a surface scattered it: how likely that was to give this direction, per steradian;
  /// 0 where there was no choice (camera, mirror, glass).
  double density = 0.0;
  glm::dvec3 scattered_at{0.0};  ///< and where
};

/// The random numbers of one ray.
class RandomNumbers {
 public:
  RandomNumbers(const Sampler& sampler, std::uint32_t index, std::uint32_t stream)
      : sampler_(sampler), index_(index), stream_(stream) {}
  [[nodiscard]] glm::dvec2 operator()(std::uint32_t purpose) const {
    return sampler_(index_, mixed(stream_, purpose));
  }

 private:
  const Sampler& sampler_;
  std::uint32_t index_, stream_;
};

/// What the surfaces of a wave of rays give.
struct WaveOutput {
  std::vector<glm::dvec3> radiance;  ///< by sample
  std::vector<ShadowRay> shadows;    ///< light still to arrive
  std::vector<LightRay> next;        ///< the rays that go on
};

struct IntegratorOptions {
  int max_depth = 4;               ///< rays of this depth are the last
  double threshold = 1.0 / 256.0;  ///< Whitted: rays that count for less are not traced
  glm::dvec3 ambient{0.0};         ///< Whitted: radiance from all sides that reaches everything
  bool single_sample = false;      ///< one sample a pixel: no chance where there is a middle
};

/// Shades hits. Not for use by two threads at once.
class Integrator {
 public:
  /// The references must outlive this.
  Integrator(const Clearances& clearances, const Lights& lights, const Skips& skips,
             const IntegratorOptions& options)
      : lights_(lights), departure_(clearances), skips_(skips), options_(options) {}
  virtual ~Integrator() = default;

  /// Adds what the hit of `ray` gives.
  virtual void shade(const LightRay& ray, const Surface& surface, const RandomNumbers& random,
                     WaveOutput& output) = 0;
  /// Whether shadows are cast as if glass did not bend light.
  [[nodiscard]] virtual bool shadows_through_refraction() const = 0;

  [[nodiscard]] const SkipCounters& skipped() const { return skipped_; }

 protected:
  /// A hit, and the points beside it from which rays go on, found when needed.
  struct Hit {
    const LightRay& ray;
    const Surface& surface;
    Bsdf bsdf;
    std::optional<std::optional<glm::vec3>> before, after;
  };

  /// The departure point of a hit; nothing where there is none.
  const std::optional<glm::vec3>& departure(Hit& hit, Departure way);

  /// Asks for the light of a point light that the surface scatters, divided by `chance`.
  void light_from_point(Hit& hit, std::size_t light, double chance, WaveOutput& output);
  /// Asks for the light of a lamp's point; `weighted` is radiance over the density of the point,
  /// per area, and whatever else it is to be multiplied with.
  void light_from_area(Hit& hit, const LightPoint& point, const glm::dvec3& weighted,
                       WaveOutput& output);

  /// Sends a ray on. `flat` is the direction if `direction`, made with an interpolated normal,
  /// leads to the wrong side; nothing goes on if it does, too.
  void go_on(Hit& hit, Departure way, const glm::dvec3& direction,
             const std::optional<glm::dvec3>& flat, LightRay next, WaveOutput& output);
  /// The mirror's ray; its weight is `weight`.
  void go_on_mirrored(Hit& hit, const glm::dvec3& weight, std::uint32_t branch, WaveOutput& output);
  /// The ray through the surface.
  void go_on_through(Hit& hit, const glm::dvec3& weight, std::uint32_t branch, WaveOutput& output);

  const Lights& lights_;
  DeparturePoint departure_;
  Skips skips_;
  IntegratorOptions options_;
  SkipCounters skipped_;

 private:
  void ask(Hit& hit, ShadowRay shadow, WaveOutput& output);
};

/// Not for kPrimary, which has none.
[[nodiscard]] std::unique_ptr<Integrator> make_integrator(IntegratorKind kind,
                                                          const Clearances& clearances,
                                                          const Lights& lights, const Skips& skips,
                                                          const IntegratorOptions& options);

}  // namespace raygate
