#include "host/cli/output_files.h"

#include <algorithm>

#include "host/base/input_error.h"
#include "host/film/channels.h"
#include "host/film/display.h"
#include "host/film/false_color.h"
#include "host/film/png.h"

namespace raygate {

StagedFiles stage_files(const OutputOptions& options, const Film& film, const ExrMetadata& metadata,
                        int threads) {
  StagedFiles ready;
  const auto add = [&](const std::filesystem::path& path, const std::string& bytes) {
    ready.files.emplace_back(path, bytes);
    ready.paths.push_back(path);
  };
  if (options.exr) add(*options.exr, encode_exr(film, metadata, threads));
  const auto add_png = [&](const std::filesystem::path& path, Image8 picture) {
    if (metadata.partial) picture.texts.emplace_back("Comment", kPartial);
    add(path, encode_png(picture));
  };
  if (options.png) add_png(*options.png, to_display(film, options.display));
  const std::vector<Channel> channels = channels_of(film);
  for (const FalseColorOutput& output : options.false_colors) {
    const auto channel = std::ranges::find(channels, output.channel, &Channel::name);
    if (channel == channels.end()) {
      throw InputError("--false-colour: found no channel " + output.channel +
                       " in the picture, expected one that it has");
    }
    const Image8 picture =
        false_color(film.width, film.height, film.window, *channel, output.scale);
    add_png(output.path, picture);
    ready.legends.push_back(picture.texts.at(0).second);
  }
  return ready;
}

}  // namespace raygate
