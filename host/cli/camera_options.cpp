#include "host/cli/camera_options.h"

#include <CLI/CLI.hpp>
#include <limits>

#include "host/base/input_error.h"
#include "host/cli/format.h"
#include "host/cli/option_text.h"

namespace raygate {
namespace {

constexpr double kLargest = std::numeric_limits<float>::max();

double number_in(const char* option, const std::string& text, double low, double high,
                 const char* expected) {
  const auto number = parse_number<double>(text);
  if (!number || !(*number >= low && *number <= high)) fail_value(option, text, expected);
  return *number;
}

}  // namespace

void declare_camera_options(CLI::App& app, RawCameraOptions& raw) {
  const auto value = [&app](const char* names, std::string& text) {
    app.add_option(names, text)->take_last();
  };
  value("--projection", raw.projection);
  value("--aperture", raw.aperture);
  value("--focus", raw.focus);
  value("--environment", raw.environment);
  value("--environment-rotation", raw.rotation);
  value("--environment-strength", raw.strength);
}

LensSetting parse_lens(const RawCameraOptions& raw, const LensSetting& setting) {
  LensSetting lens = setting;
  if (!raw.projection.empty()) {
    lens.projection = choose<Projection>("--projection", raw.projection,
                                         {{"perspective", Projection::kPerspective},
                                          {"orthographic", Projection::kOrthographic},
                                          {"panorama", Projection::kPanorama}});
  }
  if (!raw.aperture.empty()) {
    lens.aperture =
        number_in("--aperture", raw.aperture, 0.0, kLargest, "the radius of a lens, 0 or more");
  }
  if (!raw.focus.empty()) {
    lens.focus = number_in("--focus", raw.focus, std::numeric_limits<float>::min(), kLargest,
                           "a distance, more than 0");
  }
  return lens;
}

std::optional<EnvironmentSetting> parse_environment(
    const RawCameraOptions& raw, const std::optional<EnvironmentSetting>& setting) {
  std::optional<EnvironmentSetting> environment = setting;
  if (!raw.environment.empty()) {
    environment.emplace();
    environment->file = raw.environment;
  }
  if (!environment && !(raw.rotation.empty() && raw.strength.empty())) {
    throw InputError(
        std::string(raw.rotation.empty() ? "--environment-strength" : "--environment-rotation") +
        ": expected --environment beside it");
  }
  if (!raw.rotation.empty()) {
    environment->rotation = number_in("--environment-rotation", raw.rotation, -360.0, 360.0,
                                      "degrees from -360 to 360");
  }
  if (!raw.strength.empty()) {
    environment->strength =
        number_in("--environment-strength", raw.strength, 0.0, 1e9, "a factor from 0 to 1e9");
  }
  return environment;
}

std::vector<std::pair<std::string, std::string>> camera_option_values(
    const Camera& camera, const std::optional<EnvironmentSetting>& environment) {
  std::vector<std::pair<std::string, std::string>> words;
  if (camera.projection() != Projection::kPerspective) {
    words.emplace_back("projection", to_string(camera.projection()));
  }
  if (camera.aperture() > 0.0) {
    words.emplace_back("aperture", format_exactly(camera.aperture()));
    words.emplace_back("focus", format_exactly(camera.focus()));
  }
  if (environment) {
    words.emplace_back("environment", environment->file.filename().string());
    words.emplace_back("environmentRotation", format_exactly(environment->rotation));
    words.emplace_back("environmentStrength", format_exactly(environment->strength));
  }
  return words;
}

}  // namespace raygate
