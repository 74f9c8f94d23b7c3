// Options of the integrators: the kind, its limits, and which work is skipped.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

namespace raygate {

enum class IntegratorKind {
  kPrimary,  ///< camera rays alone, lit from the camera: diffuse colour times cosine, and emission
  kWhitted,  ///< reflection, refraction and shadows, as in the paper
  kPath,     ///< full global illumination: Monte Carlo path tracing
  // Parts of others, not to be asked for:
  kLight,     ///< paths from the lights to the camera
  kEmitters,  ///< emitters that the camera sees: directly, in mirrors and through glass
};

/// How one of many lights is chosen.
enum class LightSampling : std::uint8_t {
  kNone,   ///< none is: an integrator samples all lights, or no light
  kTree,   ///< by what each may bring to the point that is lit (LightTree)
  kPower,  ///< by power alone: what the tree is measured against
};

/// Variance reduction of the path tracer. The mean of a picture is the same with any of them. The
/// defaults came out best; the lab's `techniques` measures the others next to them.
struct PathOptions {
  LightSampling lights = LightSampling::kTree;
  /// MIS weights: a light that a scattered ray finds counts for as much as the sky beside it.
  bool limits_mis_weight = true;
  /// Russian roulette below this throughput, after three surfaces; 0: never.
  float roulette_threshold = 0.25f;
};

/// The default relative error of the hit-test unit's P above which the host computes the point.
inline constexpr float kPointError = 0x1p-16f;

class LightPaths;

struct IntegratorOptions {
  int max_depth = 4;               ///< rays of this depth are the last
  double threshold = 1.0 / 256.0;  ///< Whitted: rays that count for less are not traced
  glm::dvec3 ambient{0.0};         ///< Whitted: radiance from all sides that reaches everything
  bool single_sample = false;      ///< one sample a pixel: no chance where there is a middle
  PathOptions path{};
  float point_error = kPointError;          ///< relative; beyond it the host computes P
  const LightPaths* light_paths = nullptr;  ///< kPath, kLight: what it is to be combined with
};

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

}  // namespace raygate
