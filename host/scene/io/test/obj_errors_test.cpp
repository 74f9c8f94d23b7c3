// Every bad file is refused, with its line and what is wrong there.
#include <gtest/gtest.h>

#include "host/base/test/temp_folder.h"
#include "host/scene/io/scene_loader.h"

namespace raygate {
namespace {

/// Returns the error's message after "FILE:", which must be there.
std::string error_of(std::string_view text) {
  const TempFolder folder;
  const std::string error = folder.error_of([&] { (void)load_obj(folder.write("f.obj", text)); });
  EXPECT_TRUE(error.starts_with("f.obj:")) << error;
  return error.substr(6);
}

TEST(BadObj, IsRefused) {
  const std::pair<const char*, const char*> bad_files[] = {
      {"Once upon a time\n", " no faces, expected at least one polygon"},
      {"# nothing\n\n", " no faces, expected at least one polygon"},
      {"v 0 0 0\nv 1 0 0\nv 0 1 0\n", " no faces, expected at least one polygon"},
      {"v 1 2\n", "1: v with 2 numbers, expected x y z (and a weight or a colour)"},
      {"v 1 2 3 4 5\n", "1: v with 5 numbers, expected x y z (and a weight or a colour)"},
      {"v 1 2 3 4 5 6 7 8\n", "1: too many numbers after 'v'"},
      {"vn 1 2\n", "1: vn with 2 numbers, expected x y z"},
      {"vt\n", "1: vt with 0 numbers, expected u v"},
      {"v 0 0 0\nv 1 0 0\nf -1 -2 -3\nv 0 1 0\n",
       "3: face corner '-3', but the file has 2 vertices so far"},
      {"v 0 0 0\nv 1 1 1\nv 3 3 3\nv 7 7 7\nf 1 2 \\\n 3 4\n", "5: no face has an area"},
      // Two of these points differ as doubles but not as floats.
      {"v 0 0 0\nv 1 0 0\nv 1 1e-60 0\nf 1 2 3\n", "4: no face has an area"},
      {"v 3e38 0 0\nv -3e38 0 0\nv 0 1 0\nv 1 1 0\nf 3 4 3\nf 1 2 3\n",
       "6: found a corner farther than 2^126 from the scene's middle, expected a nearer one"},
      {"v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\n\r\nf 1 2 9\r\n",
       "5: vertex index 9 in a face, but the file has 3"}};
  for (const auto& [text, error] : bad_files) EXPECT_EQ(error_of(text), error) << text;
}

TEST(BadObj, NumbersThatAreNone) {
  for (const char* word : {"zero", "0,5", "0x10", "nan", "inf", "1e999", "4e38"}) {
    EXPECT_EQ(
        error_of(std::string("\nv ") + word + " 1 2\n"),
        std::string("2: v: found '") + word + "', expected a number within the range of float");
  }
}

TEST(BadObj, FacesOfThreeVertices) {
  constexpr const char* kKinds = "', expected v, v/vt, v//vn or v/vt/vn";
  const std::pair<const char*, std::string> bad_faces[] = {
      {"f 0 1 2",
       "4: face corner '0': index 0, expected 1 for the first or -1 for the last so far"},
      {"f 1 2 4", "4: vertex index 4 in a face, but the file has 3"},
      {"f 1 2 2147483647", "4: vertex index 2147483647 in a face, but the file has 3"},
      {"f -1 -2 -4", "4: face corner '-4', but the file has 3 vertices so far"},
      {"f 1 2 4294967297", "4: face corner '4294967297': an index beyond 2147483647"},
      {"f 1 2 -2147483647", "4: face corner '-2147483647', but the file has 3 vertices so far"},
      {"f 1 2 -2147483648", "4: face corner '-2147483648', but the file has 3 vertices so far"},
      {"f 1 2 3.0", std::string("4: face corner '3.0") + kKinds},
      {"f a b c", std::string("4: face corner 'a") + kKinds},
      {"f 1/1/1/1 2 3", std::string("4: face corner '1/1/1/1") + kKinds},
      {"f //1 //1 //1", std::string("4: face corner '//1") + kKinds},
      {"f", "4: no face has an area"},
      {"f 1 2 # 3", "4: no face has an area"},
      {"f 1 2 2", "4: no face has an area"},
      {"f 1 \\\n2 \\\n3\nf 1 2 9", "7: vertex index 9 in a face, but the file has 3"}};
  for (const auto& [face, error] : bad_faces) {
    EXPECT_EQ(error_of("v 0 0 0\nv 1 0 0\nv 0 1 0\n" + std::string(face) + "\n"), error) << face;
  }
}

}  // namespace
}  // namespace raygate
