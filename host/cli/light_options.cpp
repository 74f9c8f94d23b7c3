#include "host/cli/light_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <string_view>

#include "host/cli/values.h"
#include "host/exact/exact.h"
#include "host/scene/io/input_error.h"

namespace raygate {
namespace {

struct FilterName {
  const char* name;
  PixelFilter filter;
};
constexpr FilterName kFilterNames[] = {{"box", PixelFilter::kBox},
                                       {"tent", PixelFilter::kTent},
                                       {"gauss", PixelFilter::kGauss},
                                       {"blackman-harris", PixelFilter::kBlackmanHarris}};

[[noreturn]] void fail(const std::string& option, const std::string& text,
                       const std::string& expected) {
  throw InputError(option + ": expected " + expected + ", got '" + text + "'");
}

int parse_count(const char* option, const std::string& text, int low, int high) {
  const auto count = parse_number<int>(text);
  if (!count || *count < low || *count > high) {
    fail(option, text,
         "a whole number from " + std::to_string(low) + " to " + std::to_string(high));
  }
  return *count;
}

IntegratorKind parse_integrator(const std::string& text) {
  for (const IntegratorKind kind :
       {IntegratorKind::kPrimary, IntegratorKind::kWhitted, IntegratorKind::kPath}) {
    if (text == to_string(kind)) return kind;
  }
  fail("--integrator", text, "primary, whitted or path");
}

PixelFilter parse_filter(const std::string& text) {
  for (const FilterName& known : kFilterNames) {
    if (text == known.name) return known.filter;
  }
  fail("--filter", text, "box, tent, gauss or blackman-harris");
}

/// "inf": whatever the unit says.
float parse_point_error(const std::string& text) {
  constexpr double kLargest = std::numeric_limits<float>::max();
  const auto error = text == "inf" ? kLargest : parse_number<double>(text);
  if (!error || !(*error >= 0.0 && *error <= kLargest)) {
    fail("--point-error", text, "a share of the distance, 0 or more, or inf");
  }
  return float_below(*error);
}

/// "records,culling" or "all".
Skips parse_no_skip(const std::string& text) {
  Skips skips;
  std::string_view rest = text;
  for (bool more = true; more;) {
    const std::size_t comma = rest.find(',');
    const std::string_view name = rest.substr(0, comma);
    bool known = false;
    for (const SkipName& skip : kSkipNames) {
      if (name != skip.name && name != "all") continue;
      skips.*skip.on = false;
      known = true;
    }
    if (!known) {
      std::string names;
      for (const SkipName& skip : kSkipNames) names += std::string(skip.name) + ", ";
      fail("--no-skip", text, "some of " + names + "or all, with commas between");
    }
    more = comma != std::string_view::npos;
    if (more) rest.remove_prefix(comma + 1);
  }
  return skips;
}

}  // namespace

std::string to_string(IntegratorKind integrator) {
  switch (integrator) {
    case IntegratorKind::kPrimary:
      return "primary";
    case IntegratorKind::kWhitted:
      return "whitted";
    case IntegratorKind::kPath:
      return "path";
  }
  return "";
}

void declare_light_options(CLI::App& app, RawLightOptions& raw) {
  const auto value = [&app](const char* names, std::string& text, const char* form,
                            const char* help) {
    app.add_option(names, text, help)->type_name(form)->take_last();
  };
  value("--integrator", raw.integrator, "primary|whitted|path",
        "primary: camera rays, lit from the camera;\n"
        "whitted: shadows, reflection, refraction;\npath: all light, by chance (whitted)");
  value("--spp", raw.samples, "N", "samples of each pixel (1)");
  value("--filter", raw.filter, "NAME",
        "what of its surroundings a pixel shows, with\n"
        "more than one sample: box, tent, gauss,\nblackman-harris (blackman-harris)");
  value("--depth", raw.depth, "N",
        "reflections and refractions in a row (4; with\npath, where chance ends them sooner, 64)");
  value("--threshold", raw.threshold, "X",
        "whitted: the brightness, of 1, below which a\nray is not followed (0.00390625)");
  value("--ambient", raw.ambient, "X",
        "whitted: light from all sides, without shadows\n(the background's, or a guess from the "
        "lamps)");
  value("--point-error", raw.point_error, "X",
        "how far off, of the distance, the unit's point of\n"
        "a hit may be before the host computes it: 0\nalways, inf never (2^-16)");
  value("--no-skip", raw.no_skip, "NAMES",
        "do work that the picture does not need: culling,\n"
        "records, light-behind, weightless, empty-tiles,\n"
        "first-occluder, divisions (of the serial unit),\nor all; commas between them");
}

LightOptions parse_light_options(const RawLightOptions& raw) {
  LightOptions options;
  if (!raw.integrator.empty()) options.integrator = parse_integrator(raw.integrator);
  if (!raw.depth.empty()) options.depth = parse_count("--depth", raw.depth, 0, 1000);
  if (!raw.samples.empty()) options.samples = parse_count("--spp", raw.samples, 1, 1 << 20);
  if (!raw.filter.empty()) options.filter = parse_filter(raw.filter);
  if (!raw.threshold.empty()) {
    const auto threshold = parse_number<double>(raw.threshold);
    if (!threshold || !(*threshold >= 0.0 && *threshold <= 1.0)) {
      fail("--threshold", raw.threshold, "a number from 0 to 1");
    }
    options.threshold = *threshold;
  }
  if (!raw.ambient.empty()) {
    options.ambient = parse_number<double>(raw.ambient);
    if (!options.ambient || !(*options.ambient >= 0.0 && std::isfinite(*options.ambient))) {
      fail("--ambient", raw.ambient, "a radiance, 0 or more");
    }
  }
  if (!raw.point_error.empty()) options.point_error = parse_point_error(raw.point_error);
  if (!raw.no_skip.empty()) options.skips = parse_no_skip(raw.no_skip);
  return options;
}

}  // namespace raygate
