#include "host/app/render_options.h"

#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "host/base/input_error.h"
#include "host/exact/exact.h"
#include "host/film/film.h"
#include "host/film/merge.h"
#include "host/render/adaptive_sampling.h"

namespace raygate {
namespace {

constexpr double kLargest = std::numeric_limits<float>::max();

Choices<IntegratorKind> integrator_choices() {
  return {{"primary", IntegratorKind::kPrimary},
          {"whitted", IntegratorKind::kWhitted},
          {"path", IntegratorKind::kPath}};
}
Choices<ReconstructionFilter> filter_choices() {
  return {{"box", ReconstructionFilter::kBox},
          {"tent", ReconstructionFilter::kTent},
          {"gauss", ReconstructionFilter::kGauss},
          {"blackman-harris", ReconstructionFilter::kBlackmanHarris}};
}

Choices<Caustics> caustics_choices() {
  return {{"on", Caustics::kOn}, {"off", Caustics::kOff}, {"auto", Caustics::kAuto}};
}

/// "inf": the unit's point wherever it has one.
float parse_point_error(const std::string& option, const std::string& text) {
  const auto error = text == "inf" ? kLargest : parse_number<double>(text);
  if (!error || !(*error >= 0.0 && *error <= kLargest)) {
    fail_value(option, text, "a share of the distance, 0 or more, or inf");
  }
  return float_below(*error);
}

/// "records,culling" or "all".
Skips parse_no_skip(const std::string& option, const std::string& text) {
  Skips skips;
  std::vector<std::string> names;
  for (const SkipName& skip : kSkipNames) names.emplace_back(skip.name);
  names.emplace_back("all");
  for (const std::string& name : choose_some(option, text, names)) {
    for (const SkipName& skip : kSkipNames) {
      if (name == skip.name || name == "all") skips.*skip.on = false;
    }
  }
  return skips;
}

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

/// Returns a reader of an optional choice; the help text says the default.
template <typename T>
OptionTable::Read chosen(std::optional<T>& target, const Choices<T>& choices) {
  return [&target, choices](const std::string& option, const std::string& text) {
    target = choose(option, text, choices);
  };
}

}  // namespace

void add_light_options(OptionTable& table, RenderSettings& settings) {
  constexpr double kAboveZero = std::numeric_limits<double>::min(),
                   kFinite = std::numeric_limits<double>::max();
  table.choice("--integrator", "NAME",
               "primary: camera rays alone; whitted: shadows, reflection, refraction; path: all "
               "global illumination ({}; path with an environment)",
               settings.integrator, integrator_choices(),
               kInExr | kInStats | kInPython | kInSceneFile | kInPage);
  table.number("--spp", "N", "samples per pixel ({}; path by an environment: 16)", settings.samples,
               Range{1, 1 << 20}, kInExr | kInStats | kInPython | kInSceneFile | kInPage);
  table.number("--error", "X",
               "adaptive sampling to error X, in steps of an 8-bit display: stop a pixel after 16 "
               "samples if its error is X, after n if it is X n / 16",
               settings.error,
               Range{kAboveZero, 255.0, "steps of an 8-bit display, above 0 and up to 255"},
               kInExr | kInStats | kInPython | kInSceneFile);
  table.add("--samples", "A:B", "render only samples A to B-1, for ./merge",
            [&settings](const std::string& option, const std::string& text) {
              const auto range = parse_sample_range(text);
              if (!range) {
                fail_value(option, text, "A:B, from sample A to before sample B of --spp");
              }
              settings.first_sample = range->first;
              settings.end_sample = range->end;
            });
  table.choice("--filter", "NAME", "pixel filter: box, tent, gauss or {}", settings.filter,
               filter_choices(), kInExr | kInPython | kInSceneFile | kInPage);
  table.add(
      "--depth,--max-depth", "N", "reflections and refractions in a row (4; path: 64)",
      [&settings](const std::string& option, const std::string& text) {
        const Range range{0, 1000};
        const auto depth = parse_number<int>(text);
        if (!depth || !range.contains(*depth)) fail_value(option, text, range.text());
        settings.max_depth = depth;
      },
      [&settings] { return std::to_string(settings.depth()); },
      kInExr | kInStats | kInPython | kInSceneFile | kInPage);
  table.add(
      "--caustics", "WHEN", "path: light paths find caustics: on, off or auto",
      [&settings](const std::string& option, const std::string& text) {
        settings.caustics = choose(option, text, caustics_choices());
      },
      // The default is not written: pictures without mirrors and glass keep their bytes.
      [&settings] {
        return settings.caustics == Caustics::kAuto
                   ? std::string()
                   : name_of(caustics_choices(), settings.caustics);
      },
      kInExr | kInPython);
  table.number("--threshold", "X", "whitted: ignore rays that weigh less ({})", settings.threshold,
               Range{0.0, 1.0}, kInExr | kInPython | kInSceneFile | kInPage);
  table.number("--ambient", "X", "whitted: ambient radiance (background or lights)",
               settings.ambient, Range{0.0, kFinite, "a radiance, 0 or more"},
               kInExr | kInPython | kInSceneFile | kInPage);
  table.number("--seed", "N", "seed of the random numbers ({})", settings.seed,
               Range<std::uint64_t>{0, std::numeric_limits<std::uint64_t>::max()},
               kInStats | kInPython | kInSceneFile | kInPage);
}

void check_adaptive_samples(const std::string& dashes, const std::string& spp,
                            RenderSettings& settings) {
  constexpr int kMostSamples = 1024;
  if (settings.error == 0.0) return;
  if (spp.empty()) settings.samples = kMostSamples;
  if (settings.samples <= kMinAdaptiveSamples) {
    fail_value(dashes + "spp", spp,
               "more than the " + std::to_string(kMinAdaptiveSamples) + " that " + dashes +
                   "error begins with");
  }
}

void add_skip_options(OptionTable& table, RenderSettings& settings) {
  table.add(
      "--point-error", "X",
      "compute points on the host where the unit's may be off by X of t (2^-16; 0: always; inf: "
      "never)",
      [&settings](const std::string& option, const std::string& text) {
        settings.point_error = parse_point_error(option, text);
      },
      [&settings] { return number_text(double{settings.point_error}); }, kInExr | kInPage);
  table.add(
      "--no-skip", "NAMES",
      "do work that cannot change the picture: culling, records, light-behind, weightless, "
      "empty-tiles, first-occluder, divisions or all",
      [&settings](const std::string& option, const std::string& text) {
        settings.skips = parse_no_skip(option, text);
      },
      {}, kInPage);
}

void add_camera_options(OptionTable& table, CameraRequest& request) {
  table.add(
      "--camera", "EX,EY,EZ,TX,TY,TZ[,FOV]",
      "eye, target, vertical field of view (the scene's, or a view of it all)",
      [&request](const std::string& option, const std::string& text) {
        request.camera = parse_camera(option, text);
      },
      {}, kInPage);
  table.add(
      "--view", "NAME|AZ,EL",
      "the whole scene: front, back, left, right, top, bottom, iso, or azimuth and elevation "
      "(33,24)",
      [&request](const std::string& option, const std::string& text) {
        request.angles = parse_view(option, text);
        request.camera.reset();
      },
      {}, kInPage);
  table.add("--up", "AXIS", "up axis: x, -x, y, -y, z or -z (that of the format)",
            chosen<glm::dvec3>(request.up, {{"x", {1, 0, 0}},
                                            {"y", {0, 1, 0}},
                                            {"z", {0, 0, 1}},
                                            {"-x", {-1, 0, 0}},
                                            {"-y", {0, -1, 0}},
                                            {"-z", {0, 0, -1}}}),
            {}, kInPage);
  table.number("--fov", "DEGREES", "vertical field of view of any camera (35)", request.fov,
               kFovRange, kInPage);
  table.add(
      "--projection", "NAME", "perspective (default), orthographic or panorama",
      chosen<Projection>(request.lens.projection, {{"perspective", Projection::kPerspective},
                                                   {"orthographic", Projection::kOrthographic},
                                                   {"panorama", Projection::kPanorama}}),
      {}, kInPage);
  table.number("--aperture", "R", "lens radius for depth of field; needs --spp (0)",
               request.lens.aperture, Range{0.0, kLargest, "the radius of a lens, 0 or more"},
               kInPage);
  table.number(
      "--focus", "D", "focus distance (the target's)", request.lens.focus,
      Range<double>{std::numeric_limits<float>::min(), kLargest, "a distance, more than 0"},
      kInPage);
  table.add("--ground", "on|off", "shadow-catcher ground (on in default outdoor views)",
            chosen<bool>(request.ground, {{"on", true}, {"off", false}}));
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

}  // namespace raygate
