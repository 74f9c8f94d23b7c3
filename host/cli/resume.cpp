#include "host/cli/resume.h"

#include <algorithm>
#include <string>
#include <tuple>

#include "host/film/exr_reader.h"
#include "host/film/merge.h"
#include "host/film/sample_range.h"
#include "host/scene/io/input_error.h"

namespace raygate {
namespace {

std::string* option_of(ExrMetadata& metadata, const std::string& name) {
  for (auto& [key, value] : metadata.options) {
    if (key == name) return &value;
  }
  return nullptr;
}

/// The channels on demand that this run has, and those of a film; what it needs and what it has
/// too many of.
template <class T>
void keep(bool needed, std::vector<T>& values, const std::string& name, const std::string& file) {
  if (!needed) {
    values.clear();
  } else if (values.empty()) {
    throw InputError(file + ": found no channel " + name + ", expected it as --channels names it");
  }
}

}  // namespace

std::optional<Film> begun_film(const Options& options, const ExrMetadata& metadata) {
  if (options.resume.empty()) return std::nullopt;
  const std::string name = options.resume.string();
  FilmFile file = read_film(options.resume);
  Film& film = file.film;

  const SampleRange there = samples_of(file.metadata);
  const SampleRange wanted = samples_of(metadata);
  if (there.first != wanted.first || there.end > wanted.end) {
    throw InputError(name + ": found samples " + to_string(there) + ", expected the first of " +
                     to_string(wanted));
  }
  // A single sample is its pixel's middle, the first of several is not.
  std::string* const spp = option_of(file.metadata, "spp");
  if (spp != nullptr && *spp != "1") *spp = std::to_string(options.light.samples);
  if (const auto difference = different_picture(file.metadata, metadata)) {
    throw InputError(name + ": found " + *difference + " as this run has it");
  }
  const auto layout = [](int width, int height, const PixelRect& w) {
    return std::tuple(width, height, w.x0, w.y0, w.x1, w.y1);
  };
  const PixelRect window =
      options.window.width() > 0 ? options.window : PixelRect{0, 0, options.width, options.height};
  if (layout(film.width, film.height, film.window) !=
      layout(options.width, options.height, window)) {
    throw InputError(name + ": found another frame or crop, expected those of this run");
  }
  const ExtraChannels needed = options.output.needed_channels();
  keep(needed.position, film.position, "P", name);
  keep(needed.albedo, film.albedo, "Albedo", name);
  keep(needed.albedo, film.sums.albedo, "sums.Albedo", name);
  keep(needed.object, film.object, "objectId", name);
  keep(needed.tests, film.tests, "tests", name);
  keep(needed.doubts, film.doubts, "doubts", name);
  keep(options.light.error > 0.0, film.sums.error, "error", name);
  keep(options.light.error > 0.0, film.sums.shown, "sums.shown", name);
  return film;
}

}  // namespace raygate
