// The program `compare`: how far an EXR picture is from a reference.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "host/cli/option_text.h"
#include "host/cli/process.h"
#include "host/cli/version.h"
#include "host/film/compare.h"
#include "host/film/false_color.h"
#include "host/film/pending_file.h"
#include "host/film/png.h"
#include "host/scene/io/input_error.h"

namespace raygate {
namespace {

constexpr int kTooFar = 1;

constexpr const char* kFooter =
    "Measures, over the pixels that both pictures hold, of PICTURE minus REFERENCE:\n"
    "  rmse, mse      root of the mean square, and the mean square\n"
    "  mae, max       mean and greatest magnitude\n"
    "  relative_mse   mean of the squares over (REFERENCE squared + 0.01)\n"
    "  psnr           decibels, of a peak of 1; infinite for equal pictures\n"
    "  ssim           structural similarity (Wang et al., 2004) of what a display shows, at most "
    "1\n"
    "  differing      pixels with any difference, however small\n"
    "  not_finite     pixels with a NaN or an infinity in one picture alone; they make errors\n"
    "                 infinite\n"
    "\n"
    "Exit status:\n"
    "  0  compared, and within all thresholds\n"
    "  1  a threshold is exceeded\n"
    "  2  a picture or the command line cannot be used\n"
    "\n"
    "Example:\n"
    "  ./compare noisy.exr converged.exr --threshold rmse=0.02 --difference error.png";

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
          {"max", c.max, false},
          {"relative_mse", c.relative_mse, false},
          {"psnr", c.psnr, true},
          {"ssim", c.ssim, true},
          {"differing", static_cast<double>(c.differing), false},
          {"not_finite", static_cast<double>(c.not_finite), false}};
}

/// "MEASURE=VALUE" against the measures: whether it is kept. Throws InputError.
bool is_kept(const std::string& text, const std::vector<Measure>& measures) {
  const std::size_t equals = std::min(text.find('='), text.size());
  const std::string name = text.substr(0, equals);
  const auto limit =
      parse_number<double>(std::string_view(text).substr(std::min(equals + 1, text.size())));
  std::string names;
  for (const Measure& measure : measures) {
    names += (names.empty() ? "" : ", ") + std::string(measure.name);
    if (measure.name != name || !limit || std::isnan(*limit)) continue;
    if (!measure.value) {
      throw InputError("--threshold: " + name + " needs channels R,G,B and 11x11 pixels");
    }
    return measure.more_is_better ? *measure.value >= *limit : *measure.value <= *limit;
  }
  throw InputError("--threshold: expected MEASURE=NUMBER with one of " + names + ", got '" + text +
                   "'");
}

std::vector<std::string> channel_names(const std::string& list) {
  const std::vector<std::string> names = split_at_commas(list);
  if (std::ranges::find(names, "") != names.end()) {
    fail_value("--channels", list, "names with commas between");
  }
  return names;
}

/// Numbers that JSON has no word for become strings.
nlohmann::ordered_json number(const std::optional<double>& value) {
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
  for (const Measure& measure : measures) json[measure.name] = number(measure.value);
  std::printf("%s\n", json.dump(2, ' ', true).c_str());
}

/// The differences in false colours; black where one picture alone is not finite.
void write_difference(const CompareOptions& options, const ChannelPicture& picture,
                      const Comparison& comparison) {
  std::vector<float> values(comparison.difference.begin(), comparison.difference.end());
  const Channel channel{"difference", Channel::Type::kFloat, values.data(), sizeof(float)};
  Scale scale{0.0, options.scale};
  if (options.scale == 0.0) scale.high = scale_of(channel, values.size()).high;
  const Picture8 shown =
      false_color(picture.width, picture.height, comparison.window, channel, scale);
  PendingFile(options.difference, encode_png(shown)).commit();
  print("wrote         " + options.difference + ", " + shown.texts.at(0).second + "\n",
        options.json ? stderr : stdout);
}

int compare_files(const CompareOptions& options) {
  if (!options.difference.empty()) {
    const std::filesystem::path outputs[] = {options.difference};
    const std::filesystem::path inputs[] = {options.picture, options.reference};
    require_others(outputs, inputs);
    require_writable(options.difference);
  }
  const std::vector<std::string> names = channel_names(options.channels);
  const ChannelPicture picture = read_exr(options.picture, names);
  const ChannelPicture reference = read_exr(options.reference, names);
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
  CLI::App app("Says how far an OpenEXR picture is from a reference.", "compare");
  app.footer(kFooter);
  app.get_formatter()->column_width(30);
  app.add_option("picture", options.picture, "an OpenEXR file")->type_name("PICTURE")->required();
  app.add_option("reference", options.reference, "what it should be like")
      ->type_name("REFERENCE")
      ->required();
  app.add_option("--threshold", options.thresholds,
                 "exit with status 1 if that measure is worse;\nmay be given several times")
      ->type_name("MEASURE=VALUE")
      ->allow_extra_args(false);
  app.add_option("--difference", options.difference,
                 "the largest difference of each pixel's\nchannels in false colours")
      ->type_name("FILE.png");
  app.add_option("--scale", options.scale, "the difference that is yellow there (the largest)")
      ->type_name("NUMBER")
      ->check(CLI::PositiveNumber);
  app.add_option("--channels", options.channels, "what is compared (R,G,B)")->type_name("NAMES");
  app.add_flag("--json", options.json, "the measures as a JSON object");
  app.set_help_flag("-h,--help", "print this help");
  app.set_version_flag("--version", std::string(kSoftware), "print the version");
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    print(app.help());
    return 0;
  } catch (const CLI::CallForVersion&) {
    print(std::string(kSoftware) + "\n");
    return 0;
  } catch (const CLI::ParseError& error) {
    throw InputError(std::string(error.what()) + " (see --help)");
  }
  return compare_files(options);
}

}  // namespace
}  // namespace raygate

int main(int argc, char** argv) {
  // 1 says that a threshold is exceeded, so a fault of ours has to be 2 as well.
  return raygate::run_guarded([&] { return raygate::run(argc, argv); }, 2);
}
