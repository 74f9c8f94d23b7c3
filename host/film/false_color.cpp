#include "host/film/false_color.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <limits>

#include "host/base/elementary.h"

namespace raygate {
namespace {

constexpr std::array<Rgb8, 17> kViridis{{{68, 1, 84},
                                         {72, 24, 106},
                                         {71, 45, 123},
                                         {66, 64, 134},
                                         {59, 82, 139},
                                         {51, 99, 141},
                                         {44, 114, 142},
                                         {38, 129, 142},
                                         {33, 144, 140},
                                         {31, 159, 136},
                                         {40, 174, 128},
                                         {62, 188, 116},
                                         {93, 201, 99},
                                         {130, 211, 76},
                                         {171, 220, 50},
                                         {213, 226, 26},
                                         {253, 231, 37}}};
constexpr Rgb8 kNothing{0, 0, 0};

bool holds_labels(const Channel& channel) {
  return channel.name == "id" || channel.name == "objectId";
}

}  // namespace

Rgb8 viridis(double fraction) {
  const double place = std::clamp(fraction, 0.0, 1.0) * (kViridis.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(place), kViridis.size() - 2);
  Rgb8 color;
  for (std::size_t k = 0; k < 3; ++k) {
    color[k] = static_cast<std::uint8_t>(std::lround(
        std::lerp(kViridis[below][k], kViridis[below + 1][k], place - static_cast<double>(below))));
  }
  return color;
}

Rgb8 label_color(std::uint32_t label) {
  // Multiples of the golden ratio, modulo 1, keep away from each other however many there are.
  constexpr double kGolden = 0.6180339887498949;
  const double hue = std::fmod(label * kGolden, 1.0);
  const double light = 0.45 + 0.5 * std::fmod(label * kGolden * kGolden, 1.0);
  Rgb8 color;
  for (std::size_t k = 0; k < 3; ++k) {
    const double wave = 0.5 + 0.5 * sine_cosine(hue - static_cast<double>(k) / 3).cosine;
    color[k] = static_cast<std::uint8_t>(std::lround(255 * light * (0.25 + 0.75 * wave)));
  }
  return color;
}

Scale scale_of(const Channel& channel, std::size_t count) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Scale scale{kInfinity, -kInfinity};
  constexpr const char* kFromZero[] = {"tests", "doubts", "samples", "error"};
  if (std::ranges::find(kFromZero, channel.name) != std::end(kFromZero)) scale = {0.0, 0.0};
  for (std::size_t i = 0; i < count; ++i) {
    const double value = value_at(channel, i);
    if (!std::isfinite(value)) continue;
    scale.low = std::min(scale.low, value);
    scale.high = std::max(scale.high, value);
  }
  return scale.low <= scale.high ? scale : Scale{};
}

Image8 false_color(int width, int height, const PixelRect& window, const Channel& channel,
                   const std::optional<Scale>& wanted) {
  Image8 picture{width, height, window, {}, {}};
  const auto count =
      static_cast<std::size_t>(window.width()) * static_cast<std::size_t>(window.height());
  picture.pixels.reserve(count);
  if (holds_labels(channel)) {
    for (std::size_t i = 0; i < count; ++i) {
      const auto label = static_cast<std::uint32_t>(value_at(channel, i));
      picture.pixels.push_back(label == kNoPrimitive ? kNothing : label_color(label));
    }
    picture.texts.emplace_back("Scale", channel.name + ": a colour for each number");
    return picture;
  }
  const Scale scale = wanted.value_or(scale_of(channel, count));
  const double extent = scale.high - scale.low;
  for (std::size_t i = 0; i < count; ++i) {
    const double value = value_at(channel, i);
    const double fraction = extent > 0.0 ? (value - scale.low) / extent : 0.0;
    picture.pixels.push_back(std::isfinite(value) ? viridis(fraction) : kNothing);
  }
  picture.texts.emplace_back("Scale", legend(channel.name, scale));
  return picture;
}

std::string legend(const std::string& name, const Scale& scale) {
  char text[96];
  std::snprintf(text, sizeof text, ": %.6g (dark violet) to %.6g (yellow)", scale.low, scale.high);
  return name + text;
}

}  // namespace raygate
