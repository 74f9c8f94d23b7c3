// The options of rendering, of ./render and of the Python module: integrator, camera, environment.
#pragma once

#include <optional>
#include <string>

#include "host/app/load.h"
#include "host/app/option_table.h"
#include "host/render/render_settings.h"
#include "host/scene/scene.h"

namespace raygate {

/// Ranges of options that several programs have.
inline constexpr Range<int> kThreadRange{1, 1024}, kSideRange{1, 65536};
inline constexpr Range<double> kFovRange{0x1p-1022, 180.0 - 0x1p-45,
                                         "degrees above 0 and below 180"},
    kSmoothRange{0.0, 180.0, "degrees from 0 to 180"};

/// Adds the options of the integrator and of sampling to a table.
void add_light_options(OptionTable& table, RenderSettings& settings);
/// Adds the options that disable optimisations; they do not change the picture.
void add_skip_options(OptionTable& table, RenderSettings& settings);
void add_camera_options(OptionTable& table, CameraRequest& request);
void add_environment_options(OptionTable& table, std::optional<EnvironmentSetting>& environment);

/// With --error: sets the default of --spp. Throws InputError for too few samples. `dashes` precede
/// the names of options in messages; `spp`: its value as typed, or "".
void check_adaptive_samples(const std::string& dashes, const std::string& spp,
                            RenderSettings& settings);

/// The name of a skip for --no-skip, and its switch.
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
