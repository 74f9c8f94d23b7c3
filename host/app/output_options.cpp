#include "host/app/output_options.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <string_view>
#include <utility>

#include "host/base/input_error.h"

namespace raygate {
namespace {

constexpr std::pair<std::string_view, bool ExtraChannels::*> kExtraChannels[] = {
    {"P", &ExtraChannels::position},      {"Albedo", &ExtraChannels::albedo},
    {"objectId", &ExtraChannels::object}, {"tests", &ExtraChannels::tests},
    {"doubts", &ExtraChannels::doubts},   {"sums", &ExtraChannels::sums}};

constexpr const char* kStandardOutput = "/dev/stdout";

/// Adds an extra channel or layer; returns false if it is always in the film.
bool want(std::string_view name, ExtraChannels& channels) {
  for (const auto& [known, wanted] : kExtraChannels) {
    if (name != known) continue;
    channels.*wanted = true;
    return true;
  }
  return false;
}

/// Sets the names of the pictures: "a.exr" or "a.png" that file alone, "a" both, a folder both
/// named after the scene in it, and "" both in the current folder.
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

FalseColorOutput parse_false_color(const std::string& option, const std::string& text) {
  static constexpr std::string_view kChannels[] = {
      "R",        "G",        "B",     "A",      "Z",       "N.X",      "N.Y",
      "N.Z",      "id",       "P.X",   "P.Y",    "P.Z",     "Albedo.R", "Albedo.G",
      "Albedo.B", "objectId", "tests", "doubts", "samples", "error"};
  const std::size_t equals = std::min(text.find('='), text.size() - 1);
  FalseColorOutput output;
  output.path = text.substr(equals + 1);
  if (output.path.extension() != ".png") {
    fail_value(option, text, "CHANNEL=FILE.png or CHANNEL:LOW:HIGH=FILE.png");
  }
  std::string what = text.substr(0, equals);
  std::ranges::replace(what, ':', ',');
  const std::size_t name_end = std::min(what.find(','), what.size());
  output.channel = what.substr(0, name_end);
  if (std::ranges::find(kChannels, output.channel) == std::end(kChannels)) {
    fail_value(
        option, text,
        "one of the EXR's channels, such as Z, N.X, P.X, Albedo.R, id, objectId, tests, doubts, "
        "samples, error");
  }
  if (name_end == what.size()) return output;
  const auto limits = parse_list<double>(what.substr(name_end + 1));
  if (!limits || limits->size() != 2 || !std::isfinite((*limits)[0]) ||
      !std::isfinite((*limits)[1]) || (*limits)[0] >= (*limits)[1]) {
    fail_value(option, text, "CHANNEL:LOW:HIGH=FILE.png with numbers LOW < HIGH");
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

void add_picture_options(OptionTable& table, OutputOptions& options) {
  table.add("-o,--output", "NAME", "NAME.exr, NAME.png, or NAME (or a folder) for both",
            [](const auto&, const auto&) {});  // see name_outputs()
  table.number("--exposure", "STOPS", "PNG exposure in stops: +1 is twice as bright ({})",
               options.display.exposure,
               Range{-100.0, 100.0, "a number of stops from -100 to 100 (1 is twice as bright)"},
               kInSceneFile | kInPage);
  table.choice<Tone>("--tone", "clip|filmic", "tone curve of the PNG ({})", options.display.tone,
                     {{"clip", Tone::kClip}, {"filmic", Tone::kFilmic}}, kInSceneFile | kInPage);
  table.add("--channels", "NAMES",
            "extra EXR channels (AOVs): P, Albedo, objectId, tests, doubts; or sums, for --resume "
            "and ./merge",
            [&options](const std::string& option, const std::string& text) {
              std::vector<std::string> names;
              for (const auto& [name, wanted] : kExtraChannels) names.emplace_back(name);
              options.channels = {};
              for (const std::string& name : choose_some(option, text, names)) {
                want(name, options.channels);
              }
            });
  table.add(
      "--false-colour,--false-color", "CHANNEL[:LOW:HIGH]=FILE.png", "a channel in false colours",
      [&options](const std::string& option, const std::string& text) {
        options.false_colors.push_back(parse_false_color(option, text));
      },
      {}, kInPage, true);
}

void add_run_output_options(OptionTable& table, OutputOptions& options) {
  table.number("--save-every", "SECONDS", "save the unfinished picture now and then",
               options.save_seconds, Range{0.1, 1e6, "seconds from 0.1 to 1000000"});
  table.add("--stats", "FILE.json", "all statistics as JSON; - prints them",
            [&options](const auto&, const std::string& text) {
              options.stats = text == "-" ? kStandardOutput : text;
            });
}

void name_outputs(const OptionTable& table, const std::filesystem::path& scene,
                  OutputOptions& options) {
  parse_output(table.typed("output"), scene, options);
  if (!table.typed("channels").empty() && !options.exr) {
    throw InputError("--channels: expected an EXR among the outputs");
  }
}

}  // namespace raygate
