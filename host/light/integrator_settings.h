// Settings of the integrators: the kind, its limits, and which work is skipped.
#pragma once

#include <cstdint>
#include <optional>

namespace raygate {

enum class IntegratorKind {
  kPrimary,  ///< camera rays alone, lit from the camera: diffuse colour times cosine, and emission
  kWhitted,  ///< reflection, refraction and shadows, as in the paper
  kPath,     ///< full global illumination: Monte Carlo path tracing
  // Parts of others, not to be asked for:
  kLight,     ///< paths from the lights to the camera
  kEmitters,  ///< emitters that the camera sees: directly, in mirrors and through glass
};

/// The default relative error of the hit-test unit's P above which the host computes the point.
inline constexpr float kPointError = 0x1p-16f;

/// Whether light paths find caustics.
enum class Caustics {
  kOff,   ///< they are found by chance
  kOn,    ///< they are found by light paths
  kAuto,  ///< the same; where that is not possible, nobody has asked for it
};

/// Work that is skipped because it cannot change the picture: no bit depends on these.
struct Skips {
  bool culling = true;         ///< polygons in boxes that a ray does not enter
  bool records = true;         ///< records of polygons that no ray from the origin comes near
  bool light_behind = true;    ///< shadow rays to lights that bring nothing: from behind
  bool weightless = true;      ///< reflected and refracted rays that bring nothing
  bool empty_tiles = true;     ///< camera rays of tiles in which no polygon can be
  bool first_occluder = true;  ///< the search for a nearer occluder than the first one found
  bool divisions = true;       ///< serial unit: planes of polygons that the edges rule out
};

/// How much work was skipped.
struct SkipCounters {
  std::uint64_t culled_tests = 0;   ///< ray against polygon
  std::uint64_t records = 0;        ///< not made of those that the caches have room for
  std::uint64_t lights_behind = 0;  ///< shadow rays
  std::uint64_t weightless = 0;     ///< secondary rays
  std::uint64_t dim = 0;            ///< secondary rays below the threshold: they do count, a little
  std::uint64_t empty_tile_rays = 0;  ///< camera rays
  std::uint64_t first_occluders = 0;  ///< searches ended early

  SkipCounters& operator+=(const SkipCounters& other) {
    culled_tests += other.culled_tests;
    records += other.records;
    lights_behind += other.lights_behind;
    weightless += other.weightless;
    dim += other.dim;
    empty_tile_rays += other.empty_tile_rays;
    first_occluders += other.first_occluders;
    return *this;
  }
};

/// What the user asks of the integrators. The defaults are those of ./render and of the Python
/// module.
struct IntegratorSettings {
  IntegratorKind integrator = IntegratorKind::kWhitted;
  int samples = 4;                  ///< per pixel, at least 1; a single one has no random choices
  std::optional<int> max_depth{};   ///< reflections and refractions in a row; none: see depth()
  double threshold = 1.0 / 256.0;   ///< Whitted: rays of less throughput are not traced
  std::optional<double> ambient{};  ///< Whitted: radiance from all sides; none: Lights::ambient()
  /// Path: not with a single sample, camera lights, or a camera that is not perspective.
  Caustics caustics = Caustics::kAuto;
  Skips skips{};  ///< the film does not depend on them
  /// The host computes the hit point P where the relative error of the unit's may be larger. 0: the
  /// host always computes it; the largest float: only where the unit has none.
  float point_error = kPointError;

  /// By default 4 for Whitted, as in the paper; 64 for paths, which end by chance.
  [[nodiscard]] int depth() const {
    return max_depth.value_or(integrator == IntegratorKind::kPath ? 64 : 4);
  }
};

}  // namespace raygate
