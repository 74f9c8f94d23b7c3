#include "host/film/merge.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <map>
#include <tuple>

#include "host/base/counts.h"
#include "host/base/input_error.h"

namespace raygate {
namespace {

const std::string* option_of(const ExrMetadata& metadata, const std::string& name) {
  const auto at =
      std::ranges::find(metadata.options, name, &std::pair<std::string, std::string>::first);
  return at == metadata.options.end() ? nullptr : &at->second;
}

std::string text(const PixelRect& r) {
  return std::to_string(r.x0) + "," + std::to_string(r.y0) + "," + std::to_string(r.x1) + "," +
         std::to_string(r.y1);
}

auto edges(const PixelRect& r) { return std::tuple(r.y0, r.x0, r.y1, r.x1); }

bool overlap(const PixelRect& a, const PixelRect& b) {
  return a.x0 < b.x1 && b.x0 < a.x1 && a.y0 < b.y1 && b.y0 < a.y1;
}

/// Throws InputError if a part is invalid or does not match the first one.
void require_like(const NamedFilm& part, const NamedFilm& first) {
  const auto& [name, file] = part;
  const Film &film = file.film, &other = first.second.film;
  if (file.metadata.partial) {
    throw InputError(name + ": found a picture that is not finished, expected a whole one; " +
                     "`render --resume` finishes it");
  }
  if (const auto difference = different_picture(file.metadata, first.second.metadata)) {
    throw InputError(name + ": found " + *difference + " as in " + first.first);
  }
  bool is_like = film.width == other.width && film.height == other.height &&
                 file.metadata.world_to_camera == first.second.metadata.world_to_camera;
  for_each_field([&](const FilmField&, const auto& a,
                     const auto& b) { is_like = is_like && a.empty() == b.empty(); },
                 film, other);
  if (!is_like) {
    throw InputError(name + ": found another frame, camera or other channels than in " +
                     first.first + ", expected the same");
  }
}

template <std::size_t N>
void add(std::vector<std::array<ExactAccumulator, N>>& sums,
         const std::vector<std::array<ExactAccumulator, N>>& more) {
  for (std::size_t i = 0; i < sums.size(); ++i) {
    for (std::size_t k = 0; k < N; ++k) sums[i][k] += more[i][k];
  }
}

void add(std::vector<std::uint32_t>& counts, const std::vector<std::uint32_t>& more) {
  for (std::size_t i = 0; i < counts.size(); ++i) add_count(counts[i], more[i]);
}

/// Adds the samples of `more` to the sums of `film`. Does not update the means.
void add_samples(Film& film, const Film& more) {
  add(film.sums.samples, more.sums.samples);
  add(film.sums.color, more.sums.color);
  add(film.sums.albedo, more.sums.albedo);
  add(film.tests, more.tests);
  add(film.doubts, more.doubts);
}

void set_means(Film& film) {
  for (std::size_t i = 0; i < film.color.size(); ++i) {
    const double samples = film.sums.samples[i];
    film.color[i] = mean_of(film.sums.color[i], samples);
    if (!film.albedo.empty()) film.albedo[i] = mean_of(film.sums.albedo[i], samples);
  }
}

/// Joins all parts of one window.
NamedFilm joined(std::vector<NamedFilm>& parts) {
  const auto range = [](const NamedFilm& part) { return samples_of(part.second.metadata); };
  std::ranges::sort(parts, {}, [&](const NamedFilm& part) { return range(part).first; });
  NamedFilm whole = std::move(parts.front());
  SampleRange samples = range(whole);
  for (std::size_t i = 1; i < parts.size(); ++i) {
    const SampleRange next = range(parts[i]);
    if (next.first != samples.end) {
      throw InputError(parts[i].first + ": found samples " + to_string(next) + " beside " +
                       to_string(samples) + " of the same pixels, expected some from " +
                       std::to_string(samples.end) + " on");
    }
    add_samples(whole.second.film, parts[i].second.film);
    samples.end = next.end;
  }
  set_samples(whole.second.metadata, samples);
  set_means(whole.second.film);
  return whole;
}

PixelRect bounds(const std::vector<NamedFilm>& windows) {
  PixelRect all = windows.front().second.film.window;
  for (const NamedFilm& part : windows) {
    const PixelRect& w = part.second.film.window;
    all = {std::min(all.x0, w.x0), std::min(all.y0, w.y0), std::max(all.x1, w.x1),
           std::max(all.y1, w.y1)};
  }
  return all;
}

void require_tiling(const std::vector<NamedFilm>& windows, const PixelRect& all) {
  std::int64_t pixels = 0;
  for (std::size_t i = 0; i < windows.size(); ++i) {
    const auto& [name, file] = windows[i];
    const PixelRect& w = file.film.window;
    pixels += std::int64_t{w.width()} * w.height();
    for (std::size_t k = 0; k < i; ++k) {
      if (!overlap(w, windows[k].second.film.window)) continue;
      throw InputError(name + ": found pixels " + text(w) + ", some of which are in " +
                       windows[k].first + ", expected others");
    }
    const SampleRange here = samples_of(file.metadata);
    const SampleRange there = samples_of(windows[0].second.metadata);
    if (here.first == there.first && here.end == there.end) continue;
    throw InputError(name + ": found samples " + to_string(here) + ", expected " +
                     to_string(there) + " as in " + windows[0].first);
  }
  if (pixels == std::int64_t{all.width()} * all.height()) return;
  throw InputError(windows[0].first + ": found that all parts together lack some pixels of " +
                   text(all) + ", expected a whole rectangle");
}

}  // namespace

std::optional<SampleRange> parse_sample_range(const std::string& text) {
  SampleRange range;
  const char *at = text.data(), *const end = at + text.size();
  const auto first = std::from_chars(at, end, range.first);
  if (first.ec != std::errc() || first.ptr == end || *first.ptr != ':') return std::nullopt;
  const auto last = std::from_chars(first.ptr + 1, end, range.end);
  if (last.ec != std::errc() || last.ptr != end) return std::nullopt;
  if (range.first < 0 || range.first >= range.end) return std::nullopt;
  return range;
}

std::string to_string(const SampleRange& range) {
  return std::to_string(range.first) + ":" + std::to_string(range.end);
}

SampleRange samples_of(const ExrMetadata& metadata) {
  const std::string* const range = option_of(metadata, kSamplesAttribute);
  const std::string* const all = option_of(metadata, "spp");
  if (range != nullptr) return parse_sample_range(*range).value_or(SampleRange{});
  return all == nullptr ? SampleRange{} : parse_sample_range("0:" + *all).value_or(SampleRange{});
}

void set_samples(ExrMetadata& metadata, const SampleRange& range) {
  std::erase_if(metadata.options,
                [](const auto& option) { return option.first == kSamplesAttribute; });
  const SampleRange all = samples_of(metadata);
  if (range.first == all.first && range.end == all.end) return;
  metadata.options.emplace_back(kSamplesAttribute, to_string(range));
}

std::optional<std::string> different_picture(const ExrMetadata& found,
                                             const ExrMetadata& expected) {
  const auto facts = [](const ExrMetadata& metadata) {
    std::map<std::string, std::string> all(metadata.options.begin(), metadata.options.end());
    all.erase(kSamplesAttribute);
    all["software"] = metadata.software;
    all["scene"] = metadata.scene;
    all["seed"] = std::to_string(metadata.seed);
    return all;
  };
  const auto here = facts(found), there = facts(expected);
  const auto value = [](const auto& all, const std::string& name) {
    const auto at = all.find(name);
    return at == all.end() ? "no " + name : std::string(name).append(" ").append(at->second);
  };
  for (const auto* side : {&here, &there}) {
    for (const auto& [name, ignored] : *side) {
      std::string a = value(here, name);
      const std::string b = value(there, name);
      if (a == b) continue;
      if (name == kSceneAttribute) return "another geometry, material or light, expected those";
      return a.append(", expected ").append(b);
    }
  }
  return std::nullopt;
}

FilmFile merge(std::vector<NamedFilm> parts) {
  std::map<std::tuple<int, int, int, int>, std::vector<NamedFilm>> by_window;
  for (const NamedFilm& part : parts) require_like(part, parts.front());
  for (NamedFilm& part : parts) {
    by_window[edges(part.second.film.window)].push_back(std::move(part));
  }
  std::vector<NamedFilm> windows;
  windows.reserve(by_window.size());
  for (auto& [ignored, group] : by_window) windows.push_back(joined(group));
  const PixelRect all = bounds(windows);
  require_tiling(windows, all);
  if (windows.size() == 1) return std::move(windows[0].second);
  FilmFile result;
  result.metadata = windows[0].second.metadata;
  Film& film = result.film;
  film.width = windows[0].second.film.width;
  film.height = windows[0].second.film.height;
  film.window = all;
  film.keeps_sums = true;
  const auto make_room = [&](const FilmField&, const auto& values, auto& whole) {
    if (!values.empty()) whole.resize(std::size_t(all.width()) * std::size_t(all.height()));
  };
  for_each_field(make_room, windows[0].second.film, film);
  for (const NamedFilm& window : windows) {
    copy_region(window.second.film, window.second.film.window, film);
  }
  return result;
}

}  // namespace raygate
