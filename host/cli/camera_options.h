// The options that say what cameras look through, and what is around the scene.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "host/scene/camera.h"
#include "host/scene/scene.h"

namespace CLI {
class App;
}

namespace raygate {

/// As they were typed; empty where they were not given.
struct RawCameraOptions {
  std::string projection, aperture, focus, environment, rotation, strength;
};

void declare_camera_options(CLI::App& app, RawCameraOptions& raw);

/// `setting`, changed by what was typed. Throws InputError, one line.
[[nodiscard]] LensSetting parse_lens(const RawCameraOptions& raw, const LensSetting& setting);
[[nodiscard]] std::optional<EnvironmentSetting> parse_environment(
    const RawCameraOptions& raw, const std::optional<EnvironmentSetting>& setting);

/// The options that say the same again, but for defaults: names and values.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> camera_option_values(
    const Camera& camera, const std::optional<EnvironmentSetting>& environment);

}  // namespace raygate
