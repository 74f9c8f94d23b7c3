// Reads tables of rays, and reports errors in invalid ones.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "host/base/test/temp_folder.h"
#include "host/trace/ray_table.h"

namespace raygate {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

class Table : public testing::Test {
 protected:
  RayTable read_all(const std::string& bytes, const glm::dvec3& origin = glm::dvec3(0.0)) {
    RayTableReader rays(folder_.write("rays", bytes), origin);
    RayTable all, block;
    rounded_ = 0;
    while (rays.read(3, block)) {
      EXPECT_EQ(block.first, all.rays.size());
      EXPECT_LE(block.rays.size(), 3u);
      rounded_ += block.rounded;
      all.rays.insert(all.rays.end(), block.rays.begin(), block.rays.end());
      all.limits.insert(all.limits.end(), block.limits.begin(), block.limits.end());
      all.exponents.insert(all.exponents.end(), block.exponents.begin(), block.exponents.end());
    }
    return all;
  }

  /// Returns the part of a table's error message that follows the file's name.
  std::string refusal(const std::string& bytes) {
    const std::string error = folder_.error_of([&] { read_all(bytes); });
    EXPECT_TRUE(error.starts_with("rays")) << error;
    return error.substr(4);
  }

  const TempFolder folder_;
  std::uint64_t rounded_ = 0;
};

TEST_F(Table, OfText) {
  const RayTable rays = read_all(
      "ox,oy,oz,dx,dy,dz,limit\n# a comment\n\n1,2,3,0,0,-1\r\n +4 , 5e0,6, 3,0,0, 2\n"
      "0,0,0,1,1,0.25,inf\n7,8,9,0,0,0\n0.5,0,0,0,-0.125,0,1e-3");
  ASSERT_EQ(rays.rays.size(), 5u);
  EXPECT_EQ(rays.rays[0].origin, glm::vec3(1.0f, 2.0f, 3.0f));
  EXPECT_EQ(rays.rays[0].direction, glm::vec3(0.0f, 0.0f, -1.0f));
  EXPECT_EQ(rays.limits[0], kInfinity);
  // 3 = 1.5 * 2, so t of the scaled ray is twice the t of the file's ray.
  EXPECT_EQ(rays.rays[1].direction, glm::vec3(1.5f, 0.0f, 0.0f));
  EXPECT_EQ(rays.exponents[1], -1);
  EXPECT_EQ(rays.limits[1], 4.0f);
  EXPECT_EQ(rays.rays[3].direction, glm::vec3(0.0f));
  EXPECT_EQ(rays.exponents[4], 3);
  EXPECT_EQ(rays.limits[4], std::ldexp(1e-3, -3));
  EXPECT_EQ(rounded_, 0u);
}

TEST_F(Table, OfTextWithoutAHeader) { EXPECT_EQ(read_all("1,2,3,4,5,6\n").rays.size(), 1u); }

TEST_F(Table, OfTextWithOtherSeparators) {
  for (const char* const row : {"278 273  800 0 0 -1\n", "278;273; 800;0;0;-1\n",
                                "\t278\t273\t800\t0\t0\t-1\r\n", "a b c d e f\n278 273 800 0 0 -1",
                                "\xEF\xBB\xBF"
                                "278,273,800,0,0,-1",
                                "\"278\",'273', \" 800\",\"0\",\"0\",\"-1\"\r\n"}) {
    const RayTable rays = read_all(row);
    ASSERT_EQ(rays.rays.size(), 1u) << row;
    EXPECT_EQ(rays.rays[0].origin, glm::vec3(278.0f, 273.0f, 800.0f));
    EXPECT_EQ(rays.rays[0].direction, glm::vec3(0.0f, 0.0f, -1.0f));
  }
  EXPECT_EQ(read_all("0 1 5 0 0 -1 2.5").limits.at(0), 2.5f);
}

TEST_F(Table, OfNoRays) {
  EXPECT_EQ(read_all("").rays.size(), 0u);
  EXPECT_EQ(read_all("ox,oy,oz,dx,dy,dz").rays.size(), 0u);
}

TEST_F(Table, SaysWhichLineIsWrong) {
  const std::string wanted = ", expected OX,OY,OZ,DX,DY,DZ or OX,OY,OZ,DX,DY,DZ,LIMIT";
  EXPECT_EQ(refusal("# a\ndx,dy,dz,ox,oy,oz\n1,2,3,4,5,6\n"),
            ":2: found 'dx' in column 1" + wanted);
  EXPECT_EQ(refusal("OX OY OZ DX DY DX\n"), ":1: found 'DX' in column 6" + wanted);
  EXPECT_EQ(read_all("x;y;z;dx;dy;dz\n1;2;3;4;5;6\n").rays.size(), 1u);
  EXPECT_EQ(refusal("1,2,3,4,5,6\n1,2,3,4,5\n"), ":2: found 5 numbers" + wanted);
  EXPECT_EQ(refusal("1,2,3,4,5,6\n1,2,3,4,5,6,7,8\n"), ":2: found 8 numbers" + wanted);
  EXPECT_EQ(refusal("\n\n1,2,x,4,5,6\n"), ":3: found 'x', expected a number");
  EXPECT_EQ(refusal("a,b\nc,d\n"), ":2: found 'c', expected a number");
  EXPECT_EQ(refusal("0,5;1,0;5,0;0,0;0,0;-1,0\n"), ":1: found '5;1', expected a number");
  EXPECT_EQ(refusal("1.f 2.f 3.f 4.f 5.f 6.f\n"), ":1: found '1.f', expected a number");
  EXPECT_EQ(refusal("\xFF\xFE"
                    "1"),
            ": found UTF-16 text, expected ASCII or UTF-8");
  EXPECT_EQ(refusal(",,,,,\n"), ":1: found '', expected a number");
  EXPECT_EQ(refusal("1 2 3 4 5\n"), ":1: found 5 numbers" + wanted);
  EXPECT_EQ(refusal("1,2,3,4,5,6,\n"), ":1: found '', expected a number");
  EXPECT_EQ(refusal("1,2,3,4,5,1e999\n"),
            ":1: found inf or nan in origin or direction, expected finite numbers");
  EXPECT_EQ(refusal("1,2,nan,4,5,6\n"),
            ":1: found inf or nan in origin or direction, expected finite numbers");
  EXPECT_EQ(refusal("1,2,3,4,5,6,0\n"),
            ":1: found a limit that is not above 0, expected one, or inf");
  EXPECT_EQ(refusal("1e39,2,3,4,5,6\n"),
            ":1: found an origin farther than 2^126 from the scene, expected a nearer one");
  EXPECT_EQ(refusal("1,2,3,4,5,6\n" + std::string(2000000, '7')),
            ":2: found a line of over 1,000,000 bytes" + wanted);
}

TEST(RayTable, CountsOriginsThatRecentringRounds) {
  RayTable table;
  for (const double x : {1.0, 0x1p60, 0.0}) table.add({x, 0, 0}, {1, 0, 0}, 1.0, {0x1p60, 0, 0});
  EXPECT_EQ(table.rounded, 1u);  // 1 - 2^60
}

TEST(RayTable, CountsEachRayOnce) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  RayTable table;
  table.add({1, 0, 0}, {1, 0, 0}, kInfinity, {});
  table.add({0.1, 0, 0}, {1, 0, 0}, kInfinity, {});          // rounded by round()
  table.add({0.1, 0, 0}, {1, 0, 0}, 0.1, {});                // limits are kept
  table.add({0, 0, 0}, {1e300, 1e-300, 0}, kInfinity, {});   // 1e-300 becomes 0
  table.add({0, 0, 0}, {1e-300, 1e-300, 0}, kInfinity, {});  // scaled exactly
  EXPECT_EQ(table.rounded, 1u);
  table.round();
  EXPECT_EQ(table.rounded, 4u);
  EXPECT_TRUE(table.exact_rays.empty());
  table.clear(0);
  table.round();
  EXPECT_EQ(table.rounded, 0u);
}

TEST_F(Table, IsSeenFromTheScenesOrigin) {
  const RayTable rays = read_all("1000000.25,0,0,1,0,0\n", glm::dvec3(1e6, 1.0, 0.0));
  EXPECT_EQ(rays.rays.at(0).origin, glm::vec3(0.25f, -1.0f, 0.0f));
  EXPECT_EQ(rounded_, 0u);
}

TEST_F(Table, ScalesWhatRoundsUpToTheNextPowerOfTwo) {
  const RayTable rays = read_all("0,0,0,1.9999999999,0,0,1\n0,0,0,0,5e-324,0\n0,0,0,0,0,1e308\n");
  EXPECT_EQ(rays.rays.at(0).direction.x, 1.0f);
  EXPECT_EQ(rays.exponents[0], -1);
  EXPECT_EQ(rays.limits[0], 2.0f);
  EXPECT_EQ(rays.rays[1].direction.y, 1.0f);
  EXPECT_EQ(rays.exponents[1], 1074);
  EXPECT_EQ(std::ldexp(rays.rays[2].direction.z, -rays.exponents[2] - 1000),
            std::ldexp(static_cast<float>(0x1p-1000 * 1e308), 0));
}

}  // namespace
}  // namespace raygate
