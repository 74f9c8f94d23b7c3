// The measures against their definitions; reading EXR files, good and bad.
#include "host/film/compare.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>
#include <fstream>
#include <random>

#include "host/base/input_error.h"
#include "host/base/test/temp_folder.h"
#include "host/film/exr.h"
#include "host/film/test/sample_film.h"

namespace raygate {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
const std::vector<std::string> kColors{"R", "G", "B"};

ChannelPicture picture_of(int width, int height, std::vector<std::vector<double>> channels) {
  ChannelPicture picture{width, height, {0, 0, width, height}, {}, std::move(channels)};
  picture.names = kColors;
  picture.names.resize(picture.channels.size());
  return picture;
}

TEST(Compare, MeasuresAreAsDefined) {
  const ChannelPicture a = picture_of(2, 1, {{1.0, 0.5}, {0.0, 3.0}, {0.25, 0.25}});
  const ChannelPicture b = picture_of(2, 1, {{1.5, 0.5}, {0.0, 2.0}, {0.25, 0.25}});
  const Comparison c = compare(a, b);
  EXPECT_EQ(c.pixels, 2u);
  EXPECT_EQ(c.differing, 2u);
  EXPECT_EQ(c.not_finite, 0u);
  EXPECT_DOUBLE_EQ(c.mse, 1.25 / 6.0);
  EXPECT_DOUBLE_EQ(c.rmse, std::sqrt(1.25 / 6.0));
  EXPECT_DOUBLE_EQ(c.mae, 1.5 / 6.0);
  EXPECT_DOUBLE_EQ(c.bias, 0.5 / 4.5);
  EXPECT_DOUBLE_EQ(c.max, 1.0);
  EXPECT_DOUBLE_EQ(c.relative_mse, (0.25 / 2.26 + 1.0 / 4.01) / 6.0);
  EXPECT_DOUBLE_EQ(c.psnr, 10.0 * std::log10(6.0 / 1.25));
  EXPECT_EQ(c.difference, (std::vector<double>{0.5, 1.0}));
  EXPECT_FALSE(c.ssim) << "no window of 11 x 11 fits";
}

TEST(Compare, EqualPicturesAreEqual) {
  const ChannelPicture a = picture_of(2, 1, {{NAN, kInfinite}, {-kInfinite, 1e300}, {0.0, -0.0}});
  const Comparison c = compare(a, a);
  EXPECT_EQ(c.differing, 0u);
  EXPECT_EQ(c.not_finite, 0u);
  EXPECT_EQ(c.mse, 0.0);
  EXPECT_EQ(c.max, 0.0);
  EXPECT_EQ(c.psnr, kInfinite);
}

TEST(Compare, WhatIsNotFiniteInOneAloneIsInfinitelyWrong) {
  for (const double odd : {static_cast<double>(NAN), kInfinite, -kInfinite}) {
    const ChannelPicture a = picture_of(3, 1, {{0.0, odd, 1.0}});
    const ChannelPicture b = picture_of(3, 1, {{0.0, 0.5, 0.5}});
    for (const Comparison& c : {compare(a, b), compare(b, a)}) {
      EXPECT_EQ(c.differing, 2u);
      EXPECT_EQ(c.not_finite, 1u);
      EXPECT_EQ(c.mse, kInfinite);
      EXPECT_EQ(c.rmse, kInfinite);
      EXPECT_EQ(c.max, kInfinite);
      EXPECT_EQ(c.psnr, -kInfinite);
      EXPECT_EQ(c.difference[1], kInfinite);
      EXPECT_EQ(c.difference[2], 0.5);
    }
  }
}

TEST(Compare, CropsAreLaidOverEachOther) {
  // A whole of 4 x 3 and its part [1, 3) x [1, 3), wrong in one pixel.
  ChannelPicture whole = picture_of(4, 3, {{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}});
  ChannelPicture part = picture_of(4, 3, {{5, 6, 9, 12}});
  part.window = {1, 1, 3, 3};
  for (const Comparison& c : {compare(whole, part), compare(part, whole)}) {
    EXPECT_EQ(c.pixels, 4u);
    EXPECT_EQ(c.window.x0, 1);
    EXPECT_EQ(c.window.y1, 3);
    EXPECT_EQ(c.differing, 1u);
    EXPECT_EQ(c.max, 2.0);
  }
  part.window = {4, 1, 6, 3};
  EXPECT_THROW((void)compare(whole, part), InputError);
  part.width = 5;
  EXPECT_THROW((void)compare(whole, part), InputError);
}

/// The definition, window by window, without the separated sums.
double ssim_by_definition(const std::vector<double>& a, const std::vector<double>& b, int width) {
  const int height = static_cast<int>(a.size()) / width;
  double total = 0.0;
  int windows = 0;
  for (int y = 0; y + 11 <= height; ++y) {
    for (int x = 0; x + 11 <= width; ++x, ++windows) {
      double weight = 0.0, ma = 0.0, mb = 0.0, va = 0.0, vb = 0.0, cov = 0.0;
      const auto each = [&](auto visit) {
        for (int v = 0; v < 11; ++v) {
          for (int u = 0; u < 11; ++u) {
            const double w = std::exp(-((u - 5) * (u - 5) + (v - 5) * (v - 5)) / 4.5);
            const auto i = static_cast<std::size_t>((y + v) * width + x + u);
            visit(w, a[i], b[i]);
          }
        }
      };
      each([&](double w, double p, double q) { weight += w, ma += w * p, mb += w * q; });
      ma /= weight, mb /= weight;
      each([&](double w, double p, double q) {
        va += w * (p - ma) * (p - ma) / weight;
        vb += w * (q - mb) * (q - mb) / weight;
        cov += w * (p - ma) * (q - mb) / weight;
      });
      total +=
          (2 * ma * mb + 1e-4) * (2 * cov + 9e-4) / ((ma * ma + mb * mb + 1e-4) * (va + vb + 9e-4));
    }
  }
  return total / windows;
}

TEST(Compare, StructuralSimilarityIsAsDefined) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> any(0.0, 1.0);
  constexpr int kWidth = 23, kHeight = 17;
  std::vector<double> a, b, c;
  for (int i = 0; i < kWidth * kHeight; ++i) {
    a.push_back(0.5 + 0.4 * std::sin(0.1 * i));
    b.push_back(a.back() + 0.1 * (any(random) - 0.5));
    c.push_back(any(random));
  }
  for (const auto& other : {b, c}) {
    const auto value = ssim(a, other, kWidth);
    ASSERT_TRUE(value);
    EXPECT_NEAR(*value, ssim_by_definition(a, other, kWidth), 1e-10);
    EXPECT_LT(*value, 1.0);
  }
  EXPECT_DOUBLE_EQ(*ssim(a, a, kWidth), 1.0);
  EXPECT_GT(*ssim(a, b, kWidth), *ssim(a, c, kWidth));
  EXPECT_FALSE(ssim(std::vector<double>(10 * 30), std::vector<double>(10 * 30), 10));
}

