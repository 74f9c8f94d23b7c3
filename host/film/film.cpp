#include "host/film/film.h"

#include <algorithm>
#include <cstring>
#include <string>
#include <type_traits>

namespace raygate {
#include "host/base/elementary.h"

Film make_film(int width, int height, const PixelRect& window, const ExtraChannels& extra) {

  Film film;
  film.width = width;
  film.height = height;
  film.window = window;
  film.keeps_sums = extra.sums;
  const std::size_t pixels = std::size_t(window.width()) * std::size_t(window.height());
  film.color.assign(pixels, glm::vec4(0.0f));
  film.depth.assign(pixels, std::numeric_limits<float>::infinity());
  film.normal.assign(pixels, glm::vec3(0.0f));
  film.primitive.assign(pixels, kNoPrimitive);
  if (extra.position) film.position.assign(pixels, glm::vec3(0.0f));
  if (extra.albedo) film.albedo.assign(pixels, glm::vec3(0.0f));
  if (extra.object) film.object.assign(pixels, kNoPrimitive);
  if (extra.tests) film.tests.assign(pixels, 0);
  if (extra.doubts) film.doubts.assign(pixels, 0);
  return film;
}

void add_sums(Film& film, bool with_error) {
  const std::size_t pixels = film.color.size();
  film.sums.samples.assign(pixels, 0);
  film.sums.color.resize(pixels);
  film.sums.albedo.resize(film.albedo.size());
  if (!with_error) return;
  film.sums.error.assign(pixels, std::numeric_limits<float>::infinity());
  film.sums.shown.assign(pixels, 0.0f);
}

// Pixels of all arrays consist of 32-bit words, the same number for each part.
std::vector<Channel> channels_of(const Film& film) {
  std::vector<Channel> channels;
  const auto add = [&](const FilmField& field, const auto& values) {
    using Pixel = std::remove_cvref_t<decltype(values.front())>;
    constexpr bool kIsFloat = std::is_same_v<Pixel, float> || std::is_same_v<Pixel, glm::vec3> ||
                              std::is_same_v<Pixel, glm::vec4>;
    const bool is_in_files =
        !field.is_sum || film.keeps_sums || (field.layer == "samples" && !film.sums.error.empty());
    if (values.empty() || !is_in_files) return;
    constexpr std::size_t kWordSize = 4;
    const std::size_t numbers = sizeof(Pixel) / kWordSize;
    const std::size_t words = numbers / std::max<std::size_t>(1, field.parts.size());
    for (std::size_t i = 0; i < numbers; ++i) {
      std::string name(field.layer);
      if (!field.parts.empty()) (name += name.empty() ? "" : ".") += field.parts[i / words];
      if (words > 1) (name += '.') += std::to_string(i % words);
      channels.push_back({name, kIsFloat ? Channel::Type::kFloat : Channel::Type::kUint,
                          reinterpret_cast<const std::uint32_t*>(values.data()) + i,
                          sizeof(Pixel)});
    }
  };
  for_each_field(add, film);
  return channels;
}

double value_at(const Channel& channel, std::size_t index) {
  const char* const at = static_cast<const char*>(channel.first) + index * channel.stride;
  if (channel.type == Channel::Type::kUint) {
    std::uint32_t number = 0;
    std::memcpy(&number, at, sizeof number);
    return number;
  }
  float number = 0.0f;
  std::memcpy(&number, at, sizeof number);
  return number;
}

void copy_region(const Film& from, const PixelRect& rect, Film& to) {
  const auto copy = [&](const FilmField&, const auto& source, auto& target) {
    for (int y = rect.y0; y < rect.y1 && !source.empty(); ++y) {
      std::copy_n(&source[from.index_of(rect.x0, y)], rect.width(),
                  &target[to.index_of(rect.x0, y)]);
    }
  };
  for_each_field(copy, from, to);
}

}  // namespace raygate
