#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "host/base/test/temp_folder.h"
#include "host/scene/io/scene_loader.h"
#include "host/scene/io/test/binary.h"

namespace raygate {
namespace {

using test::bytes_of;

constexpr std::string_view kAscii =
    "ply\nformat ascii 1.0\ncomment a square\nelement vertex 4\nproperty float x\n"
    "property float y\nproperty float z\nproperty uchar red\nelement face 1\n"
    "property list uchar int vertex_indices\nend_header\n"
    "0 0 0 9\n1 0 0 9\n1 1 0 9\n0 1 0 9\n4 0 1 2 3\n";

class LoadPly : public testing::Test {
 protected:
  [[nodiscard]] Scene load(std::string_view text) const {
    return load_ply(folder_.write("s.ply", text));
  }
  [[nodiscard]] std::string error(std::string_view text) const {
    return folder_.error_of([&] { (void)load(text); });
  }
  [[nodiscard]] static std::string with(std::string_view part, std::string_view instead) {
    std::string text(kAscii);
    return text.replace(text.find(part), part.size(), instead);
  }

  const TempFolder folder_;
};

void expect_square(const Scene& scene) {
  ASSERT_EQ(scene.triangles.size(), 2u);
  ASSERT_EQ(scene.positions.size(), 4u);
  EXPECT_EQ(scene.origin + glm::dvec3(scene.positions[2]), glm::dvec3(1, 1, 0));
  EXPECT_EQ(scene.triangles[1].vertices, (std::array<std::uint32_t, 3>{0, 2, 3}));
  EXPECT_EQ(scene.materials.size(), 1u);
  EXPECT_EQ(scene.objects.size(), 1u);
}

TEST_F(LoadPly, Ascii) {
  const Scene scene = load(kAscii);
  expect_square(scene);
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_TRUE(scene.warnings[0].ends_with("s.ply: not read: 'red' of vertex"));
  EXPECT_TRUE(scene.colors.empty()) << "red alone is no colour";
}

TEST_F(LoadPly, BinaryOfBothOrders) {
  for (const bool is_big : {false, true}) {
    const auto ordered = [&](std::string number) {
      if (is_big) std::ranges::reverse(number);
      return number;
    };
    std::string text =
        std::string("ply\r\nformat binary_") + (is_big ? "big" : "little") +
        "_endian 1.0\r\nelement vertex 4\r\nproperty double x\r\nproperty short y\r\n"
        "property list uchar ushort what\r\nproperty float32 z\r\nelement other 2\r\n"
        "property int8 a\r\nelement face 1\r\nproperty uchar flags\r\n"
        "property list uint32 uchar vertex_index\r\nend_header\r\n";
    for (const auto& [x, y] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
      text += ordered(bytes_of(double(x))) + ordered(bytes_of(std::int16_t(y))) + "\2abcd" +
              ordered(bytes_of(0.0f));
    }
    text += "xx\7" + ordered(bytes_of(std::uint32_t{4})) + std::string("\0\1\2\3", 4);
    expect_square(load(text));
    text.pop_back();
    EXPECT_EQ(error(text), "s.ply: the file ends too soon");
  }
}

TEST_F(LoadPly, NormalsAndFarPositions) {
  const Scene scene = load(
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\n"
      "property double z\nproperty float nx\nproperty float ny\nproperty float nz\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
      "100000000.25 0 0 0 0 2\n100000001.25 0 0 0 0 2\n100000000.25 1 0 0 0 2\n3 0 1 2\n");
  EXPECT_EQ(scene.normals[scene.triangles[0].normals[1]], glm::vec3(0, 0, 1));
  EXPECT_EQ(scene.origin + glm::dvec3(scene.positions[1]), glm::dvec3(100000001.25, 0, 0));
}

TEST_F(LoadPly, WhatExportersWrite) {
  const Scene scene = load(
      "ply\nformat ascii 1.0\nCreated by an exporter\nelement vertex 3\nproperty float x\n"
      "property float y\nproperty float z\nproperty float nx\nproperty float ny\n"
      "property float nz\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 0 nan nan nan\n1 0 0 0 0 1\n0 1 0 0 0 1\n3 0 1 2\n");
  EXPECT_EQ(scene.triangles[0].normals[1], kNoIndex) << "flat, with a warning";
  ASSERT_EQ(scene.warnings.size(), 2u);
  EXPECT_TRUE(
      scene.warnings[0].ends_with("s.ply:3: 'Created' is no word of a PLY header, ignored"));
}

TEST_F(LoadPly, WhatIsRefused) {
  EXPECT_EQ(error("plx\n"), "s.ply:1: not a PLY file: its first line is not \"ply\"");
  EXPECT_EQ(error("ply\nformat ascii 1.0\n"), "s.ply:3: the header has no end_header");
  const std::array<const char*, 3> changes[] = {
      {"ascii", "utf8",
       ":2: format: found 'utf8', expected ascii, binary_little_endian or binary_big_endian"},
      {"uchar red", "colour red",
       ":8: property: found 'colour', expected a type as int, uchar or float"},
      {"vertex 4", "vertex -4", ":4: element: expected its name and how many there are"},
      {"float z", "float w", ":12: vertices without x, y and z"},
      {"1 0 0 9", "1 x 0 9",
       ":13: a vertex: found 1 nan 0, expected numbers within the range of float"},
      {"1 0 0 9", "1 1e99 0 9",
       ":13: a vertex: found 1 1e+99 0, expected numbers within the range of float"},
      {"1 2 3\n", "1 2 7\n", ":16: vertex index 8 in a face, but the file has 4"},
      {"4 0 1 2 3\n", "4 0 1 2\n", ":17: the file ends too soon"},
      {"4 0 1 2 3\n", "1e30 0 1 2 3\n",
       ":16: a list's length: expected a whole number from 0 to 4294967295"},
      {"face 1\n", "face 0\n", ": no faces, expected at least one polygon"}};
  for (const auto& [from, to, expected] : changes) {
    EXPECT_EQ(error(with(from, to)), std::string("s.ply") + expected);
  }
  EXPECT_EQ(error(with("vertex 4", "vertex 900000000000")).substr(0, 10), "s.ply:17: ");
}

}  // namespace
}  // namespace raygate
