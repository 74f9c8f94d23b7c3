#include "host/cli/output_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <string_view>
#include <utility>

#include "host/base/input_error.h"
#include "host/cli/option_text.h"

namespace raygate {
namespace {

constexpr std::pair<std::string_view, bool ExtraChannels::*> kExtraChannels[] = {
    {"P", &ExtraChannels::position},      {"Albedo", &ExtraChannels::albedo},
    {"objectId", &ExtraChannels::object}, {"tests", &ExtraChannels::tests},
    {"doubts", &ExtraChannels::doubts},   {"sums", &ExtraChannels::sums}};

constexpr const char* kStandardOutput = "/dev/stdout";

/// Marks a channel or layer as wanted; false if it is none of those on demand.
bool want(std::string_view name, ExtraChannels& channels) {
  for (const auto& [known, wanted] : kExtraChannels) {
    if (name != known) continue;
    channels.*wanted = true;
    return true;
  }
  return false;
}

ExtraChannels parse_channels(const std::string& text) {
  ExtraChannels channels;
  for (const std::string& name : split_at_commas(text)) {
    if (!want(name, channels)) {
      std::vector<std::string> names;
      for (const auto& [known, wanted] : kExtraChannels) names.emplace_back(known);
      fail_value("--channels", text,
                 "some of P, Albedo, objectId, tests, doubts, sums with commas between",
                 did_you_mean(name, names));
    }
  }
  return channels;
}

/// The pictures to write: "a.exr" and "a.png" ask for that one alone, "a" for both; "" for both
/// named after the scene in the current folder, and a folder for both named after it in there.
void parse_output(const std::string& text, const std::filesystem::path& scene,
                  OutputOptions& options) {
  std::filesystem::path stem = text;
  std::error_code ignored;  // a name that cannot be looked up is no folder
  if (text.empty()) {
    stem = scene.stem();
  } else if (!stem.has_filename() || std::filesystem::is_directory(stem, ignored)) {
    stem /= scene.stem();
  } else if (stem.extension() == ".exr") {
    options.exr = stem;
    return;
  } else if (stem.extension() == ".png") {
    options.png = stem;
    return;
  } else if (stem.has_extension()) {
    fail_value("--output", text,
               "a name that ends in .exr or .png, or one without ending for both");
  }
  options.exr = stem.string() + ".exr";
  options.png = stem.string() + ".png";
}

double parse_exposure(const std::string& text) {
  const auto stops = parse_number<double>(text);
  if (!stops || !(std::abs(*stops) <= 100.0)) {
    fail_value("--exposure", text, "a number of stops from -100 to 100 (1 is twice as bright)");
  }
  return *stops;
}

Tone parse_tone(const std::string& text) {
  return choose<Tone>("--tone", text, {{"clip", Tone::kClip}, {"filmic", Tone::kFilmic}});
}

int parse_frames(const std::string& text) {
  const auto frames = parse_number<int>(text);
  if (!frames || *frames < 1 || *frames > 9999) {
    fail_value("--frames", text, "a whole number from 1 to 9999");
  }
  return *frames;
}

double parse_save_every(const std::string& text) {
  const auto seconds = parse_number<double>(text);
  if (!seconds || !(*seconds >= 0.1 && *seconds <= 1e6)) {
    fail_value("--save-every", text, "seconds from 0.1 to 1000000");
  }
  return *seconds;
}

FalseColorOutput parse_false_color(const std::string& text) {
  static constexpr std::string_view kChannels[] = {
      "R",        "G",        "B",     "A",      "Z",       "N.X",      "N.Y",
      "N.Z",      "id",       "P.X",   "P.Y",    "P.Z",     "Albedo.R", "Albedo.G",
      "Albedo.B", "objectId", "tests", "doubts", "samples", "error"};
  constexpr const char* kOption = "--false-colour";
  const std::size_t equals = std::min(text.find('='), text.size() - 1);
  FalseColorOutput output;
  output.path = text.substr(equals + 1);
  if (output.path.extension() != ".png") {
    fail_value(kOption, text, "CHANNEL=FILE.png or CHANNEL:LOW:HIGH=FILE.png");
  }
  std::string what = text.substr(0, equals);
  std::ranges::replace(what, ':', ',');
  const std::size_t name_end = std::min(what.find(','), what.size());
  output.channel = what.substr(0, name_end);
  if (std::ranges::find(kChannels, output.channel) == std::end(kChannels)) {
    fail_value(
        kOption, text,
        "one of the EXR's channels, such as Z, N.X, P.X, Albedo.R, id, objectId, tests, doubts, "
        "samples, error");
  }
  if (name_end == what.size()) return output;
  const auto limits = parse_list<double>(what.substr(name_end + 1));
  if (!limits || limits->size() != 2 || !std::isfinite((*limits)[0]) ||
      !std::isfinite((*limits)[1]) || (*limits)[0] >= (*limits)[1]) {
    fail_value(kOption, text, "CHANNEL:LOW:HIGH=FILE.png with numbers LOW < HIGH");
  }
  output.scale = Scale{(*limits)[0], (*limits)[1]};
  return output;
}

}  // namespace

std::vector<std::filesystem::path> OutputOptions::paths() const {
  std::vector<std::filesystem::path> all;
  if (exr) all.push_back(*exr);
  if (png) all.push_back(*png);
  for (const FalseColorOutput& output : false_colors) all.push_back(output.path);
  if (stats) all.push_back(*stats);
  return all;
}

ExtraChannels OutputOptions::needed_channels() const {
  ExtraChannels needed = channels;
  for (const FalseColorOutput& output : false_colors) {
    want(output.channel.substr(0, output.channel.find('.')), needed);
  }
  return needed;
}

OutputOptions OutputOptions::numbered(int frame) const {
  char number[16];
  std::snprintf(number, sizeof number, "-%04d", frame);
  const auto rename = [&](std::filesystem::path& path) {
    std::error_code ignored;
    const auto kind = std::filesystem::status(path, ignored).type();
    if (kind == std::filesystem::file_type::character ||  // a stream takes them all
        kind == std::filesystem::file_type::fifo || path == kStandardOutput) {
      return;
    }
    const std::string ending = path.extension().string();
    path.replace_filename(path.stem().string() + number + ending);
  };
  OutputOptions result = *this;
  if (result.exr) rename(*result.exr);
  if (result.png) rename(*result.png);
  for (FalseColorOutput& output : result.false_colors) rename(output.path);
  if (result.stats) rename(*result.stats);
  return result;
}

void declare_picture_options(CLI::App& app, RawOutputOptions& raw) {
  app.add_option("-o,--output", raw.output)->take_last();
  app.add_option("--exposure", raw.exposure)->take_last();
  app.add_option("--tone", raw.tone)->take_last();
  app.add_option("--channels", raw.channels)->take_last();
  app.add_option("--false-colour,--false-color", raw.false_colors)->allow_extra_args(false);
}

void declare_output_options(CLI::App& app, RawOutputOptions& raw) {
  declare_picture_options(app, raw);
  app.add_option("--frames", raw.frames)->take_last();
  app.add_option("--save-every", raw.save_every)->take_last();
  app.add_option("--stats", raw.stats)->take_last();
}

OutputOptions parse_output_options(const RawOutputOptions& raw,
                                   const std::filesystem::path& scene) {
  OutputOptions options;
  parse_output(raw.output, scene, options);
  if (!raw.stats.empty()) options.stats = raw.stats == "-" ? kStandardOutput : raw.stats;
  if (!raw.channels.empty()) {
    options.channels = parse_channels(raw.channels);
    if (!options.exr) throw InputError("--channels: expected an EXR among the outputs");
  }
  if (!raw.exposure.empty()) options.display.exposure = parse_exposure(raw.exposure);
  if (!raw.tone.empty()) options.display.tone = parse_tone(raw.tone);
  for (const std::string& text : raw.false_colors) {
    options.false_colors.push_back(parse_false_color(text));
  }
  if (!raw.frames.empty()) options.frames = parse_frames(raw.frames);
  if (!raw.save_every.empty()) options.save_seconds = parse_save_every(raw.save_every);
  return options;
}

}  // namespace raygate
