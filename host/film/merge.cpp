#include "host/film/merge.h"

#include <algorithm>
#include <charconv>
#include <cstdint>

#include "host/base/input_error.h"
#include "host/base/measure.h"

namespace raygate {
namespace {

/// Throws InputError if a part is not finished or does not match the first one.
void require_like(const NamedFilm& part, const NamedFilm& first) {
  const auto& [name, file] = part;
  const Film& other = first.second.film;
  if (file.metadata.attributes.contains(kPartialAttribute)) {
    throw InputError(name + ": found a picture that is not finished, expected a whole one; " +
                     "`render --resume` finishes it");
  }
  if (const auto difference =
          different_picture(file, first.second.metadata, other.width, other.height)) {
    throw InputError(name + ": found " + *difference + " as in " + first.first);
  }
  for_each_field(
      [&](const FilmField& field, const auto& here, const auto& there) {
        if (here.empty() == there.empty()) return;
        throw InputError(name + ": found " + (here.empty() ? "no " : "") + "channel " +
                         std::string(field.layer) + ", expected the channels of " + first.first);
      },
      file.film, other);
}

template <std::size_t N>
void add(std::array<ExactAccumulator, N>& sums, const std::array<ExactAccumulator, N>& more) {
  for (std::size_t k = 0; k < N; ++k) sums[k] += more[k];
}
void add(std::uint32_t& count, std::uint32_t more) { add_count(count, more); }

/// Adds sums and counts of pixel `k` of `part` to pixel `i` of `film`; copies all fields if these
/// are the pixel's first samples. Does not update the means.
void add_pixel(Film& film, std::size_t i, const Film& part, std::size_t k, bool is_first) {
  if (is_first) {
    for_each_field(
        [&](const FilmField&, auto& to, const auto& from) {
          if (!from.empty()) to[i] = from[k];
        },
        film, part);
    return;
  }
  const auto add_to = [&](auto& to, const auto& from) {
    if (!from.empty()) add(to[i], from[k]);
  };
  add_to(film.sums.samples, part.sums.samples);
  add_to(film.sums.color, part.sums.color);
  add_to(film.sums.albedo, part.sums.albedo);
  add_to(film.tests, part.tests);
  add_to(film.doubts, part.doubts);
}

}  // namespace

SampleRange parse_sample_range(const std::string& text) {
  SampleRange range;
  const char *at = text.data(), *const end = at + text.size();
  const auto first = std::from_chars(at, end, range.first);
  if (first.ec != std::errc() || first.ptr == end || *first.ptr != ':') return {};
  const auto last = std::from_chars(first.ptr + 1, end, range.end);
  const bool is_range = last.ec == std::errc() && last.ptr == end && range.first >= 0;
  return is_range && range.first < range.end ? range : SampleRange{};
}

std::string to_string(const SampleRange& range) {
  return std::to_string(range.first) + ":" + std::to_string(range.end);
}

SampleRange samples_of(const ExrMetadata& metadata) {
  const auto& attributes = metadata.attributes;
  const auto part = attributes.find(kSamplesAttribute), all = attributes.find("spp");
  if (part != attributes.end()) return parse_sample_range(part->second);
  return all == attributes.end() ? SampleRange{} : parse_sample_range("0:" + all->second);
}

void set_samples(ExrMetadata& metadata, const SampleRange& range) {
  metadata.attributes.erase(kSamplesAttribute);
  if (range == samples_of(metadata)) return;
  metadata.attributes[kSamplesAttribute] = to_string(range);
}

std::optional<std::string> different_picture(const FilmFile& found, const ExrMetadata& expected,
                                             int width, int height) {
  const auto &here = found.metadata.attributes, &there = expected.attributes;
  auto names = here;
  names.insert(there.begin(), there.end());
  for (const char* name : {kSamplesAttribute, kPartialAttribute}) names.erase(name);
  const auto size = [](int x, int y) { return std::to_string(x) + "x" + std::to_string(y); };
  const std::string frame = size(found.film.width, found.film.height);
  if (frame != size(width, height)) {
    return "a frame of " + frame + ", expected " + size(width, height);
  }
  std::vector<std::string> first{kSceneAttribute, "integrator"};  // others depend on both
  for (const auto& [name, ignored] : names) first.push_back(name);
  for (const std::string& name : first) {
    const auto fact = [&name](const auto& attributes) {
      const auto at = attributes.find(name);
      return at == attributes.end() ? "no " + name : name + " " + at->second;
    };
    if (fact(here) == fact(there)) continue;
    if (name == kSceneAttribute) return "another geometry, material or light, expected those";
    return fact(here) + ", expected " + fact(there);
  }
  if (found.metadata.world_to_camera != expected.world_to_camera) {
    return "another camera, expected that";
  }
  return std::nullopt;
}

FilmFile merge(std::vector<NamedFilm> parts) {
  for (const NamedFilm& part : parts) require_like(part, parts.front());
  std::ranges::stable_sort(
      parts, {}, [](const NamedFilm& part) { return samples_of(part.second.metadata).first; });
  const Film& like = parts.front().second.film;
  SampleRange all = samples_of(parts.front().second.metadata);
  PixelRect window = like.window;
  for (const auto& [name, file] : parts) {
    const PixelRect& w = file.film.window;
    window = {std::min(window.x0, w.x0), std::min(window.y0, w.y0), std::max(window.x1, w.x1),
              std::max(window.y1, w.y1)};
    all.end = std::max(all.end, samples_of(file.metadata).end);
  }
  std::vector<int> ends(window.pixels(), all.first);  // end of each pixel's samples so far
  FilmFile whole{{}, parts.front().second.metadata};
  Film& film = whole.film;
  if (like.color.size() == ends.size()) {  // the first part has all pixels: the others add to it
    std::ranges::fill(ends, samples_of(whole.metadata).end);
    film = std::move(parts.front().second.film);
    parts.erase(parts.begin());
  } else {
    film = make_film(like.width, like.height, window,
                     {!like.position.empty(), !like.albedo.empty(), !like.object.empty(),
                      !like.tests.empty(), !like.doubts.empty(), true});
    add_sums(film, !like.sums.error.empty());
  }
  for (auto& [name, file] : parts) {
    const SampleRange samples = samples_of(file.metadata);
    const PixelRect& w = file.film.window;
    for (int y = w.y0; y < w.y1; ++y) {
      for (int x = w.x0; x < w.x1; ++x) {
        const std::size_t i = film.index_of(x, y);
        if (ends[i] != samples.first) {
          throw InputError(name + ": found samples " + to_string(samples) + " of pixel " +
                           std::to_string(x) + "," + std::to_string(y) + ", expected some from " +
                           std::to_string(ends[i]) + " on");
        }
        add_pixel(film, i, file.film, file.film.index_of(x, y), ends[i] == all.first);
        ends[i] = samples.end;
      }
    }
    file.film = {};  // frees memory
  }
  const auto lacking = std::ranges::find_if(ends, [&](int end) { return end != all.end; });
  if (lacking != ends.end()) {
    const auto i = static_cast<int>(lacking - ends.begin());
    throw InputError("the parts together lack samples from " + std::to_string(*lacking) +
                     " on of pixel " + std::to_string(window.x0 + i % window.width()) + "," +
                     std::to_string(window.y0 + i / window.width()) +
                     ", expected the same samples of all pixels of a rectangle");
  }
  for (std::size_t i = 0; i < film.color.size(); ++i) {
    film.color[i] = mean_of(film.sums.color[i], film.sums.samples[i]);
    if (!film.albedo.empty()) film.albedo[i] = mean_of(film.sums.albedo[i], film.sums.samples[i]);
  }
  set_samples(whole.metadata, all);
  film.keeps_sums = whole.metadata.attributes.contains(kSamplesAttribute);
  return whole;
}

}  // namespace raygate
