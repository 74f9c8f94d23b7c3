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

constexpr std::uint32_t kViridis[] = {
    0x440154, 0x48186A, 0x472D7B, 0x424086, 0x3B528B, 0x33638D, 0x2C728E, 0x26818E, 0x21908C,
    0x1F9F88, 0x28AE80, 0x3EBC74, 0x5DC963, 0x82D34C, 0xABDC32, 0xD5E21A, 0xFDE725};  // 0xRRGGBB
constexpr Rgb8 kNothing{0, 0, 0};

bool holds_labels(const Channel& channel) {
  return channel.name == "id" || channel.name == "objectId";
}

}  // namespace

Rgb8 viridis(double fraction) {
  const double place = std::clamp(fraction, 0.0, 1.0) * (std::size(kViridis) - 1);
  const auto below = std::min(static_cast<std::size_t>(place), std::size(kViridis) - 2);
  Rgb8 color;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto code = [&](std::size_t i) { return kViridis[i] >> (16 - 8 * k) & 0xFF; };
    color[k] = static_cast<std::uint8_t>(
        std::lround(std::lerp(code(below), code(below + 1), place - static_cast<double>(below))));
  }
  return color;
}

Rgb8 label_color(std::uint32_t label) {
  // Multiples of the golden ratio modulo 1 are well separated, for any number of labels.
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
