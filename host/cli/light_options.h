// The options that say how light is followed.
#pragma once

#include <optional>
#include <string>

#include "host/film/reconstruction_filter.h"
#include "host/film/sample_range.h"
#include "host/light/integrator_kind.h"
#include "host/light/point_error.h"
#include "host/light/skips.h"

namespace CLI {
class App;
}

namespace raygate {

/// Samples per pixel where nobody says how many: of an engine that simulates nothing.
inline constexpr int kCpuSamples = 4;
/// The most, where --error says how many.
inline constexpr int kMostSamples = 1024;

/// How light is followed; all values are possible.
struct LightOptions {
  IntegratorKind integrator = IntegratorKind::kWhitted;
  std::optional<int> depth;  ///< 0 to 1000; none: the integrator's own
  double threshold = 1.0 / 256.0;
  std::optional<double> ambient;  ///< radiance; none: Lights::ambient
  int samples = 1;
  double error = 0.0;  ///< RenderOptions::error: `samples` is the most; 0: is what all pixels get
  std::optional<SampleRange> range;  ///< those of them that are rendered; none: all
  ReconstructionFilter filter = ReconstructionFilter::kBlackmanHarris;
  Skips skips;
  float point_error = kPointError;

  /// 4 for Whitted, as the paper has it; for paths, which end by chance, 64.
  [[nodiscard]] int max_depth() const {
    return depth.value_or(integrator == IntegratorKind::kPath ? 64 : 4);
  }
};

/// As they were typed; empty where they were not given.
struct RawLightOptions {
  std::string integrator, depth, threshold, ambient, samples, error, range, filter, no_skip,
      point_error;
};

void declare_light_options(CLI::App& app, RawLightOptions& raw);

/// Throws InputError, one line.
[[nodiscard]] LightOptions parse_light_options(const RawLightOptions& raw);

/// "box", "tent", "gauss", "blackman-harris".
[[nodiscard]] std::string to_string(ReconstructionFilter filter);

/// "primary", "whitted", "path".
[[nodiscard]] std::string to_string(IntegratorKind integrator);

/// What --no-skip calls a skip, and what it is.
struct SkipName {
  const char* name;
  bool Skips::*on;
};
inline constexpr SkipName kSkipNames[] = {
    {"culling", &Skips::culling},           {"records", &Skips::records},
    {"light-behind", &Skips::light_behind}, {"weightless", &Skips::weightless},
    {"empty-tiles", &Skips::empty_tiles},   {"first-occluder", &Skips::first_occluder},
    {"divisions", &Skips::divisions},
};

}  // namespace raygate
