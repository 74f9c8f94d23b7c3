#include "host/options/light_options.h"

#include <limits>
#include <vector>

#include "host/exact/exact.h"
#include "host/film/film.h"
#include "host/film/merge.h"

namespace raygate {
namespace {

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
  constexpr double kLargest = std::numeric_limits<float>::max();
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

}  // namespace

void add_light_options(OptionTable& table, RenderOptions& options) {
  constexpr double kAboveZero = std::numeric_limits<double>::min(),
                   kFinite = std::numeric_limits<double>::max();
  table.choice("--integrator", "NAME",
               "primary: camera rays alone; whitted: shadows, reflection, refraction; path: all "
               "global illumination ({}; path with an environment)",
               options.integrator, integrator_choices(), kInExr | kInStats | kInPython);
  table.number("--spp", "N", "samples per pixel ({}; path by an environment: 16)", options.samples,
               Range{1, 1 << 20}, kInExr | kInStats | kInPython);
  table.number("--error", "X",
               "adaptive sampling to error X, in steps of an 8-bit display: stop a pixel after 16 "
               "samples if its error is X, after n if it is X n / 16",
               options.error,
               Range{kAboveZero, 255.0, "steps of an 8-bit display, above 0 and up to 255"},
               kInExr | kInStats);
  table.add("--samples", "A:B", "render only samples A to B-1, for ./merge",
            [&options](const std::string& option, const std::string& text) {
              const auto range = parse_sample_range(text);
              if (!range) {
                fail_value(option, text, "A:B, from sample A to before sample B of --spp");
              }
              options.first_sample = range->first;
              options.end_sample = range->end;
            });
  table.choice("--filter", "NAME", "pixel filter: box, tent, gauss or {}", options.filter,
               filter_choices(), kInExr | kInPython);
  table.add(
      "--depth,--max-depth", "N", "reflections and refractions in a row (4; path: 64)",
      [&options](const std::string& option, const std::string& text) {
        const Range range{0, 1000};
        const auto depth = parse_number<int>(text);
        if (!depth || !range.contains(*depth)) fail_value(option, text, range.text());
        options.max_depth = depth;
      },
      [&options] { return std::to_string(options.depth()); }, kInExr | kInStats | kInPython);
  table.add(
      "--caustics", "WHEN", "path: light paths find caustics: on, off or auto",
      [&options](const std::string& option, const std::string& text) {
        options.caustics = choose(option, text, caustics_choices());
      },
      // The default is not written: pictures without mirrors and glass keep their bytes.
      [&options] {
        return options.caustics == Caustics::kAuto ? std::string()
                                                   : name_of(caustics_choices(), options.caustics);
      },
      kInExr | kInPython);
  table.number("--threshold", "X", "whitted: ignore rays that weigh less ({})", options.threshold,
               Range{0.0, 1.0}, kInExr | kInPython);
  table.number("--ambient", "X", "whitted: ambient radiance (background or lights)",
               options.ambient, Range{0.0, kFinite, "a radiance, 0 or more"}, kInExr | kInPython);
  table.number("--seed", "N", "seed of the random numbers ({})", options.seed,
               Range<std::uint64_t>{0, std::numeric_limits<std::uint64_t>::max()},
               kInStats | kInPython);
}

void add_skip_options(OptionTable& table, RenderOptions& options) {
  table.add(
      "--point-error", "X",
      "compute points on the host where the unit's may be off by X of t (2^-16; 0: always; inf: "
      "never)",
      [&options](const std::string& option, const std::string& text) {
        options.point_error = parse_point_error(option, text);
      },
      [&options] { return number_text(double{options.point_error}); }, kInExr);
  table.add("--no-skip", "NAMES",
            "do work that cannot change the picture: culling, records, light-behind, weightless, "
            "empty-tiles, first-occluder, divisions or all",
            [&options](const std::string& option, const std::string& text) {
              options.skips = parse_no_skip(option, text);
            });
}

}  // namespace raygate