class ExrFile : public testing::Test {
 protected:
  [[nodiscard]] std::string error_of(const std::filesystem::path& file,
                                     const std::vector<std::string>& names = kColors) const {
    try {
      (void)read_exr(file, names);
    } catch (const InputError& error) {
      return std::string(error.what()).substr(folder_.path().string().size() + 1);
    }
    return "(read)";
  }

  const TempFolder folder_;
};

TEST_F(ExrFile, ReadsWhatWasWritten) {
  const Film film = make_sample_film(64, 48, {5, 7, 60, 40}, true);
  const auto file = folder_.write("a.exr", encode_exr(film, {}));
  const ChannelPicture picture = read_exr(file, std::vector<std::string>{"G", "Z", "id"});
  EXPECT_EQ(picture.width, 64);
  EXPECT_EQ(picture.height, 48);
  EXPECT_EQ(picture.window.x0, 5);
  EXPECT_EQ(picture.window.y0, 7);
  EXPECT_EQ(picture.window.x1, 60);
  EXPECT_EQ(picture.window.y1, 40);
  for (std::size_t i = 0; i < film.color.size(); ++i) {
    ASSERT_EQ(picture.channels[0][i], film.color[i].g);
    ASSERT_EQ(picture.channels[1][i], film.depth[i]);
    ASSERT_EQ(picture.channels[2][i], film.primitive[i]);
  }
}

TEST_F(ExrFile, BadFilesAreRefusedInOneLine) {
  EXPECT_EQ(error_of(folder_.path() / "none.exr"),
            "none.exr: cannot read: No such file or directory");
  std::filesystem::create_directory(folder_.path() / "d.exr");
  EXPECT_EQ(error_of(folder_.path() / "d.exr"), "d.exr: cannot read: it is a folder");
  ASSERT_EQ(::mkfifo((folder_.path() / "p.exr").c_str(), 0600), 0);
  EXPECT_EQ(error_of(folder_.path() / "p.exr"),
            "p.exr: cannot read: it is a device, a pipe or a socket");
  EXPECT_EQ(error_of(folder_.write("t.exr", "text")), "t.exr: not an OpenEXR file");
  EXPECT_EQ(error_of(folder_.write("e.exr", "")), "e.exr: not an OpenEXR file");
  const std::string bytes = encode_exr(make_sample_film(20, 10, {0, 0, 20, 10}), {});
  EXPECT_EQ(error_of(folder_.write("a.exr", bytes), {"R", "P.X"}),
            "a.exr: no channel P.X; the file has A, B, G, N.X, N.Y, N.Z, R, Z, id");
}

/// Before memory is taken for it: fuzzing found a file of 2,634 bytes that took two gigabytes.
TEST_F(ExrFile, HeadersAreNoLongerThanTheFile) {
  std::string bytes = encode_exr(make_sample_film(20, 10, {0, 0, 20, 10}),
                                 {.software = {}, .scene = "cornell.obj"});
  const std::size_t length = bytes.find(std::string("scene\0string\0", 13)) + 13;
  ASSERT_EQ(bytes[length], 11);
  bytes.replace(length, 4, "ring");
  EXPECT_EQ(error_of(folder_.write("x.exr", bytes)),
            "x.exr: damaged: Attribute type vs. size mismatch");
  bytes = encode_exr(make_sample_film(20, 10, {0, 0, 20, 10}), {});
  const std::size_t box = bytes.find(std::string("dataWindow\0box2i\0", 17)) + 17;
  bytes[box] = 20;  // for 16
  bytes.insert(box + 4, 4, '\0');
  EXPECT_EQ(error_of(folder_.write("y.exr", bytes)),
            "y.exr: damaged: Attribute type vs. size mismatch");
}

/// Files cut or changed anywhere: read, or refused in one line.
TEST_F(ExrFile, DamagedFilesNeverCrash) {
  const std::string bytes = encode_exr(make_sample_film(20, 10, {0, 0, 20, 10}), {});
  std::mt19937_64 random(11);
  int refused = 0;
  for (int round = 0; round < 400; ++round) {
    std::string damaged = bytes;
    if (round % 2 == 0) {
      damaged.resize(random() % bytes.size());
    } else {
      for (int i = 0; i < 3; ++i) damaged[random() % bytes.size()] = static_cast<char>(random());
    }
    const std::string error = error_of(folder_.write("x.exr", damaged));
    refused += error != "(read)";
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
  }
  EXPECT_GT(refused, 150);
}

}  // namespace
}  // namespace raygate
