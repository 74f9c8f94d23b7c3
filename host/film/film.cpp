#include "host/film/film.h"

#include <cstring>
#include <type_traits>

#include "host/base/elementary.h"

namespace raygate {

Film make_film(int width, int height, const PixelRect& window, const ExtraChannels& extra) {
  Film film;
  film.width = width;
  film.height = height;
  film.window = window;
  film.keeps_sums = extra.sums;
  const std::size_t pixels = window.pixels();
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

// A pixel of any array consists of 32-bit words, the same number of words for each part.
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
  std::uint32_t word = 0;
  const char* const at = static_cast<const char*>(channel.first) + index * channel.stride;
  std::memcpy(&word, at, sizeof word);
  return channel.type == Channel::Type::kUint ? word : double{std::bit_cast<float>(word)};
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

namespace {

/// The four-term Blackman-Harris window with minimum sidelobes (Harris 1978, "On the use of windows
/// for harmonic analysis") and a table of its inverse cumulative distribution.
class BlackmanHarris {
 public:
  static constexpr double kRadius = 1.5;

  BlackmanHarris() {
    double sum = 0.0;
    for (int i = 0; i < kSteps; ++i) {
      cumulative_[i] = sum;
      sum += weight(place(i + 0.5));
    }
    cumulative_[kSteps] = sum;
    for (double& value : cumulative_) value /= sum;
    for (int i = 0, step = 0; i < kStarts; ++i) {
      while (cumulative_[step + 1] <= static_cast<double>(i) / kStarts) ++step;
      first_[i] = static_cast<std::uint16_t>(step);
    }
  }

  [[nodiscard]] double offset(double u) const {
    int step = first_[static_cast<int>(u * kStarts)];
    while (step < kSteps - 1 && cumulative_[step + 1] <= u) ++step;
    const double within = (u - cumulative_[step]) / (cumulative_[step + 1] - cumulative_[step]);
    return place(step + std::clamp(within, 0.0, 1.0));
  }

  /// Returns the probability density at offset `at`; constant within each step of the table.
  [[nodiscard]] double density(double at) const {
    const double step = (at / kRadius + 1.0) * (0.5 * kSteps);
    if (!(step >= 0.0 && step < kSteps)) return 0.0;
    const int i = static_cast<int>(step);
    return (cumulative_[i + 1] - cumulative_[i]) * (0.5 * kSteps / kRadius);
  }

 private:
  static constexpr int kSteps = 1024, kStarts = 8 * kSteps;  // many starts shorten searches
  static double place(double step) { return (2.0 * step / kSteps - 1.0) * kRadius; }
  static double weight(double x) {
    const double turns = 0.5 * (x / kRadius + 1.0);
    return 0.35875 - 0.48829 * sine_cosine(turns).cosine +
           0.14128 * sine_cosine(2.0 * turns).cosine - 0.01168 * sine_cosine(3.0 * turns).cosine;
  }

  std::array<double, kSteps + 1> cumulative_;
  std::array<std::uint16_t, kStarts> first_;  // the step that contains u = i / kStarts
};

const BlackmanHarris& blackman_harris() {
  static const BlackmanHarris table;
  return table;
}

}  // namespace

double filter_density(ReconstructionFilter filter, const glm::dvec2& offset) {
  const auto density = [&](double at) {
    if (filter == ReconstructionFilter::kBox) return at >= -0.5 && at < 0.5 ? 1.0 : 0.0;
    return blackman_harris().density(at);
  };
  return density(offset.x) * density(offset.y);
}

glm::dvec2 filter_offset(ReconstructionFilter filter, const glm::dvec2& u) {
  if (filter == ReconstructionFilter::kBox) return u - 0.5;
  return {blackman_harris().offset(u.x), blackman_harris().offset(u.y)};
}

double filter_radius(ReconstructionFilter filter) {
  return filter == ReconstructionFilter::kBox ? 0.5 : BlackmanHarris::kRadius;
}

}  // namespace raygate
