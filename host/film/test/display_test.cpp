// Tests 8-bit pictures: tone curves, PNG files read back with libpng, and false colours.
#include "host/film/display.h"

#include <gtest/gtest.h>
#include <png.h>

#include <cmath>
#include <limits>

#include "host/base/elementary.h"
#include "host/base/test/temp_folder.h"
#include "host/film/test/sample_film.h"

namespace raygate {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

void expect_codes(const Film& film, const DisplayOptions& options, float gain) {
  const Image8 picture = to_display(film, options);
  EXPECT_EQ(picture.width, film.width);
  EXPECT_EQ(picture.window.x0, film.window.x0);
  ASSERT_EQ(picture.pixels.size(), film.color.size());
  for (std::size_t i = 0; i < film.color.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      ASSERT_EQ(picture.pixels[i][static_cast<std::size_t>(k)],
                linear_to_srgb(gain * film.color[i][k]));
    }
  }
}

TEST(Display, IsPlainSrgbUnlessToldOtherwise) {
  expect_codes(make_sample_film(67, 41, {3, 2, 67, 41}), {}, 1.0f);
}

TEST(Display, AStopDoublesTheLight) {
  const Film film = make_sample_film(32, 32, {0, 0, 32, 32});
  expect_codes(film, {.exposure = 1.0, .tone = Tone::kClip}, 2.0f);
  expect_codes(film, {.exposure = -3.0, .tone = Tone::kClip}, 0.125f);
}

TEST(Display, FilmicToneIsMonotoneAndBounded) {
  EXPECT_EQ(tone_map(0.0f, Tone::kFilmic), 0.0f);
  float last = 0.0f;
  for (float light = 1e-3f; light < 1e4f; light *= 1.1f) {
    const float now = tone_map(light, Tone::kFilmic);
    EXPECT_GE(now, last);
    EXPECT_LE(now, 1.0f);
    last = now;
  }
  EXPECT_NEAR(tone_map(0.18f, Tone::kFilmic), 0.26689f, 1e-4f);  // computed by hand
  EXPECT_LT(tone_map(1.0f, Tone::kFilmic), 0.9f) << "room is left for brighter light";
  EXPECT_EQ(tone_map(kInfinity, Tone::kFilmic), 1.0f);
  EXPECT_EQ(tone_map(-1.0f, Tone::kFilmic), 0.0f);
  EXPECT_TRUE(std::isnan(tone_map(std::numeric_limits<float>::quiet_NaN(), Tone::kFilmic)));
  EXPECT_EQ(tone_map(7.0f, Tone::kClip), 7.0f);
}

struct Decoded {
  png_image image{};
  std::vector<std::uint8_t> pixels;
};

/// Returns the codes of the file without conversion.
Decoded decode(const std::string& bytes) {
  Decoded decoded;
  decoded.image.version = PNG_IMAGE_VERSION;
  EXPECT_NE(png_image_begin_read_from_memory(&decoded.image, bytes.data(), bytes.size()), 0);
  EXPECT_EQ(decoded.image.format, PNG_FORMAT_RGB) << "24-bit colour";
  decoded.pixels.resize(PNG_IMAGE_SIZE(decoded.image));
  EXPECT_NE(png_image_finish_read(&decoded.image, nullptr, decoded.pixels.data(), 0, nullptr), 0)
      << decoded.image.message;
  return decoded;
}

/// Returns the data of the first chunk of this type, which libpng's simple reader does not show.
std::string chunk(const std::string& bytes, const std::string& type) {
  for (std::size_t at = 8; at + 12 <= bytes.size();) {
    std::size_t size = 0;
    for (std::size_t i = 0; i < 4; ++i) size = size << 8 | static_cast<std::uint8_t>(bytes[at + i]);
    if (bytes.compare(at + 4, 4, type) == 0) return bytes.substr(at + 8, size);
    at += size + 12;
  }
  return "(none)";
}

/// Returns a picture in which all pixels differ.
Image8 sample(int width, int height, PixelRect window) {
  Image8 picture{width, height, window, {}, {}};
  for (int i = 0; i < window.width() * window.height(); ++i) {
    const auto code = [&](int factor) { return static_cast<std::uint8_t>(i * factor); };
    picture.pixels.push_back({code(1), code(7), code(i)});
  }
  return picture;
}

void expect_all_codes_kept(const Image8& picture) {
  const Decoded decoded = decode(encode_png(picture));
  ASSERT_EQ(decoded.image.width, static_cast<unsigned>(picture.window.width()));
  ASSERT_EQ(decoded.image.height, static_cast<unsigned>(picture.window.height()));
  for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      ASSERT_EQ(decoded.pixels[3 * i + k], picture.pixels[i][k])
          << "pixel " << i << " channel " << k;
    }
  }
}

TEST(Png, KeepsEveryCode) {
  expect_all_codes_kept(sample(67, 41, {0, 0, 67, 41}));
  expect_all_codes_kept(sample(1, 1, {0, 0, 1, 1}));
}

TEST(Png, SaysThatItIsSrgb) {
  const std::string bytes = encode_png(sample(3, 3, {0, 0, 3, 3}));
  EXPECT_EQ(chunk(bytes, "sRGB"), std::string(1, '\0'));            // intent: perceptual
  EXPECT_EQ(chunk(bytes, "gAMA"), std::string("\0\0\xb1\x8f", 4));  // 0.45455 for older readers
  EXPECT_EQ(chunk(bytes, "oFFs"), "(none)");
  EXPECT_EQ(chunk(bytes, "tIME"), "(none)");
  EXPECT_EQ(chunk(bytes, "tEXt"), "(none)");
}

TEST(Png, CropHoldsTheWindowAndItsPlace) {
  const Image8 picture = sample(640, 480, {300, 258, 333, 298});
  expect_all_codes_kept(picture);
  EXPECT_EQ(chunk(encode_png(picture), "oFFs"), std::string("\0\0\1\x2c\0\0\1\2\0", 9));
}

TEST(Png, SaysItsTexts) {
  Image8 picture = sample(3, 3, {0, 0, 3, 3});
  picture.texts.emplace_back("Scale", "tests: 0 to 9");
  EXPECT_EQ(chunk(encode_png(picture), "tEXt"), std::string("Scale\0tests: 0 to 9", 19));
  expect_all_codes_kept(picture);
}

TEST(Png, EqualPicturesGiveEqualBytes) {
  Image8 picture = sample(50, 40, {0, 0, 50, 40});
  const std::string first = encode_png(picture);
  EXPECT_EQ(first, encode_png(Image8(picture)));
  ++picture.pixels[9][1];
  EXPECT_NE(first, encode_png(picture));
}

}  // namespace
}  // namespace raygate
