#include "host/cli/output_files.h"

#include <algorithm>
#include <exception>
#include <new>

#include "host/base/input_error.h"
#include "host/cli/process.h"
#include "host/film/display.h"
#include "host/film/false_color.h"
#include "host/film/film.h"

namespace raygate {
namespace {

/// Whether nothing has been rendered, or nothing but misses.
bool is_empty(const Film& film) {
  return std::ranges::all_of(film.color, [](const glm::vec4& color) { return color.a == 0.0f; });
}

/// The files that are written while there is no end: no statistics.
std::vector<std::filesystem::path> pictures_of(OutputOptions outputs) {
  outputs.stats.reset();
  return outputs.paths();
}

std::string going_on(const OutputOptions& outputs) {
  return "--resume " + outputs.exr->string() + " goes on from there";
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

void Checkpointer::save_urgently(const Film* film) {
  if (!outputs_.exr) return;
  OutputOptions film_alone = outputs_;
  film_alone.png.reset();
  film_alone.false_colors.clear();
  save(film, film_alone);
  bar_.erase();
  print_warning("a rank may have died; " + going_on(all_));
}

void Checkpointer::end_interrupted(const Film& film) const {
  const int signal = interruption();
  if (is_empty(film)) {
    throw Interrupted(signal, "no file was changed");
  }
  write(film, outputs_);
  const bool goes_on = (film.keeps_sums || all_.frames > 0) && outputs_.exr;
  throw Interrupted(signal, "wrote what there was: " + listed(pictures_of(outputs_)) +
                                (goes_on ? "; " + going_on(all_) : ""));
}

void Checkpointer::save(const Film* film, const OutputOptions& outputs) {
  std::string trouble;
  try {
    if (film == nullptr) throw std::bad_alloc();
    write(*film, outputs);
  } catch (const std::bad_alloc&) {
    trouble = listed(pictures_of(outputs)) + ": cannot write: out of memory";
  } catch (const std::exception& error) {
    trouble = error.what();
  }
  if (!trouble.empty() && trouble != last_trouble_) {
    bar_.erase();
    print_warning(trouble + "; the render goes on, and the next save tries again");
  }
  last_trouble_ = trouble;
}

void Checkpointer::write(const Film& film, const OutputOptions& outputs) const {
  ExrMetadata metadata = metadata_;
  metadata.partial = true;
  for (AtomicFile& file : stage_files(outputs, film, metadata, threads_).files) file.commit();
}

}  // namespace raygate
