// Every bad file is refused, with its line and what is wrong.
#include <gtest/gtest.h>

#include "host/base/input_error.h"
#include "host/base/test/temp_folder.h"
#include "host/scene/io/scene_loader.h"

namespace raygate {
namespace {

constexpr std::string_view kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

// The error's message after "FILE:", which must be there.
std::string error_of(std::string_view text) {
  const TempFolder folder;
  const std::filesystem::path file = folder.write("bad.obj", text);
  try {
    (void)load_obj(file);
  } catch (const InputError& error) {
    const std::string what = error.what();
    EXPECT_TRUE(what.starts_with(file.string() + ":")) << what;
    return what.substr(file.string().size() + 1);
  }
  return "no error";
}

struct BadFile {
  const char* name;
  std::string text;
  std::string error;
};

std::string after_triangle(std::string_view more) {
  return std::string(kTriangle) + std::string(more);
}

class BadObj : public testing::TestWithParam<BadFile> {};

TEST_P(BadObj, IsRefused) { EXPECT_EQ(error_of(GetParam().text), GetParam().error); }

INSTANTIATE_TEST_SUITE_P(
    , BadObj,
    testing::Values(
        BadFile{"Prose", "Once upon a time\n", " no faces, expected at least one polygon"},
        BadFile{"OnlyComments", "# nothing\n\n", " no faces, expected at least one polygon"},
        BadFile{"NoFaces", std::string(kTriangle), " no faces, expected at least one polygon"},
        BadFile{"NotANumber", "v 0 zero 0\n",
                "1: v: found 'zero', expected a number within the range of float"},
        BadFile{"DecimalComma", "v 0,5 1 2\n",
                "1: v: found '0,5', expected a number within the range of float"},
        BadFile{"Hexadecimal", "v 0x10 1 2\n",
                "1: v: found '0x10', expected a number within the range of float"},
        BadFile{"NotANumberValue", "\nv 0 nan 0\n",
                "2: v: found 'nan', expected a number within the range of float"},
        BadFile{"Infinity", "v inf 0 0\n",
                "1: v: found 'inf', expected a number within the range of float"},
        BadFile{"DoubleOverflow", "v 1e999 0 0\n",
                "1: v: found '1e999', expected a number within the range of float"},
        BadFile{"FloatOverflow", "v 0 0 4e38\n",
                "1: v: found '4e38', expected a number within the range of float"},
        BadFile{"TwoCoordinates", "v 1 2\n",
                "1: v with 2 numbers, expected x y z (and a weight or a colour)"},
        BadFile{"FiveCoordinates", "v 1 2 3 4 5\n",
                "1: v with 5 numbers, expected x y z (and a weight or a colour)"},
        BadFile{"EightCoordinates", "v 1 2 3 4 5 6 7 8\n", "1: too many numbers after 'v'"},
        BadFile{"ShortNormal", "vn 1 2\n", "1: vn with 2 numbers, expected x y z"},
        BadFile{"NoTexcoord", "vt\n", "1: vt with 0 numbers, expected u v"},
        BadFile{"IndexZero", after_triangle("f 0 1 2\n"),
                "4: face corner '0': index 0, expected 1 for the first or -1 for the last so far"},
        BadFile{"OutOfRange", after_triangle("f 1 2 4\n"),
                "4: vertex index 4 in a face, but the file has 3"},
        BadFile{"NegativeOutOfRange", after_triangle("f -1 -2 -4\n"),
                "4: face corner '-4', but the file has 3 vertices so far"},
        BadFile{"NegativeBeforeItsVertex", "v 0 0 0\nv 1 0 0\nf -1 -2 -3\nv 0 1 0\n",
                "3: face corner '-3', but the file has 2 vertices so far"},
        BadFile{"HugeIndex", after_triangle("f 1 2 2147483647\n"),
                "4: vertex index 2147483647 in a face, but the file has 3"},
        BadFile{"OverflowingIndex", after_triangle("f 1 2 4294967297\n"),
                "4: face corner '4294967297': an index beyond 2147483647"},
        BadFile{"HugeNegativeIndex", after_triangle("f 1 2 -2147483647\n"),
                "4: face corner '-2147483647', but the file has 3 vertices so far"},
        BadFile{"LeastIndex", after_triangle("f 1 2 -2147483648\n"),
                "4: face corner '-2147483648', but the file has 3 vertices so far"},
        BadFile{"FractionIndex", after_triangle("f 1 2 3.0\n"),
                "4: face corner '3.0', expected v, v/vt, v//vn or v/vt/vn"},
        BadFile{"WordIndex", after_triangle("f a b c\n"),
                "4: face corner 'a', expected v, v/vt, v//vn or v/vt/vn"},
        BadFile{"FourIndices", after_triangle("f 1/1/1/1 2 3\n"),
                "4: face corner '1/1/1/1', expected v, v/vt, v//vn or v/vt/vn"},
        BadFile{"NoVertexIndex", after_triangle("f //1 //1 //1\n"),
                "4: face corner '//1', expected v, v/vt, v//vn or v/vt/vn"},
        BadFile{"NoCorners", after_triangle("f\n"), "4: no face has an area"},
        BadFile{"CommentedCorner", after_triangle("f 1 2 # 3\n"), "4: no face has an area"},
        BadFile{"RepeatedCorner", after_triangle("f 1 2 2\n"), "4: no face has an area"},
        BadFile{"Collinear", "v 0 0 0\nv 1 1 1\nv 3 3 3\nv 7 7 7\nf 1 2 \\\n 3 4\n",
                "5: no face has an area"},
        // Distinct as doubles, one point as floats.
        BadFile{"CollapsesInFloat", "v 0 0 0\nv 1 0 0\nv 1 1e-60 0\nf 1 2 3\n",
                "4: no face has an area"},
        BadFile{"FarApart", "v 3e38 0 0\nv -3e38 0 0\nv 0 1 0\nv 1 1 0\nf 3 4 3\nf 1 2 3\n",
                "6: found a corner farther than 2^126 from the scene's middle, expected a nearer "
                "one"},
        BadFile{"AfterContinuation", after_triangle("f 1 \\\n2 \\\n3\nf 1 2 9\n"),
                "7: vertex index 9 in a face, but the file has 3"},
        BadFile{"AfterCrLf", "v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\n\r\nf 1 2 9\r\n",
                "5: vertex index 9 in a face, but the file has 3"}),
    [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace raygate
