#include "host/film/display.h"

#include <png.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <new>
#include <stdexcept>
#include <string_view>

#include "host/base/elementary.h"
#include "host/base/threads.h"

namespace raygate {
namespace {

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

namespace {

constexpr int kLeastPixels = 16 * 16;
constexpr float kVisible = 1e-3f, kBlack = 1e-4f;  // relative to display white

}  // namespace

std::string why_blank(const Film& film, const DisplayOptions& display) {
  const bool is_whole = film.window.width() == film.width && film.window.height() == film.height;
  if (!is_whole || film.color.size() < kLeastPixels) return "";
  const auto exposure = static_cast<float>(std::exp2(display.exposure));
  const auto shown = [&](const glm::vec4& pixel) {
    return glm::clamp(glm::vec3(pixel) * exposure, glm::vec3(0.0f), glm::vec3(1.0f));
  };
  const auto largest = [](const glm::vec3& v) { return std::max({v.r, v.g, v.b}); };
  const glm::vec3 first = shown(film.color.front());
  const bool is_uniform = std::ranges::all_of(film.color, [&](const glm::vec4& pixel) {
    return largest(glm::abs(shown(pixel) - first)) <= kVisible;
  });
  if (!is_uniform) return "";
  const bool any_hit = std::ranges::any_of(
      film.primitive, [](std::uint32_t primitive) { return primitive != kNoPrimitive; });
  if (!any_hit) return "the camera sees nothing of the scene; --view iso shows all of it";
  if (largest(first) <= kBlack) {
    return "the picture is black: no light comes from what the camera sees; --exposure 4 shows "
           "what is dark, --integrator primary what has no light";
  }
  return "the picture is all one colour; --exposure -2 shows what is too bright, --integrator "
         "primary what has no light";
}

}  // namespace raygate
