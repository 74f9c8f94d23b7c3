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
#include <string_view>

#include "host/base/elementary.h"
#include "host/base/threads.h"

namespace raygate {
namespace {

constexpr std::uint32_t kViridis[] = {
    0x440154, 0x48186A, 0x472D7B, 0x424086, 0x3B528B, 0x33638D, 0x2C728E, 0x26818E, 0x21908C,
    0x1F9F88, 0x28AE80, 0x3EBC74, 0x5DC963, 0x82D34C, 0xABDC32, 0xD5E21A, 0xFDE725};  // 0xRRGGBB
constexpr Rgb8 kNothing{0, 0, 0};

bool holds_labels(const Channel& channel) {
  return channel.name == "id" || channel.name == "objectId";
}

double gain_of(double exposure) { return binary_power(std::clamp(exposure, -126.0, 127.0)); }

/// Writes a PNG file with libpng. Errors are C++ exceptions.
class PngWriter {
 public:
  explicit PngWriter(std::string& bytes)
      : png_(png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, throw_error, ignore_warning)),
        info_(png_ != nullptr ? png_create_info_struct(png_) : nullptr) {
    if (info_ == nullptr) {
      png_destroy_write_struct(&png_, nullptr);
      throw std::bad_alloc();
    }
    png_set_write_fn(png_, &bytes, append, nullptr);
  }
  PngWriter(const PngWriter&) = delete;
  PngWriter& operator=(const PngWriter&) = delete;
  ~PngWriter() { png_destroy_write_struct(&png_, &info_); }

  void write_header(const Image8& picture) {
    const PixelRect& window = picture.window;
    // By default libpng refuses sides of more than a million pixels.
    png_set_user_limits(png_, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    png_set_IHDR(png_, info_, static_cast<png_uint_32>(window.width()),
                 static_cast<png_uint_32>(window.height()), 8, PNG_COLOR_TYPE_RGB,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB_gAMA_and_cHRM(png_, info_, PNG_sRGB_INTENT_PERCEPTUAL);
    if (window.width() != picture.width || window.height() != picture.height) {
      png_set_oFFs(png_, info_, window.x0, window.y0, PNG_OFFSET_PIXEL);
    }
    for (const auto& [name, words] : picture.texts) {
      png_text text{};
      text.compression = PNG_TEXT_COMPRESSION_NONE;
      text.key = const_cast<char*>(name.c_str());
      text.text = const_cast<char*>(words.c_str());
      png_set_text(png_, info_, &text, 1);
    }
    png_write_info(png_, info_);
  }
  void write_row(const Rgb8* row) { png_write_row(png_, row->data()); }
  void finish() { png_write_end(png_, info_); }

 private:
  static void append(png_structp png, png_bytep data, std::size_t size) {
    static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<char*>(data), size);
  }
  [[noreturn]] static void throw_error(png_structp, png_const_charp message) {
    if (std::strstr(message, "emory") != nullptr) throw std::bad_alloc();
    throw std::runtime_error(std::string("libpng: ") + message);
  }
  static void ignore_warning(png_structp, png_const_charp) {}

  png_structp png_;
  png_infop info_;
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
  std::string bytes;
  PngWriter writer(bytes);
  writer.write_header(picture);
  const auto width = static_cast<std::size_t>(picture.window.width());
  for (std::size_t start = 0; start < picture.pixels.size(); start += width) {
    checkpoint();
    writer.write_row(picture.pixels.data() + start);
  }
  writer.finish();
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
