// The options that say what cameras look through, and what is around the scene.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "host/scene/camera.h"
#include "host/scene/io/light_settings.h"

namespace CLI {
class App;
}

namespace raygate {

/// As they were typed; empty where they were not given.
struct RawSkyLensOptions {
  std::string projection, aperture, focus, environment, rotation, strength;
};

void declare_sky_lens_options(CLI::App& app, RawSkyLensOptions& raw);

/// `setting`, changed by what was typed. Throws InputError, one line.
[[nodiscard]] LensSetting parse_lens(const RawSkyLensOptions& raw, const LensSetting& setting);
[[nodiscard]] std::optional<EnvironmentSetting> parse_environment(
    const RawSkyLensOptions& raw, const std::optional<EnvironmentSetting>& setting);

/// The options that say the same again, but for defaults: names and values.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> sky_lens_words(
    const Camera& camera, const std::optional<EnvironmentSetting>& environment);

}  // namespace raygate
