#include "host/cli/light_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <limits>

#include "host/base/input_error.h"
#include "host/cli/option_text.h"
#include "host/exact/exact.h"

namespace raygate {
namespace {

int parse_count(const char* option, const std::string& text, int low, int high) {
  const auto count = parse_number<int>(text);
  if (!count || *count < low || *count > high) {
    fail_value(option, text,
               "a whole number from " + std::to_string(low) + " to " + std::to_string(high));
  }
  return *count;
}

IntegratorKind parse_integrator(const std::string& text) {
  return choose<IntegratorKind>("--integrator", text,
                                {{"primary", IntegratorKind::kPrimary},
                                 {"whitted", IntegratorKind::kWhitted},
                                 {"path", IntegratorKind::kPath}});
}

ReconstructionFilter parse_filter(const std::string& text) {
  return choose<ReconstructionFilter>("--filter", text,
                                      {{"box", ReconstructionFilter::kBox},
                                       {"tent", ReconstructionFilter::kTent},
                                       {"gauss", ReconstructionFilter::kGauss},
                                       {"blackman-harris", ReconstructionFilter::kBlackmanHarris}});
}

/// "inf": whatever the unit says.
float parse_point_error(const std::string& text) {
  constexpr double kLargest = std::numeric_limits<float>::max();
  const auto error = text == "inf" ? kLargest : parse_number<double>(text);
  if (!error || !(*error >= 0.0 && *error <= kLargest)) {
    fail_value("--point-error", text, "a share of the distance, 0 or more, or inf");
  }
  return float_below(*error);
}

/// "records,culling" or "all".
Skips parse_no_skip(const std::string& text) {
  Skips skips;
  std::vector<std::string> names;
  for (const SkipName& skip : kSkipNames) names.emplace_back(skip.name);
  names.emplace_back("all");
  for (const std::string& name : split_at_commas(text)) {
    if (std::ranges::find(names, name) == names.end()) {
      std::string list;
      for (const std::string& known : names) list += (list.empty() ? "" : ", ") + known;
      fail_value("--no-skip", text, "some of " + list, did_you_mean(name, names));
    }
    for (const SkipName& skip : kSkipNames) {
      if (name == skip.name || name == "all") skips.*skip.on = false;
    }
  }
  return skips;
}

}  // namespace

std::string to_string(ReconstructionFilter filter) {
  switch (filter) {
    case ReconstructionFilter::kBox:
      return "box";
    case ReconstructionFilter::kTent:
      return "tent";
    case ReconstructionFilter::kGauss:
      return "gauss";
    case ReconstructionFilter::kBlackmanHarris:
      return "blackman-harris";
  }
  return "";
}

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
  const auto value = [&app](const char* names, std::string& text) {
    app.add_option(names, text)->take_last();
  };
  value("--integrator", raw.integrator);
  value("--spp", raw.samples);
  value("--error", raw.error);
  value("--samples", raw.range);
  value("--filter", raw.filter);
  value("--depth,--max-depth", raw.depth);
  value("--threshold", raw.threshold);
  value("--ambient", raw.ambient);
  value("--point-error", raw.point_error);
  value("--no-skip", raw.no_skip);
}

LightOptions parse_light_options(const RawLightOptions& raw) {
  LightOptions options;
  if (!raw.integrator.empty()) options.integrator = parse_integrator(raw.integrator);
  if (!raw.depth.empty()) options.depth = parse_count("--depth", raw.depth, 0, 1000);
  if (!raw.samples.empty()) options.samples = parse_count("--spp", raw.samples, 1, 1 << 20);
  if (!raw.error.empty()) {
    const auto error = parse_number<double>(raw.error);
    if (!error || !(*error > 0.0 && *error <= 255.0)) {
      fail_value("--error", raw.error, "steps of an 8-bit display, above 0 and up to 255");
    }
    options.error = *error;
  }
  if (!raw.range.empty()) {
    options.range = parse_sample_range(raw.range);
    if (!options.range)
      fail_value("--samples", raw.range, "A:B, from sample A to before sample B of --spp");
  }
  if (!raw.filter.empty()) options.filter = parse_filter(raw.filter);
  if (!raw.threshold.empty()) {
    const auto threshold = parse_number<double>(raw.threshold);
    if (!threshold || !(*threshold >= 0.0 && *threshold <= 1.0)) {
      fail_value("--threshold", raw.threshold, "a number from 0 to 1");
    }
    options.threshold = *threshold;
  }
  if (!raw.ambient.empty()) {
    options.ambient = parse_number<double>(raw.ambient);
    if (!options.ambient || !(*options.ambient >= 0.0 && std::isfinite(*options.ambient))) {
      fail_value("--ambient", raw.ambient, "a radiance, 0 or more");
    }
  }
  if (!raw.point_error.empty()) options.point_error = parse_point_error(raw.point_error);
  if (!raw.no_skip.empty()) options.skips = parse_no_skip(raw.no_skip);
  return options;
}

}  // namespace raygate
