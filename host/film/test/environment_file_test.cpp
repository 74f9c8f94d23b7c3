// Reads environment maps from valid files, and refuses other files.
#include "host/film/environment_file.h"

#include <ImfArray.h>
#include <ImfRgbaFile.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>
#include <string>
#include <thread>

#include "host/base/input_error.h"
#include "host/base/test/temp_folder.h"

namespace raygate {
namespace {

using namespace std::string_literals;

const std::string kHeader = "#?RADIANCE\n# made by hand\nFORMAT=32-bit_rle_rgbe\nEXPOSURE= 2\n\n";

class EnvironmentFile : public testing::Test {
 protected:
  [[nodiscard]] EnvironmentMap hdr(const std::string& rest) const {
    return read_hdr(folder_.write("a.hdr", kHeader + rest));
  }
  void expect_refused(const std::string& bytes, const std::string& why) const {
    const std::string error =
        folder_.error_of([&] { (void)read_hdr(folder_.write("a.hdr", bytes)); });
    EXPECT_TRUE(error.starts_with("a.hdr: " + why)) << error;
  }
  const TempFolder folder_;
};

TEST_F(EnvironmentFile, PixelsOneByOne) {
  // The first texel's red is 128 * 2^(136 - 136) / 2: mantissa 0x80, exponent 0x88, EXPOSURE 2.
  const EnvironmentMap picture = hdr("-Y 1 +X 2\n\x80\x40\x20\x88"s + "\0\0\0\0"s);
  EXPECT_EQ(picture.width, 2);
  ASSERT_EQ(picture.texels.size(), 2u);
  EXPECT_EQ(picture.texels[0], glm::vec3(64, 32, 16));
  EXPECT_EQ(picture.texels[1], glm::vec3(0.0f));
}

TEST_F(EnvironmentFile, RunsOfComponents) {
  const std::string row =
      "\x02\x02\0\x08"s + "\x88\x10"s + "\x03\x01\x02\x03\x85\x04"s + "\x88\0"s + "\x88\x88"s;
  const EnvironmentMap picture = hdr("-Y 1 +X 8\n" + row);
  ASSERT_EQ(picture.texels.size(), 8u);
  EXPECT_EQ(picture.texels[0], glm::vec3(8, 0.5, 0));
  EXPECT_EQ(picture.texels[2], glm::vec3(8, 1.5, 0));
  EXPECT_EQ(picture.texels[7], glm::vec3(8, 2, 0));
  // A file is refused wherever it is cut.
  const std::string whole = kHeader + "-Y 1 +X 8\n" + row;
  for (std::size_t size = 1; size < whole.size(); ++size) {
    EXPECT_THROW((void)read_hdr(folder_.write("a.hdr", whole.substr(0, size))), InputError);
  }
}

TEST_F(EnvironmentFile, DamagedOnesAreRefused) {
  expect_refused("P6 1 1 255", "found a file of another kind, expected ");
  expect_refused("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n", "'FORMAT=32-bit_rle_xyze', expected ");
  expect_refused("#?RADIANCE\nEXPOSURE=0\n\n", "EXPOSURE: expected a positive number");
  expect_refused(kHeader + "+Y 2 +X 2\n", "'+Y 2 +X 2', expected -Y HEIGHT +X WIDTH");
  expect_refused(kHeader + "-Y 0 +X 2\n", "'-Y 0 +X 2', expected ");
  expect_refused(kHeader + "-Y 2000000 +X 2000000\n", "more than 67108864 pixels");
  expect_refused(kHeader + "-Y 1 +X 8\n\x02\x02\0\x09"s, "damaged: a row of 9 pixels");
  expect_refused(kHeader + "-Y 1 +X 8\n\x02\x02\0\x08\x89\x01"s, "damaged: a run that is too long");
}

TEST_F(EnvironmentFile, LieAsTheSceneDoes) {
  const auto file = folder_.path() / "sky.exr";
  {
    Imf::Array2D<Imf::Rgba> pixels(1, 2);
    pixels[0][0] = {1.0f, 2.0f, 3.0f, 1.0f};
    pixels[0][1] = {-1.0f, 0.5f, 0.0f, 1.0f};
    Imf::RgbaOutputFile out(file.c_str(), 2, 1, Imf::WRITE_RGBA);
    out.setFrameBuffer(&pixels[0][0], 1, 2);
    out.writePixels(1);
  }
  Scene scene;
  load_environment({file, 0.0, 2.0}, {0, 3, 0}, scene);
  ASSERT_TRUE(scene.environment);
  EXPECT_EQ(scene.environment->width, 2);
  EXPECT_EQ(scene.environment->height, 1);
  EXPECT_EQ(scene.environment->texel(0, 0), glm::vec3(1, 2, 3));
  EXPECT_EQ(scene.environment->texel(1, 0), glm::vec3(0, 0.5, 0)) << "nothing negative";
  EXPECT_EQ(scene.environment->strength, 2.0f);
  EXPECT_EQ(scene.environment->up, glm::dvec3(0, 1, 0));
  EXPECT_EQ(scene.environment->ahead, glm::dvec3(0, 0, -1));
  EXPECT_EQ(scene.files.back(), file) << "no output may overwrite it";
  load_environment({file, 90.0, 1.0}, {0, 1, 0}, scene);
  EXPECT_NEAR(glm::length(scene.environment->ahead - glm::dvec3(-1, 0, 0)), 0.0, 1e-12);
  load_environment({file, 0.0, 1.0}, {0, 0, 1}, scene);
  EXPECT_NEAR(glm::length(scene.environment->ahead - glm::dvec3(0, 1, 0)), 0.0, 1e-12);
  EXPECT_THROW(load_environment({folder_.path() / "none.exr", 0.0, 1.0}, {0, 1, 0}, scene),
               InputError);
  const auto circle = folder_.path() / "circle.hdr";
  std::filesystem::create_symlink(circle, circle);
  EXPECT_THROW(load_environment({circle, 0.0, 1.0}, {0, 1, 0}, scene), InputError);
  const auto pipe = folder_.path() / "pipe.hdr";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  std::jthread writer([&] { std::ofstream(pipe) << kHeader + "-Y 1 +X 1\n\x01\x02\x03\x80"; });
  load_environment({pipe, 0.0, 1.0}, {0, 1, 0}, scene);
  EXPECT_EQ(scene.environment->width, 1);
  const auto png = folder_.write("sky.png", "\x89PNG\r\n\x1a\n");
  EXPECT_EQ(folder_.error_of([&] {
    load_environment({png, 0.0, 1.0}, {0, 1, 0}, scene);
  }),
            "sky.png: found a file of another kind, expected OpenEXR or Radiance HDR");
}

}  // namespace
}  // namespace raygate
