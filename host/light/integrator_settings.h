// Settings of the integrators: kind, limits, and optimisations.
#pragma once

#include <optional>

namespace raygate {

enum class IntegratorKind {
  kPrimary,  ///< camera rays only, lit from the camera: diffuse colour times cosine, plus emission
  kWhitted,  ///< reflection, refraction and shadows, as in Whitted's paper
  kPath,     ///< full global illumination: Monte Carlo path tracing
  // Internal, not selectable by users:
  kLight,     ///< paths from the lights to the camera
  kEmitters,  ///< emitters that the camera sees: directly, in mirrors and through glass
};

/// User options of the integrators. ./render and the Python module have the same defaults.
struct IntegratorSettings {
  IntegratorKind integrator = IntegratorKind::kWhitted;
  int samples = 4;  ///< per pixel, at least 1; a single sample is taken without random choices
  /// Maximum number of consecutive reflections and refractions; default: see depth().
  std::optional<int> max_depth{};
  double threshold = 1.0 / 256.0;   ///< Whitted: rays with a throughput below this are not traced
  std::optional<double> ambient{};  ///< Whitted: ambient radiance; default: Lights::ambient()
  /// For kPath: whether light paths find caustics. Light paths need several samples per pixel,
  /// RenderSettings::error 0, no camera lights, and a perspective camera.
  bool caustics = true;
  /// Largest error, relative to P, of a hit point P computed by the unit. If P's error bound
  /// exceeds this, the host computes P. 0: always; the largest float: only if the unit has no P.
  float point_error = 0x1p-16f;

  /// Returns max_depth. Defaults: 4 for kWhitted, as in the paper; 64 for kPath.
  [[nodiscard]] int depth() const {
    return max_depth.value_or(integrator == IntegratorKind::kPath ? 64 : 4);
  }
};

}  // namespace raygate
