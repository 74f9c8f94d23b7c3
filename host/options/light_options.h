// Light options: the rows that say how light is followed, of ./render and of the Python module.
#pragma once

#include <cstdint>
#include <string>

#include "host/film/film.h"
#include "host/light/integrator_settings.h"
#include "host/options/option_table.h"
#include "host/render/render_options.h"

namespace raygate {

/// The most samples per pixel where --error says how many.
inline constexpr int kMostSamples = 1024;

/// The ranges of options that several programs have.
inline constexpr Range<int> kThreadRange{1, 1024}, kSideRange{1, 65536};
inline constexpr Range<double> kFovRange{0x1p-1022, 180.0 - 0x1p-45,
                                         "degrees above 0 and below 180"},
    kSmoothRange{0.0, 180.0, "degrees from 0 to 180"};

/// Adds to a table what sets `options`: integrator, samples, filter, depth and the like.
void add_light_options(OptionTable& table, RenderOptions& options);
/// The rows that show what the hardware does, and cannot change the picture.
void add_skip_options(OptionTable& table, RenderOptions& options);

/// A skip's name on the command line, and its switch.
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
