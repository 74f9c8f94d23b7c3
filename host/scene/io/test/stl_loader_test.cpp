#include <gtest/gtest.h>

#include <cmath>

#include "host/base/test/temp_folder.h"
#include "host/scene/io/scene_loader.h"
#include "host/scene/io/test/binary.h"

namespace raygate {
namespace {

using test::bytes_of;

constexpr std::string_view kAsciiStl =
    "solid a name of words\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n"
    "   vertex 0 1e0 0\n  endloop\n endfacet\n"
    "facet normal nan nan nan outer loop vertex 0 0 0 vertex 0 1 0 vertex 0 0 1 endloop endfacet\n"
    "endsolid a name of words\n";

class LoadStl : public testing::Test {
 protected:
  [[nodiscard]] Scene load(std::string_view text) const {
    return load_stl(folder_.write("s.stl", text));
  }
  [[nodiscard]] std::string error(std::string_view text) const {
    return folder_.error_of([&] { (void)load(text); });
  }

  const TempFolder folder_;
};

TEST_F(LoadStl, Ascii) {
  const Scene scene = load(kAsciiStl);
  ASSERT_EQ(scene.triangles.size(), 2u);
  EXPECT_EQ(scene.origin + glm::dvec3(scene.positions[scene.triangles[1].vertices[2]]),
            glm::dvec3(0, 0, 1));
  EXPECT_EQ(scene.up, glm::dvec3(0, 0, 1));
  EXPECT_EQ(scene.triangles[0].normals[0], kNoIndex);
}

TEST_F(LoadStl, WhatIsRefused) {
  EXPECT_EQ(error("Dear reader"), "s.stl:1: found 'Dear', expected 'solid'");
  EXPECT_EQ(
      error(std::string(80, ' ') + bytes_of(1u, 9.0f, 9.0f, 9.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f,
                                            0.0f, 0.0f, INFINITY, 0.0f, std::uint16_t{7})),
      "s.stl: facet 1 has a coordinate that is not a finite number");
  EXPECT_EQ(error("solid\nendsolid\n"), "s.stl: no faces, expected at least one polygon");
  EXPECT_EQ(error("solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 x\n"),
            "s.stl:4: a coordinate: found 'x', expected a number within the range of float");
  EXPECT_EQ(error("solid\nfacet normal 0 0 1\nouter ring\n"),
            "s.stl:3: found 'ring', expected 'loop'");
  EXPECT_EQ(error("solid\nfacet normal 0 0 1"),
            "s.stl:2: the file ends too soon, expected 'outer'");
}

}  // namespace
}  // namespace raygate
