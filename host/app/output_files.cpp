#include "host/app/output_files.h"

#include <algorithm>
#include <exception>
#include <filesystem>
#include <new>
#include <string>
#include <vector>

#include "host/app/process.h"
#include "host/base/input_error.h"
#include "host/film/display.h"
#include "host/film/exr.h"
#include "host/film/film.h"
#include "host/film/merge.h"

namespace raygate {
namespace {

/// Whether no pixel has a hit.
bool is_empty(const Film& film) {
  return std::ranges::all_of(film.color, [](const glm::vec4& color) { return color.a == 0.0f; });
}

}  // namespace

Image8 false_color_picture(const Film& film, const FalseColorOutput& output) {
  const std::vector<Channel> channels = channels_of(film);
  const auto channel = std::ranges::find(channels, output.channel, &Channel::name);
  if (channel == channels.end()) {
    throw InputError("--false-colour: found no channel " + output.channel +
                     " in the picture, expected one that it has");
  }
  return false_color(film.width, film.height, film.window, *channel, output.scale);
}

StagedFiles stage_files(const OutputOptions& options, const Film& film, const ExrMetadata& metadata,
                        int threads) {
  StagedFiles ready;
  const auto add = [&](const std::filesystem::path& path, const std::string& bytes) {
    ready.files.emplace_back(path, bytes);
    ready.paths.push_back(path);
  };
  const auto add_png = [&](const std::filesystem::path& path, Image8 picture) {
    if (metadata.partial) picture.texts.emplace_back("Comment", kPartial);
    add(path, encode_png(picture));
  };
  if (options.exr) add(*options.exr, encode_exr(film, metadata, threads));
  if (options.png) add_png(*options.png, to_display(film, options.display));
  for (const FalseColorOutput& output : options.false_colors) {
    const Image8 picture = false_color_picture(film, output);
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

Checkpointer::Checkpointer(const OutputOptions& outputs, const ExrMetadata& metadata, int threads,
                           ProgressLine& line)
    : outputs_(outputs), metadata_(metadata), threads_(threads), line_(line) {
  outputs_.stats.reset();
  metadata_.partial = true;
}

void Checkpointer::end_interrupted(const Film& film) const {
  const int signal = interruption();
  if (is_empty(film)) {
    throw Interrupted(signal, "no file was changed");
  }
  write(film);
  const bool goes_on = film.keeps_sums && outputs_.exr;
  throw Interrupted(
      signal, "wrote what there was: " + listed(outputs_.paths()) +
                  (goes_on ? "; --resume " + outputs_.exr->string() + " goes on from there" : ""));
}

void Checkpointer::save(const Film* film) {
  std::string trouble;
  try {
    if (film == nullptr) throw std::bad_alloc();
    write(*film);
  } catch (const std::bad_alloc&) {
    trouble = listed(outputs_.paths()) + ": cannot write: out of memory";
  } catch (const std::exception& error) {
    trouble = error.what();
  }
  if (!trouble.empty() && trouble != last_trouble_) {
    line_.erase();
    print_warning(trouble + "; the render goes on, and the next save tries again");
  }
  last_trouble_ = trouble;
}

void Checkpointer::write(const Film& film) const {
  for (AtomicFile& file : stage_files(outputs_, film, metadata_, threads_).files) file.commit();
}

Film read_unfinished(const Options& options, const ExrMetadata& metadata) {
  const std::string name = options.resume.string();
  FilmFile file = read_film(options.resume);
  Film& film = file.film;
  const SampleRange there = samples_of(file.metadata), wanted = samples_of(metadata);
  if (there.first != wanted.first || there.end > wanted.end) {
    throw InputError(name + ": found samples " + to_string(there) + ", expected the first of " +
                     to_string(wanted));
  }
  // A single sample is its pixel's middle, the first of several is not.
  for (auto& [key, value] : file.metadata.options) {
    if (key == "spp" && value != "1") value = std::to_string(options.render.samples);
  }
  const RenderSettings& render = options.render;
  if (const auto difference = different_picture(file, metadata, render.width, render.height)) {
    throw InputError(name + ": found " + *difference + " as this run has it");
  }
  if (film.window != render.window) {
    throw InputError(name + ": found another crop, expected that of this run");
  }
  // One pixel with all fields that this run needs.
  Film needed = make_film(1, 1, {0, 0, 1, 1}, options.output.needed_channels());
  add_sums(needed, render.error > 0.0);
  for_each_field(
      [&](const FilmField& field, const auto& wanted, auto& values) {
        if (wanted.empty()) values.clear();
        if (!values.empty() || wanted.empty()) return;
        throw InputError(name + ": found no channel " + std::string(field.layer) +
                         ", expected it as --channels names it");
      },
      needed, film);
  return film;
}

}  // namespace raygate
