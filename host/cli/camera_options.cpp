#include "host/cli/camera_options.h"

#include <cmath>
#include <limits>

#include "host/base/input_error.h"
#include "host/options/light_options.h"

namespace raygate {
namespace {

constexpr double kLargest = std::numeric_limits<float>::max();

CameraSetting parse_camera(const std::string& option, const std::string& text) {
  const auto numbers = parse_list<double>(text);
  if (!numbers || (numbers->size() != 6 && numbers->size() != 7)) {
    fail_value(option, text, "EX,EY,EZ,TX,TY,TZ or EX,EY,EZ,TX,TY,TZ,FOV (eye, target, degrees)");
  }
  const std::vector<double>& n = *numbers;
  for (const double number : n) {
    if (!std::isfinite(number)) fail_value(option, text, "finite numbers");
  }
  CameraSetting camera{{n[0], n[1], n[2]}, {n[3], n[4], n[5]}, std::nullopt, std::nullopt};
  if (camera.eye == camera.target) fail_value(option, text, "an eye and a target that differ");
  if (n.size() == 7) {
    if (n[6] <= 0.0 || n[6] >= 180.0) {
      fail_value(option, text, "a field of view above 0 and below 180 degrees");
    }
    camera.fov = n[6];
  }
  return camera;
}

std::pair<double, double> parse_view(const std::string& option, const std::string& text) {
  constexpr double kIso = 35.264389682754654;  // all three axes look equally long
  constexpr std::pair<const char*, std::pair<double, double>> kNames[] = {
      {"front", {0, 0}}, {"back", {180, 0}},  {"left", {-90, 0}},  {"right", {90, 0}},
      {"top", {0, 90}},  {"iso", {45, kIso}}, {"bottom", {0, -90}}};
  for (const auto& [name, angles] : kNames) {
    if (text == name) return angles;
  }
  const auto angles = parse_list<double>(text);
  if (!angles || angles->size() != 2 || !(std::abs((*angles)[0]) <= 360.0) ||
      !(std::abs((*angles)[1]) <= 90.0)) {
    fail_value(option, text,
               "front, back, left, right, top, bottom, iso, or AZIMUTH,ELEVATION in degrees (from "
               "-360 to 360, and from -90 to 90)");
  }
  return {(*angles)[0], (*angles)[1]};
}

/// A choice of values that are there or not; --help says what is there by default.
template <typename T>
OptionTable::Read chosen(std::optional<T>& target, const Choices<T>& choices) {
  return [&target, choices](const std::string& option, const std::string& text) {
    target = choose(option, text, choices);
  };
}

}  // namespace

void add_camera_options(OptionTable& table, CameraOptions& options) {
  table.add("--camera", "EX,EY,EZ,TX,TY,TZ[,FOV]",
            "eye, target, vertical field of view (the scene's, or a view of it all)",
            [&options](const std::string& option, const std::string& text) {
              options.camera = parse_camera(option, text);
              options.path.clear();
            });
  table.add("--view", "NAME|AZ,EL",
            "the whole scene: front, back, left, right, top, bottom, iso, or azimuth and elevation "
            "(33,24)",
            [&options](const std::string& option, const std::string& text) {
              options.angles = parse_view(option, text);
              options.camera.reset();
              options.path.clear();
            });
  table.add("--up", "AXIS", "up axis: x, -x, y, -y, z or -z (guessed)",
            chosen<glm::dvec3>(options.up, {{"x", {1, 0, 0}},
                                            {"y", {0, 1, 0}},
                                            {"z", {0, 0, 1}},
                                            {"-x", {-1, 0, 0}},
                                            {"-y", {0, -1, 0}},
                                            {"-z", {0, 0, -1}}}));
  table.number("--fov", "DEGREES", "vertical field of view of any camera (35)", options.fov,
               kFovRange);
  table.add(
      "--projection", "NAME", "perspective (default), orthographic or panorama",
      chosen<Projection>(options.lens.projection, {{"perspective", Projection::kPerspective},
                                                   {"orthographic", Projection::kOrthographic},
                                                   {"panorama", Projection::kPanorama}}));
  table.number("--aperture", "R", "lens radius for depth of field; needs --spp (0)",
               options.lens.aperture, Range{0.0, kLargest, "the radius of a lens, 0 or more"});
  table.number(
      "--focus", "D", "focus distance (the target's)", options.lens.focus,
      Range<double>{std::numeric_limits<float>::min(), kLargest, "a distance, more than 0"});
  table.add("--ground", "on|off", "shadow-catcher ground (on in default outdoor views)",
            chosen<bool>(options.ground, {{"on", true}, {"off", false}}));
}

void add_environment_options(OptionTable& table, std::optional<EnvironmentSetting>& environment) {
  table.add(
      "--environment", "FILE", "environment map: EXR or HDR, latitude-longitude",
      [&environment](const auto&, const std::string& text) { environment.emplace().file = text; });
  const auto add = [&](const char* name, const char* value, const char* help,
                       double EnvironmentSetting::*target, const Range<double>& range) {
    table.add(name, value, help,
              [&environment, target, range](const std::string& option, const std::string& text) {
                if (!environment) throw InputError(option + ": expected --environment beside it");
                const auto number = parse_number<double>(text);
                if (!number || !range.contains(*number)) fail_value(option, text, range.text());
                (*environment).*target = *number;
              });
  };
  add("--environment-rotation", "DEG", "counter-clockwise, seen from above (0)",
      &EnvironmentSetting::rotation, {-360.0, 360.0, "degrees from -360 to 360"});
  add("--environment-strength", "X", "radiance multiplier (1)", &EnvironmentSetting::strength,
      {0.0, 1e9, "a factor from 0 to 1e9"});
}

std::vector<std::pair<std::string, std::string>> camera_option_values(
    const Camera& camera, const std::optional<EnvironmentSetting>& environment) {
  std::vector<std::pair<std::string, std::string>> values;
  if (camera.projection() != Projection::kPerspective) {
    values.emplace_back("projection", to_string(camera.projection()));
  }
  if (camera.aperture() > 0.0) {
    values.emplace_back("aperture", number_text(camera.aperture()));
    values.emplace_back("focus", number_text(camera.focus()));
  }
  if (environment) {
    values.emplace_back("environment", environment->file.filename().string());
    values.emplace_back("environmentRotation", number_text(environment->rotation));
    values.emplace_back("environmentStrength", number_text(environment->strength));
  }
  return values;
}

}  // namespace raygate
