#include "host/film/display.h"

#include <png.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <iterator>
#include <limits>
#include <new>
#include <stdexcept>

#include "host/base/elementary.h"
#include "host/base/input_error.h"
#include "host/base/threads.h"

namespace raygate {
namespace {

constexpr std::uint32_t kViridis[] = {
    0x440154, 0x48186A, 0x472D7B, 0x424086, 0x3B528B, 0x33638D, 0x2C728E, 0x26818E, 0x21908C,
    0x1F9F88, 0x28AE80, 0x3EBC74, 0x5DC963, 0x82D34C, 0xABDC32, 0xD5E21A, 0xFDE725};  // 0xRRGGBB
constexpr Rgb8 kNothing{0, 0, 0};

double gain_of(double exposure) { return binary_power(std::clamp(exposure, -126.0, 127.0)); }

// Callbacks of libpng. Errors are C++ exceptions.
void append(png_structp png, png_bytep data, std::size_t size) {
  static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<char*>(data), size);
}
[[noreturn]] void throw_error(png_structp, png_const_charp message) {
  if (std::strstr(message, "emory") != nullptr) throw std::bad_alloc();
  throw std::runtime_error(std::string("libpng: ") + message);
}
void ignore_warning(png_structp, png_const_charp) {}

struct PngStructs {
  png_structp png =
      png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, throw_error, ignore_warning);
  png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;

  PngStructs() = default;
  PngStructs(const PngStructs&) = delete;
  PngStructs& operator=(const PngStructs&) = delete;
  ~PngStructs() { png_destroy_write_struct(&png, &info); }
};

}  // namespace

float tone_map(float light, Tone tone) {
  if (tone == Tone::kClip) return light;
  // Clamped, as infinity / infinity would be NaN.
  const double x = std::min(std::max(light, 0.0f), 1e6f);
  if (std::isnan(light)) return light;
  return static_cast<float>(std::min(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 1.0));
}

float display_steps(const glm::vec3& light, double exposure) {
  const glm::dvec3 c(light);
  return static_cast<float>(
      255.0 * srgb_curve_above(gain_of(exposure) * (0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b)));
}

Image8 to_display(const Film& film, const DisplayOptions& options) {
  Image8 picture{film.width, film.height, film.window, {}, {}};
  picture.pixels.reserve(film.color.size());
  const auto gain = static_cast<float>(gain_of(options.exposure));
  for (const glm::vec4& color : film.color) {
    if (picture.pixels.size() % 4096 == 0) checkpoint();
    Rgb8& codes = picture.pixels.emplace_back();
    for (int k = 0; k < 3; ++k) {
      codes[static_cast<std::size_t>(k)] = linear_to_srgb(tone_map(gain * color[k], options.tone));
    }
  }
  return picture;
}

std::string encode_png(const Image8& picture) {
  static_assert(sizeof(Rgb8) == 3, "rows go to libpng as they are");
  const PixelRect& window = picture.window;
  const PngStructs structs;
  const png_structp png = structs.png;
  const png_infop info = structs.info;
  if (info == nullptr) throw std::bad_alloc();
  std::string bytes;
  png_set_write_fn(png, &bytes, append, nullptr);
  // By default libpng refuses sides of more than a million pixels.
  png_set_user_limits(png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
  png_set_IHDR(png, info, static_cast<png_uint_32>(window.width()),
               static_cast<png_uint_32>(window.height()), 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
  if (window.width() != picture.width || window.height() != picture.height) {
    png_set_oFFs(png, info, window.x0, window.y0, PNG_OFFSET_PIXEL);
  }
  for (const auto& [name, words] : picture.texts) {
    png_text text{};
    text.compression = PNG_TEXT_COMPRESSION_NONE;
    text.key = const_cast<char*>(name.c_str());
    text.text = const_cast<char*>(words.c_str());
    png_set_text(png, info, &text, 1);
  }
  png_write_info(png, info);
  const auto width = static_cast<std::size_t>(window.width());
  for (std::size_t start = 0; start < picture.pixels.size(); start += width) {
    checkpoint();
    png_write_row(png, picture.pixels[start].data());
  }
  png_write_end(png, info);
  return bytes;
}

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

Image8 false_color(const Film& film, const std::string& name) {
  const std::vector<Channel> channels = channels_of(film);
  const auto channel = std::ranges::find(channels, name, &Channel::name);
  if (channel == channels.end()) {
    throw InputError("--false-colour: found no channel " + name +
                     " in the picture, expected one that it has");
  }
  Image8 picture{film.width, film.height, film.window, {}, {}};
  const std::size_t count = film.color.size();
  picture.pixels.reserve(count);
  if (name == "id" || name == "objectId") {
    for (std::size_t i = 0; i < count; ++i) {
      const auto label = static_cast<std::uint32_t>(value_at(*channel, i));
      picture.pixels.push_back(label == kNoPrimitive ? kNothing : label_color(label));
    }
    picture.texts.emplace_back("Scale", name + ": a colour for each number");
    return picture;
  }
  constexpr const char* kFromZero[] = {"tests", "doubts", "samples", "error"};
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const bool is_from_zero = std::ranges::find(kFromZero, name) != std::end(kFromZero);
  double low = is_from_zero ? 0.0 : kInfinity, high = is_from_zero ? 0.0 : -kInfinity;
  for (std::size_t i = 0; i < count; ++i) {
    const double value = value_at(*channel, i);
    if (!std::isfinite(value)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  if (low > high) low = high = 0.0;  // there is no finite value
  for (std::size_t i = 0; i < count; ++i) {
    const double value = value_at(*channel, i);
    const double fraction = high > low ? (value - low) / (high - low) : 0.0;
    picture.pixels.push_back(std::isfinite(value) ? viridis(fraction) : kNothing);
  }
  char legend[96];
  std::snprintf(legend, sizeof legend, ": %.6g (dark violet) to %.6g (yellow)", low, high);
  picture.texts.emplace_back("Scale", name + legend);
  return picture;
}

}  // namespace raygate
