// Textures: lookup, decoding of files, and mapping onto triangles.
#include "host/scene/texture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "host/base/elementary.h"
#include "host/base/test/temp_folder.h"
#include "host/scene/io/scene_loader.h"
#include "host/scene/material_lookup.h"
#include "host/scene/scene.h"
#include "host/scene/test/tga.h"

namespace raygate {
namespace {

using test::tga;

constexpr Texture::Texel kRed{255, 0, 0}, kGreen{0, 255, 0}, kBlue{0, 0, 255}, kGrey{128, 128, 128};

/// Returns a texture of 2 x 2 texels: red and green above blue and grey.
Texture four() { return {2, 2, {kRed, kGreen, kBlue, kGrey}}; }

const auto kGreyLight = static_cast<float>(srgb_to_linear(128));

TEST(Texture, MiddlesOfTexelsHaveTheirLinearColour) {
  for (const Wrap wrap : {Wrap::kRepeat, Wrap::kClamp}) {
    EXPECT_EQ(four().at({0.25, 0.75}, wrap), glm::vec3(1, 0, 0)) << "v points up";
    EXPECT_EQ(four().at({0.75, 0.75}, wrap), glm::vec3(0, 1, 0));
    EXPECT_EQ(four().at({0.25, 0.25}, wrap), glm::vec3(0, 0, 1));
    EXPECT_EQ(four().at({0.75, 0.25}, wrap), glm::vec3(kGreyLight));
  }
}

TEST(Texture, InBetweenIsInProportion) {
  EXPECT_EQ(four().at({0.5, 0.75}, Wrap::kClamp), glm::vec3(0.5f, 0.5f, 0));
  EXPECT_EQ(four().at({0.25, 0.5}, Wrap::kClamp), glm::vec3(0.5f, 0, 0.5f));
  EXPECT_EQ(four().at({0.375, 0.75}, Wrap::kClamp), glm::vec3(0.75f, 0.25f, 0));
  const glm::vec3 middle = four().at({0.5, 0.5}, Wrap::kClamp);
  EXPECT_NEAR(middle.r, (1 + kGreyLight) / 4, 1e-6f);
}

TEST(Texture, OutsideItIsRepeatedOrItsBorderGoesOn) {
  for (const double whole : {-3.0, -1.0, 1.0, 1000.0}) {
    EXPECT_EQ(four().at({0.25 + whole, 0.75 - whole}, Wrap::kRepeat), glm::vec3(1, 0, 0));
  }
  EXPECT_EQ(four().at({0.0, 0.75}, Wrap::kRepeat), glm::vec3(0.5f, 0.5f, 0)) << "across the seam";
  EXPECT_EQ(four().at({0.0, 0.75}, Wrap::kClamp), glm::vec3(1, 0, 0));
  EXPECT_EQ(four().at({-7.0, 9.0}, Wrap::kClamp), glm::vec3(1, 0, 0));
  EXPECT_EQ(four().at({7.0, -9.0}, Wrap::kClamp), glm::vec3(kGreyLight));
}

TEST(Texture, MirrorsAndNearestTexels) {
  Sampling mirror(Wrap::kMirror);
  for (const double pair : {-4.0, 0.0, 2.0}) {
    EXPECT_EQ(four().at({0.25 + pair, 0.75}, mirror), glm::vec3(1, 0, 0));
    EXPECT_EQ(four().at({1.25 + pair, 0.75}, mirror), glm::vec3(0, 1, 0));
    EXPECT_EQ(four().at({0.25, 1.75 + pair}, mirror), glm::vec3(0, 0, 1));
  }
  EXPECT_EQ(four().at({1.0, 0.75}, mirror), glm::vec3(0, 1, 0)) << "no seam";
  mirror.v = Wrap::kRepeat;
  EXPECT_EQ(four().at({1.25, 1.75}, mirror), glm::vec3(0, 1, 0));
  Sampling nearest;
  nearest.is_nearest = true;
  EXPECT_EQ(four().at({0.49, 0.75}, nearest), glm::vec3(1, 0, 0));
  EXPECT_EQ(four().at({0.51, 0.75}, nearest), glm::vec3(0, 1, 0));
}

TEST(Texture, AnyCoordinatesAreTaken) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const double odd : {static_cast<double>(NAN), kInfinity, -kInfinity, 1e300, -1e-300, 1e17}) {
    for (const Wrap wrap : {Wrap::kRepeat, Wrap::kClamp}) {
      const glm::vec3 color = four().at({odd, -odd}, wrap);
      EXPECT_TRUE(color.r >= 0 && color.r <= 1) << odd;
    }
  }
  const Texture one(1, 1, {kBlue});
  EXPECT_EQ(one.at({0.3, 0.9}, Wrap::kRepeat), glm::vec3(0, 0, 1));
}

class TextureFile : public testing::Test {
 protected:
  [[nodiscard]] std::string error_of(const std::string& bytes) const {
    return folder_.error_of([&] { (void)Texture::load(folder_.write("t.png", bytes)); });
  }
  /// Loads a triangle of material `a` with texcoords (0, 0), (1, 0), (0, 1), and one without any.
  [[nodiscard]] Scene load(const std::string& mtl) const {
    folder_.write("m.mtl", "newmtl a\n" + mtl);
    return load_obj(
        folder_.write("s.obj",
                      "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n"
                      "usemtl a\nf 1/1 2/2 3/3\nf 1 3 2\n"));
  }

