// The program `compare`: how far a picture is from a reference.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "host/app/option_table.h"
#include "host/app/process.h"
#include "host/base/input_error.h"
#include "host/film/atomic_file.h"
#include "host/film/compare.h"
#include "host/film/display.h"
#include "host/film/false_color.h"

namespace raygate {
namespace {

constexpr int kTooFar = 1;

constexpr const char* kAbout = R"(Usage: ./compare PICTURE REFERENCE [options]

Compares a picture with a reference, over the pixels that both hold: OpenEXR, or
PNG as the light that a display shows.

  ./compare a.png b.png
  ./compare noisy.exr converged.exr --threshold rmse=0.02 --difference error.png
)";

constexpr const char* kFooter = R"(Measures of PICTURE minus REFERENCE
  rmse, mse                  root of the mean square; mean square
  mae, max                   mean and greatest magnitude
  bias                       sum / that of REFERENCE: -0.01 is 1 % too dark; a
                             threshold is of its magnitude
  relative_mse               mean of square / (REFERENCE squared + 0.01)
  psnr                       decibels of a peak of 1; infinite if equal
  ssim                       structural similarity (Wang et al., 2004) of what a
                             display shows, at most 1
  differing                  pixels with any difference, however small
  not_finite                 pixels with a NaN or an infinity in one picture
                             only, which make the errors infinite

Exit status: 0 within all thresholds; 1 a threshold is exceeded; 2 a picture,
the command line or an output cannot be used.)";

struct CompareOptions {
  std::string picture, reference, difference;
  std::vector<std::string> thresholds;
  std::string channels = "R,G,B";
  double scale = 0.0;  ///< of the difference picture; 0: up to its largest difference
  bool json = false;
};

struct Measure {
  const char* name;
  std::optional<double> value;
  bool more_is_better;
};

std::vector<Measure> measures_of(const Comparison& c) {
  return {{"rmse", c.rmse, false},
          {"mse", c.mse, false},
          {"mae", c.mae, false},
          {"bias", c.bias, false},
          {"max", c.max, false},
          {"relative_mse", c.relative_mse, false},
          {"psnr", c.psnr, true},
          {"ssim", c.ssim, true},
          {"differing", static_cast<double>(c.differing), false},
          {"not_finite", static_cast<double>(c.not_finite), false}};
}

/// Returns whether the measures meet a threshold "MEASURE=VALUE". Throws InputError.
bool is_kept(const std::string& text, const std::vector<Measure>& measures) {
  const auto [name, number] = split_at_equals(text);
  const auto limit = parse_number<double>(number);
  std::vector<std::string> names;
  for (const Measure& measure : measures) {
    names.emplace_back(measure.name);
    if (measure.name != name || !limit || std::isnan(*limit)) continue;
    if (!measure.value) {
      throw InputError("--threshold: " + name + " needs channels R,G,B and 11x11 pixels");
    }
    return measure.more_is_better ? *measure.value >= *limit : std::abs(*measure.value) <= *limit;
  }
  const bool is_known = std::ranges::find(names, name) != names.end();
  fail_value("--threshold", text, "MEASURE=NUMBER with one of " + listed(names, ", "),
             is_known ? "" : did_you_mean(name, names));
}

std::vector<std::string> channel_names(const std::string& list) {
  const std::vector<std::string> names = split_at_commas(list);
  if (std::ranges::find(names, "") != names.end()) {
    fail_value("--channels", list, "names with commas between");
  }
  return names;
}

/// Returns a number as JSON; infinity and NaN become strings.
nlohmann::ordered_json json_of(const std::optional<double>& value) {
  if (!value) return nullptr;
  if (std::isfinite(*value)) return *value;
  return std::isnan(*value) ? "nan" : *value > 0.0 ? "inf" : "-inf";
}

void print_text(const Comparison& c, const std::vector<Measure>& measures) {
  std::printf("pixels        %llu of [%d, %d) x [%d, %d)\n",
              static_cast<unsigned long long>(c.pixels), c.window.x0, c.window.x1, c.window.y0,
              c.window.y1);
  for (const Measure& measure : measures) {
    if (measure.value) std::printf("%-13s %.9g\n", measure.name, *measure.value);
  }
}

