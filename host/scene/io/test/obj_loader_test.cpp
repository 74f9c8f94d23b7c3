// Loads valid OBJ files of every unusual kind, and compares all bits.
#include <gtest/gtest.h>

#include "host/base/elementary.h"
#include "host/base/input_error.h"
#include "host/base/test/temp_folder.h"
#include "host/scene/io/scene_loader.h"

namespace raygate {
namespace {

using Indices = std::array<std::uint32_t, 3>;
using Positions = std::vector<glm::vec3>;

constexpr std::string_view kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

Scene load(std::string_view text, const LoadOptions& options = {}) {
  const TempFolder folder;
  const std::filesystem::path file = folder.write("scene.obj", text);
  return load_obj(file, options);
}

Scene load_square(std::string_view more) { return load(std::string(kSquare) + std::string(more)); }

std::vector<Indices> vertices_of(const Scene& scene) {
  std::vector<Indices> vertices;
  for (const Triangle& triangle : scene.triangles) vertices.push_back(triangle.vertices);
  return vertices;
}

// Returns the only warning, "scene.obj:LINE: what", without the folder.
std::string only_warning(const Scene& scene) {
  if (scene.warnings.size() != 1) return std::to_string(scene.warnings.size()) + " warnings";
  return scene.warnings[0].substr(scene.warnings[0].rfind('/', scene.warnings[0].find(':')) + 1);
}

const std::vector<Indices> kOneTriangle{{0, 1, 2}};
const std::vector<Indices> kTwoTriangles{{0, 1, 2}, {0, 2, 3}};

TEST(LoadObj, Triangle) {
  const Scene scene = load("v 0 0 0\nv 1 0 0\nv 0 1 0.1\nf 1 2 3\n");
  EXPECT_EQ(scene.positions, (Positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0.1f}}));
  EXPECT_EQ(vertices_of(scene), kOneTriangle);
  EXPECT_EQ(scene.triangles[0].normals, (Indices{kNoIndex, kNoIndex, kNoIndex}));
  EXPECT_EQ(scene.triangles[0].texcoords, (Indices{kNoIndex, kNoIndex, kNoIndex}));
  EXPECT_EQ(scene.objects, std::vector<std::string>{"default"});
  ASSERT_EQ(scene.materials.size(), 1u);
  EXPECT_EQ(scene.materials[0].name, "default");
  EXPECT_EQ(scene.origin, glm::dvec3(0));
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(LoadObj, AQuadInManyForms) {
  const std::string square(kSquare);
  for (const std::string& text :
       {square + "f 1 2 3 4\n", square + "f 1 2 3 4", square + "f -4 -3 -2 -1\n",
        // Negative indices count back from their face, not from the end of the file.
        std::string("v 0 0 0\nv 1 0 0\nv 1 1 0\nf -3 -2 -1\nv 0 1 0\nf -4 -2 -1\n"),
        "f 1 2 3 4\n" + square, "\xEF\xBB\xBF" + square + "f 1 2 3 4\n",
        std::string("v 0 \\\n0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2\\\n 3 \\\r\n4\n"),
        std::string("  # comment\n\tv\t0  0\t0 # origin\n v 1 0 0  \nv 1 1 0\nv 0 1 0 #\n"
                    "f  1\t2 3  4 # 5 6\n")}) {
    EXPECT_EQ(vertices_of(load(text)), kTwoTriangles) << text;
  }
}

TEST(LoadObj, AllCornerForms) {
  const std::string attributes = "vt 0 0\nvt 1 0.5\nvt 1\nvn 0 0 2\nvn 0 3 4\n";
  const Scene both = load_square(attributes + "f 1/1/2 2/2/2 3/3/1\n");
  EXPECT_EQ(both.triangles[0].texcoords, (Indices{0, 1, 2}));
  EXPECT_EQ(both.triangles[0].normals, (Indices{1, 1, 0}));
  EXPECT_EQ(both.texcoords, (std::vector<glm::vec2>{{0, 0}, {1, 0.5f}, {1, 0}}));
  EXPECT_EQ(both.normals, (Positions{{0, 0, 1}, {0, 0.6f, 0.8f}})) << "unit length";

  const Scene texcoords = load_square(attributes + "f 1/-3 2/-2 3/-1\n");
  EXPECT_EQ(texcoords.triangles[0].texcoords, (Indices{0, 1, 2}));
  EXPECT_EQ(texcoords.triangles[0].normals, (Indices{kNoIndex, kNoIndex, kNoIndex}));

  const Scene normals = load_square(attributes + "f 1//1 2//1 3//-1\n");
  EXPECT_EQ(normals.triangles[0].texcoords, (Indices{kNoIndex, kNoIndex, kNoIndex}));
  EXPECT_EQ(normals.triangles[0].normals, (Indices{0, 0, 1}));
}

TEST(LoadObj, NumbersOfAllKinds) {
  const Scene scene = load("v +1 .5 -2.\nv 1e-3 1E+2 -0\nv 1e-400 8.507059e37 0\nf 1 2 3\n");
  EXPECT_EQ(scene.positions, (Positions{{1, 0.5f, -2}, {0.001f, 100, 0}, {0, 8.507059e37f, 0}}));
}

TEST(LoadObj, WeightsAndColoursOfVertices) {
  const Scene coloured = load("v 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 0 1 0 1 0 0 1\nf 1 2 3\n");
  EXPECT_EQ(coloured.positions, (Positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_TRUE(coloured.warnings.empty());
  EXPECT_EQ(coloured.colors, (Positions{{1, 0, 0}, {1, 0, 0}, {1, 0, 0}}));
  EXPECT_EQ(coloured.materials[0].diffuse, glm::vec3(1)) << "colours as they are";
  const Scene bytes = load("v 0 0 0 255 0 51\nv 1 0 0\nv 0 1 0 0 0 0\nf 1 2 3\n");
  const auto fifth = static_cast<float>(srgb_to_linear(51));
  EXPECT_EQ(bytes.colors, (Positions{{1, 0, fifth}, {1, 1, 1}, {0, 0, 0}}));
  EXPECT_TRUE(load("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").colors.empty());
  const Scene weighted = load("v 0 0 0 1\nv 1 0 0 0.5\nv 0 1 0 0.5\nf 1 2 3\n");
  EXPECT_EQ(weighted.positions, (Positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_EQ(only_warning(weighted),
            "scene.obj:2: vertex weights are ignored: they concern curves alone");
}

TEST(LoadObj, FarFromTheOriginKeepsItsDigits) {
  const Scene scene = load(
      "v 4500000.125 1000000.0625 0\nv 4500001.125 1000000.0625 0\nv 4500000.125 1000001.1875 "
      "0.001\nf 1 2 3\n");
  const auto world = [&](int i) { return scene.origin + glm::dvec3(scene.positions[i]); };
  EXPECT_NE(scene.origin, glm::dvec3(0));
  EXPECT_EQ(world(0), glm::dvec3(4500000.125, 1000000.0625, 0));
  EXPECT_EQ(world(1), glm::dvec3(4500001.125, 1000000.0625, 0));
  EXPECT_EQ(world(2), glm::dvec3(4500000.125, 1000001.1875, 0.001f));
}

TEST(LoadObj, UnusedVerticesDoNotMatter) {
  const Scene scene =
      load("v 1e30 0 0\nv 1000000.25 0 0\nv 1000001.25 0 0\nv 1000000.25 1 0\nf 2 3 4\n");
  EXPECT_EQ(scene.positions.size(), 3u);
  EXPECT_EQ(scene.origin.x + scene.positions[0].x, 1000000.25);
  EXPECT_EQ(vertices_of(scene), kOneTriangle);
}

TEST(LoadObj, ObjectsAndGroups) {
  const Scene scene = load_square(
      "f 1 2 3\no room\nf 1 2 3\ng  a  b \nf 1 2 3\nf 2 3 4\no\nf 1 2 3\ng\nf 1 2 3\no room\ng a "
      "b\n"
      "f 1 2 3\ng unused\n");
  EXPECT_EQ(scene.objects, (std::vector<std::string>{"default", "room", "room/a b", "a b"}));
  std::vector<std::uint32_t> objects;
  for (const Triangle& triangle : scene.triangles) objects.push_back(triangle.object);
  EXPECT_EQ(objects, (std::vector<std::uint32_t>{0, 1, 2, 2, 3, 0, 2}));
}

TEST(LoadObj, WhatIsNoPolygonIsIgnoredWithOneWarningEach) {
  const Scene scene = load_square("l 1 2\nl 2 3\np 1\nf 1 2 3\ns 1\ns off\nfo 1 3 4\n");
  EXPECT_EQ(vertices_of(scene), kTwoTriangles);
  ASSERT_EQ(scene.warnings.size(), 2u);
  EXPECT_TRUE(scene.warnings[0].ends_with(
      "scene.obj:5: 'l' statements are ignored: only polygons are rendered"));
  EXPECT_TRUE(scene.warnings[1].ends_with(
      "scene.obj:7: 'p' statements are ignored: only polygons are rendered"));
}

TEST(LoadObj, FacesWithoutAreaAreLeftOut) {
  const std::string text = std::string(kSquare) + "f 1 1 2\nf 1 2 3 4\nf 1 2 1 2\n";
  const Scene scene = load(text);
  // The other faces keep their indices.
  EXPECT_EQ(vertices_of(scene),
            (std::vector<Indices>{{0, 0, 0}, {0, 1, 2}, {0, 2, 3}, {0, 0, 0}, {0, 0, 0}}));
  EXPECT_EQ(only_warning(scene),
            "scene.obj:5: face of zero area, left out, here and in 1 later face");
  EXPECT_THROW((void)load(std::string(kSquare) + "f 1 1 2\n"), InputError) << "nothing is left";
}

TEST(LoadObj, CornersThatBinary32MovesAreCounted) {
  // Floats near the first face are 0.5 apart.
  const std::string far =
      "v 5411987 0 0\nv 5411987 1 0\nv 5411987.2 0 0\nv -1 0 0\nv 0 0 0\nv -1 1 0\n";
  const std::string flattened = far + "f 1 2 3\nf 4 5 6\n";
  const LoadOptions binary32{.vertices = Vertices::kBinary32};
  const Scene scene = load(flattened, binary32);
  EXPECT_EQ(scene.rounding.corners, 1u);
  EXPECT_NEAR(scene.rounding.most, 0.2, 1e-9);
  EXPECT_EQ(only_warning(scene), "scene.obj:7: face flattened by rounding to binary32, left out");
  const Scene moved = load(far + "v 5411988 0 0\nf 7 2 3\nf 4 5 6\n", binary32);
  EXPECT_EQ(only_warning(moved),
            "scene.obj:8: corners moved by up to 0.2, more than a hundredth of their face, by "
            "rounding to binary32");
  for (const Vertices vertices : {Vertices::kBinary64, Vertices::kAsPictures}) {
    const Scene exact = load(flattened, {.vertices = vertices});
    EXPECT_EQ(exact.rounding.corners, 0u);
    EXPECT_TRUE(exact.warnings.empty());
    EXPECT_EQ(exact.origin + exact.vertex(2), glm::dvec3(5411987.2, 0, 0));
    EXPECT_EQ(exact.origin + exact.vertex(3), glm::dvec3(-1, 0, 0));
    // kAsPictures rounds positions if no picture shows it.
    const Scene near = load("v 0.1 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", {.vertices = vertices});
    EXPECT_EQ(near.rests.empty(), vertices == Vertices::kAsPictures);
    // It also rounds faces without area, and a face that rounding flattens but hardly moves.
    const Scene flat = load(
        "v 0.1 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 1 1\nv 1000000.1 0 0\nv 1000000.1 9 0\n"
        "v 1000000.101 5 0\nf 4 5 6\n",
        {.vertices = vertices});
    EXPECT_EQ(flat.rests.empty(), vertices == Vertices::kAsPictures);
    // binary32 holds these positions relative to another origin, so no rests are stored.
    const Scene even = load(
        "v 5411987 0 0\nv 5411987 1 0\nv 5411987.25 0 0\nv 5411987.25 1 0\n"
        "v 0 0 0\nf 1 2 3\nf 1 2 4\nf 2 5 3\n",
        {.vertices = vertices});
    EXPECT_TRUE(even.rests.empty());
    EXPECT_EQ(even.origin + even.vertex(2), glm::dvec3(5411987.25, 0, 0));
  }
}

TEST(LoadObj, CrossingPolygonsAndZeroNormalsAreWarnedOf) {
  const Scene crossing = load("v 0 0 0\nv 3 3 0\nv 3 0 0\nv 0 2 0\nf 1 2 3 4\n");
  EXPECT_EQ(only_warning(crossing),
            "scene.obj:5: polygon crosses or touches itself, cut as well as can be");
  const Scene flat = load_square("vn 0 0 0\nvn 0 0 1\nf 1//2 2//2 3//1\nf 1//2 3//2 4//2\n");
  EXPECT_EQ(only_warning(flat),
            "scene.obj:7: normal without a direction, the face is taken as flat");
  EXPECT_EQ(flat.triangles[0].normals, (Indices{kNoIndex, kNoIndex, kNoIndex}));
  EXPECT_EQ(flat.triangles[1].normals, (Indices{1, 1, 1}));
}

TEST(LoadObj, NormalsOfAnyLength) {
  const Scene scene = load_square("vn 1e-38 0 0\nvn 0 3e38 3e38\nf 1//1 2//1 3//2\n");
  EXPECT_EQ(scene.normals[0], glm::vec3(1, 0, 0));
  EXPECT_FLOAT_EQ(scene.normals[1].y, 0.70710678f);
}

TEST(LoadObj, AVeryLongLine) {
  std::string text;
  const int corners = 100000;
  for (int i = 0; i < corners; ++i) {  // a flight of stairs; the last corner closes it from below
    text += "v " + std::to_string((i + 1) / 2) + " " + std::to_string(i / 2) + " 0\n";
  }
  text += "v " + std::to_string(corners) + " -1 0\nf";
  for (int i = corners + 1; i > 0; --i) text.append(" ").append(std::to_string(i));
  const Scene scene = load(text + " # " + std::string(1000000, 'x') + "\n");
  EXPECT_EQ(scene.triangles.size(), corners - 1u);
  EXPECT_TRUE(scene.warnings.empty());
}

}  // namespace
}  // namespace raygate