  const TempFolder folder_;
};

TEST_F(TextureFile, TexelsAreThoseOfTheFile) {
  const Texture read =
      Texture::load(folder_.write("t.tga", tga(2, 2, {kRed, kGreen, kBlue, kGrey})));
  EXPECT_EQ(read.width(), 2);
  EXPECT_EQ(read.height(), 2);
  for (const double u : {0.25, 0.75}) {
    for (const double v : {0.25, 0.75}) {
      EXPECT_EQ(read.at({u, v}, Wrap::kClamp), four().at({u, v}, Wrap::kClamp)) << u << " " << v;
    }
  }
}

TEST_F(TextureFile, WhatIsNoPictureIsRefused) {
  EXPECT_TRUE(error_of("text").starts_with("t.png: not a PNG, JPEG, TGA or BMP picture"));
  EXPECT_EQ(error_of(""), "t.png: the file is empty");
  EXPECT_TRUE(error_of("\x89PNG\r\n\x1a\n").starts_with("t.png: not a PNG, JPEG, TGA or BMP"));
}

/// stb_image would read some of these formats and would never finish with the Radiance header.
TEST_F(TextureFile, OtherFormatsAreRefused) {
  using namespace std::string_literals;
  const std::string radiance = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1000 +X 99999\n";
  const std::string refusal = "t.png: not a PNG, JPEG, TGA or BMP picture";
  for (const std::string& bytes :
       {radiance, std::string("#?RGBE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n\1\1\1\1"),
        "GIF89a\1\0\1\0\x80\0\0\0\0\0\xff\xff\xff,\0\0\0\0\1\0\1\0\0\2\2D\1\0;"s,
        std::string("P6 1 1 255\nabc"), std::string("8BPS\0\1", 6) + std::string(60, '\0'),
        std::string("\x53\x80\xf6\x34") + std::string(120, '\0')}) {
    EXPECT_TRUE(error_of(bytes).starts_with(refusal)) << error_of(bytes);
  }
}

TEST_F(TextureFile, DamagedFilesNeverCrash) {
  const std::string bytes = tga(9, 7, std::vector<Texture::Texel>(63, kGreen));
  std::mt19937_64 random(5);
  int refused = 0;
  for (int round = 0; round < 500; ++round) {
    std::string damaged = bytes;
    damaged[random() % 18] = static_cast<char>(random());
    damaged.resize(1 + random() % bytes.size());
    const std::string error = error_of(damaged);
    refused += error != "(read)";
    EXPECT_EQ(error.find('\n'), std::string::npos);
  }
  EXPECT_GT(refused, 50);
}

TEST_F(TextureFile, ATriangleIsPainted) {
  folder_.write("t.tga", tga(2, 2, {kRed, kGreen, kBlue, kGrey}));
  const Scene scene = load("Kd 0.5 1 1\nmap_Kd t.tga\n");
  EXPECT_TRUE(scene.warnings.empty());
  ASSERT_EQ(scene.textures.size(), 1u);
  const Triangle& painted = scene.triangles[0];
  // (u, v) = (0.25, 0.5): the mean of blue below and red above, times Kd.
  EXPECT_EQ(diffuse_at(scene, painted, {0.25, 0.25, 0.5}), glm::vec3(0.25f, 0, 0.5f));
  EXPECT_EQ(diffuse_at(scene, scene.triangles[1], {0.25, 0.25, 0.5}), glm::vec3(0.5f, 1, 1))
      << "no texture coordinates";
}

TEST_F(TextureFile, ScaleOffsetAndClamp) {
  folder_.write("t.tga", tga(2, 2, {kRed, kGreen, kBlue, kGrey}));
  const auto color = [&](const std::string& options) {
    const Scene scene = load("map_Kd " + options + " t.tga\n");
    EXPECT_TRUE(scene.warnings.empty()) << options;
    return diffuse_at(scene, scene.triangles[0], {0.25, 0.5, 0.25});  // (u, v) = (0.5, 0.25)
  };
  EXPECT_EQ(color("-s 0.5 1"), glm::vec3(0, 0, 1));
  EXPECT_EQ(color("-s 0.5"), glm::vec3(0, 0, 1));
  EXPECT_EQ(color("-o 0.75 0.5 0"), glm::vec3(1, 0, 0));
  EXPECT_EQ(color("-s 1 1 1 -o -0.25 0.5"), glm::vec3(1, 0, 0));
  EXPECT_EQ(color("-clamp on -o 9 9"), glm::vec3(0, 1, 0));
  EXPECT_EQ(color("-clamp off -o 8.75 9.5"), glm::vec3(1, 0, 0));
}

TEST_F(TextureFile, EachFileIsLoadedOnce) {
  folder_.write("sub/t.tga", tga(1, 1, {kRed}));
  folder_.write("m.mtl",
                "newmtl a\nmap_Kd sub\\t.tga\nnewmtl b\nmap_Kd sub/t.tga\n"
                "newmtl unused\nmap_Kd none.tga\n");
  const Scene scene = load_obj(folder_.write(
      "s.obj", "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\nusemtl b\nf 1 3 2\n"));
  EXPECT_TRUE(scene.warnings.empty());
  EXPECT_EQ(scene.textures.size(), 1u);
  EXPECT_EQ(scene.materials[0].diffuse_map.texture, 0u);
  EXPECT_EQ(scene.materials[1].diffuse_map.texture, 0u);
}

}  // namespace
}  // namespace raygate