void print_json(const Comparison& c, const std::vector<Measure>& measures) {
  nlohmann::ordered_json json = {{"pixels", c.pixels},
                                 {"window", {c.window.x0, c.window.y0, c.window.x1, c.window.y1}}};
  for (const Measure& measure : measures) json[measure.name] = json_of(measure.value);
  std::printf("%s\n", json.dump(2, ' ', true).c_str());
}

/// Returns the differences in false colours; black where only one picture is finite.
void write_difference(const CompareOptions& options, const ChannelPicture& picture,
                      const Comparison& comparison) {
  std::vector<float> values(comparison.difference.begin(), comparison.difference.end());
  const Channel channel{"difference", Channel::Type::kFloat, values.data(), sizeof(float)};
  Scale scale{0.0, options.scale};
  if (options.scale == 0.0) scale.high = scale_of(channel, values.size()).high;
  const Image8 shown =
      false_color(picture.width, picture.height, comparison.window, channel, scale);
  AtomicFile(options.difference, encode_png(shown)).commit();
  print("wrote         " + printable(options.difference) + ", " + shown.texts.at(0).second + "\n",
        options.json ? stderr : stdout);
}

int compare_files(const CompareOptions& options) {
  if (!options.difference.empty()) {
    const std::filesystem::path outputs[] = {options.difference};
    const std::filesystem::path inputs[] = {options.picture, options.reference};
    require_distinct(outputs, inputs);
    if (std::filesystem::path(options.difference).extension() != ".png") {
      fail_value("--difference", options.difference, "FILE.png");
    }
    require_writable(options.difference);
  }
  const std::vector<std::string> names = channel_names(options.channels);
  const ChannelPicture picture = read_picture(options.picture, names);
  const ChannelPicture reference = read_picture(options.reference, names);
  const Comparison comparison = compare(picture, reference);
  const std::vector<Measure> measures = measures_of(comparison);
  std::vector<std::string> exceeded;
  for (const std::string& threshold : options.thresholds) {
    if (!is_kept(threshold, measures)) exceeded.push_back(threshold);
  }
  (options.json ? print_json : print_text)(comparison, measures);
  if (!options.difference.empty()) write_difference(options, picture, comparison);
  for (const std::string& threshold : exceeded) {
    print("threshold " + threshold + " is exceeded\n", stderr);
  }
  return exceeded.empty() ? 0 : kTooFar;
}

int run(int argc, char** argv) {
  CompareOptions options;
  OptionTable table(kAbout, kFooter);
  table.positional(options.picture);
  table.positional(options.reference);
  table.group("Options");
  table.add(
      "--threshold", "MEASURE=NUMBER",
      "exit with status 1 if that measure is worse; may be given several times",
      [&](const auto&, const std::string& text) { options.thresholds.push_back(text); }, {},
      kNowhere, true);
  table.text("--difference", "FILE.png",
             "the largest difference of each pixel's channels in false colours",
             options.difference);
  table.number("--scale", "NUMBER", "the difference that is yellow there (the largest)",
               options.scale,
               Range{std::numeric_limits<double>::min(), std::numeric_limits<double>::max(),
                     "a number above 0"});
  table.text("--channels", "NAMES", "the channels to compare (R,G,B)", options.channels);
  table.flag("--json", "print the measures as a JSON object", options.json);
  const std::string information =
      table.parse({argv + 1, argv + argc}, "a third picture; two are compared");
  if (!information.empty()) {
    print(information);
    return 0;
  }
  if (options.reference.empty()) throw InputError("expected PICTURE and REFERENCE (see --help)");
  if (options.scale > 0.0 && options.difference.empty()) {
    throw InputError("--scale: expected --difference beside it");
  }
  return compare_files(options);
}

}  // namespace
}  // namespace raygate

int main(int argc, char** argv) {
  // 1 says that a threshold is exceeded, so a fault of ours has to be 2 as well.
  return raygate::run_guarded([&] { return raygate::run(argc, argv); }, 2);
}
