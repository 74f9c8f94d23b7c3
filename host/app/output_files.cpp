#include "host/app/output_files.h"

#include <algorithm>
#include <exception>
#include <filesystem>
#include <new>
#include <string>
#include <tuple>
#include <vector>

#include "host/app/process.h"
#include "host/base/input_error.h"
#include "host/film/display.h"
#include "host/film/exr.h"
#include "host/film/false_color.h"
#include "host/film/film.h"
#include "host/film/merge.h"

namespace raygate {
namespace {

/// Whether no pixel has a hit.
bool is_empty(const Film& film) {
  return std::ranges::all_of(film.color, [](const glm::vec4& color) { return color.a == 0.0f; });
}

/// The files of an unfinished picture: all but statistics.
std::vector<std::filesystem::path> pictures_of(OutputOptions outputs) {
  outputs.stats.reset();
  return outputs.paths();
}

}  // namespace

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

std::string listed(const std::vector<std::filesystem::path>& paths) {
  std::vector<std::string> names;
  names.reserve(paths.size());
  for (const auto& path : paths) names.push_back(printable(path.string()));
  return listed(names, ", ");
}

void Checkpointer::end_interrupted(const Film& film) const {
  const int signal = interruption();
  if (is_empty(film)) {
    throw Interrupted(signal, "no file was changed");
  }
  write(film);
  const bool goes_on = film.keeps_sums && outputs_.exr;
  throw Interrupted(
      signal, "wrote what there was: " + listed(pictures_of(outputs_)) +
                  (goes_on ? "; --resume " + outputs_.exr->string() + " goes on from there" : ""));
}

void Checkpointer::save(const Film* film) {
  std::string trouble;
  try {
    if (film == nullptr) throw std::bad_alloc();
    write(*film);
  } catch (const std::bad_alloc&) {
    trouble = listed(pictures_of(outputs_)) + ": cannot write: out of memory";
  } catch (const std::exception& error) {
    trouble = error.what();
  }
  if (!trouble.empty() && trouble != last_trouble_) {
    bar_.erase();
    print_warning(trouble + "; the render goes on, and the next save tries again");
  }
  last_trouble_ = trouble;
}

void Checkpointer::write(const Film& film) const {
  ExrMetadata metadata = metadata_;
  metadata.partial = true;
  for (AtomicFile& file : stage_files(outputs_, film, metadata, threads_).files) file.commit();
}

namespace {

std::string* option_of(ExrMetadata& metadata, const std::string& name) {
  for (auto& [key, value] : metadata.options) {
    if (key == name) return &value;
  }
  return nullptr;
}

/// Drops values of an extra channel that this run does not need. Throws InputError if it needs them
/// and the film has none.
template <class T>
void keep(bool needed, std::vector<T>& values, const std::string& name, const std::string& file) {
  if (!needed) {
    values.clear();
  } else if (values.empty()) {
    throw InputError(file + ": found no channel " + name + ", expected it as --channels names it");
  }
}

/// Throws InputError if a film has another frame, crop or camera than this run.
void require_place(const Options& options, const std::string& name, const ExrMetadata& metadata,
                   const Film& found, const ExrMetadata& found_metadata) {
  const auto layout = [](int width, int height, const PixelRect& w) {
    return std::tuple(width, height, w.x0, w.y0, w.x1, w.y1);
  };
  const PixelRect window = options.render.window.width() > 0
                               ? options.render.window
                               : PixelRect{0, 0, options.render.width, options.render.height};
  if (layout(found.width, found.height, found.window) !=
      layout(options.render.width, options.render.height, window)) {
    throw InputError(name + ": found another frame or crop, expected those of this run");
  }
  if (found_metadata.world_to_camera != metadata.world_to_camera) {
    throw InputError(name + ": found another camera, expected that of this run");
  }
}

}  // namespace

Film read_unfinished(const Options& options, const std::filesystem::path& path,
                     const ExrMetadata& metadata) {
  const std::string name = path.string();
  FilmFile file = read_film(path);
  Film& film = file.film;

  const SampleRange there = samples_of(file.metadata);
  const SampleRange wanted = samples_of(metadata);
  if (there.first != wanted.first || there.end > wanted.end) {
    throw InputError(name + ": found samples " + to_string(there) + ", expected the first of " +
                     to_string(wanted));
  }
  // A single sample is its pixel's middle, the first of several is not.
  std::string* const spp = option_of(file.metadata, "spp");
  if (spp != nullptr && *spp != "1") *spp = std::to_string(options.render.samples);
  if (const auto difference = different_picture(file.metadata, metadata)) {
    throw InputError(name + ": found " + *difference + " as this run has it");
  }
  require_place(options, name, metadata, film, file.metadata);
  const ExtraChannels needed = options.output.needed_channels();
  keep(needed.position, film.position, "P", name);
  keep(needed.albedo, film.albedo, "Albedo", name);
  keep(needed.albedo, film.sums.albedo, "sums.Albedo", name);
  keep(needed.object, film.object, "objectId", name);
  keep(needed.tests, film.tests, "tests", name);
  keep(needed.doubts, film.doubts, "doubts", name);
  keep(options.render.error > 0.0, film.sums.error, "error", name);
  keep(options.render.error > 0.0, film.sums.shown, "sums.shown", name);
  return film;
}

}  // namespace raygate
