// Damaged files: whatever comes out loads into a scene that holds together, or is an InputError.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "host/exact/exact_sign.h"
#include "host/scene/io/input_error.h"
#include "host/scene/io/obj_loader.h"
#include "host/scene/io/test/in_parts.h"
#include "host/scene/test/temp_folder.h"
#include "host/scene/test/tga.h"

namespace raygate {
namespace {

constexpr std::string_view kObj =
    "# a seed with one of everything\nmtllib m.mtl\no box\nv 0 0 0\nv 2.5 0 0\nv 2.5 2 0.125\n"
    "v 1 0.5 0\nv 0 2e0 -0.1\nvt 0 0\nvt 1 0.5\nvn 0 0 1\nvn 0.1 0.2 0.9\nusemtl red one\n"
    "f 1/1/1 2/2/2 3/1/1 4/2/2 5/1/1\ng a b\nf 1//1 2//2 3//1\nusemtl blue\nf -1 -2 -3\n"
    "f 1/1 2/2 \\\n3/1\ns off\nl 1 2\nf 5 4 3 2 1\n";
constexpr std::string_view kMtl =
    "newmtl red one\nKd 0.8 0.1 0.1\nKs 0.5\nNs 10\nNi 1.5\nd 0.5\nTr 0.5\nillum 2\n"
    "newmtl blue\nKe 1 2 3\nTf 1 1 1\nmap_Kd -s 1 2 3 -clamp on a b.png\n";
constexpr const char* kSplinters[] = {"nan",
                                      "-inf",
                                      "1e999",
                                      "1e-999",
                                      "0",
                                      "-1",
                                      "4294967297",
                                      "-2147483648",
                                      "99999999999999",
                                      "/",
                                      "//",
                                      "\\",
                                      "\\\n",
                                      "\n",
                                      "\r",
                                      "#",
                                      " ",
                                      "\t",
                                      "f ",
                                      "v ",
                                      "vn ",
                                      "vt ",
                                      "g ",
                                      "o ",
                                      "usemtl ",
                                      "mtllib ",
                                      "mtllib .\n",
                                      "f 1 2 3\n",
                                      "newmtl ",
                                      "Kd ",
                                      "map_Kd -s ",
                                      "\xEF\xBB\xBF",
                                      "\xFF",
                                      ".",
                                      "1/1/1",
                                      "1.5e",
                                      "--",
                                      "+",
                                      "call ",
                                      "p 1\n"};

class Mutator {
 public:
  explicit Mutator(std::uint64_t seed) : random_(seed) {}

  std::string mutate(std::string text) {
    for (int times = 1 + below(4); times > 0 && !text.empty(); --times) {
      const std::size_t at = below(text.size());
      switch (below(7)) {
        case 0:
          text[at] = static_cast<char>(below(256));
          break;
        case 1:
          text[at] = static_cast<char>(text[at] ^ (1 << below(8)));
          break;
        case 2:
          text.insert(at, kSplinters[below(std::size(kSplinters))]);
          break;
        case 3:
          text.erase(at, 1 + below(8));
          break;
        case 4:
          text.resize(at);
          break;
        case 5:
          replace_number(text, at);
          break;
        case 6:
          repeat_line(text, at);
          break;
      }
    }
    return text;
  }
  std::size_t below(std::size_t limit) { return random_() % limit; }

 private:
  void replace_number(std::string& text, std::size_t at) {
    const std::size_t begin = text.find_first_of("0123456789-", at);
    if (begin == std::string::npos) return;
    const std::size_t end = text.find_first_not_of("0123456789-.e", begin);
    text.replace(begin, std::min(end, text.size()) - begin, kSplinters[below(10)]);
  }
  void repeat_line(std::string& text, std::size_t at) {
    const std::size_t begin = text.rfind('\n', at) + 1;  // npos + 1 is 0
    const std::size_t end = text.find('\n', at);
    text.insert(begin, text.substr(begin, end - begin) + "\n");
  }

  std::mt19937_64 random_;
};

void expect_sound(const Scene& scene) {
  ASSERT_FALSE(scene.triangles.empty());
  for (const glm::vec3& p : scene.positions) {
    ASSERT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
  }
  for (const Triangle& triangle : scene.triangles) {
    for (int i = 0; i < 3; ++i) {
      ASSERT_LT(triangle.vertices[i], scene.positions.size());
      if (triangle.normals[i] != kNoIndex) {
        ASSERT_LT(triangle.normals[i], scene.normals.size());
        ASSERT_NEAR(glm::length(scene.normals[triangle.normals[i]]), 1.0f, 1e-6f);
      }
      if (triangle.texcoords[i] != kNoIndex) {
        ASSERT_LT(triangle.texcoords[i], scene.texcoords.size());
      }
    }
    ASSERT_FALSE(collinear(scene.positions[triangle.vertices[0]],
                           scene.positions[triangle.vertices[1]],
                           scene.positions[triangle.vertices[2]]));
    ASSERT_LT(triangle.material, scene.materials.size());
    ASSERT_LT(triangle.object, scene.objects.size());
  }
}

TEST(DamagedObj, LoadsSoundlyOrIsRefused) {
  const TempFolder folder;
  const std::uint64_t seed = 20240521;
  RecordProperty("seed", std::to_string(seed));
  Mutator mutator(seed);
  folder.write("a b.png", test::tga(1, 1, {{9, 9, 9}}));
  int loaded = 0, refused = 0;
  for (int round = 0; round < 20000; ++round) {
    std::string obj(kObj), mtl(kMtl);
    std::string& damaged = round % 4 == 0 ? mtl : obj;
    damaged = mutator.mutate(damaged);
    folder.write("m.mtl", mtl);
    const std::filesystem::path file = folder.write("s.obj", obj);
    const LoadOptions options = {.strict = mutator.below(2) == 0};
    if (round % 8 == 1) {
      ASSERT_EQ(test::outcome(file, options), test::outcome_in_parts(file, options)) << obj;
    }
    try {
      const Scene scene = load_obj(file, options);
      expect_sound(scene);
      if (testing::Test::HasFatalFailure()) FAIL() << "round " << round << "\n" << obj;
      ++loaded;
    } catch (const InputError& error) {
      ++refused;
      ASSERT_NE(std::string(error.what()).find(folder.path().string()), std::string::npos)
          << error.what() << "\nround " << round;
    }
  }
  EXPECT_GT(loaded, 2000);
  EXPECT_GT(refused, 2000);
}

}  // namespace
}  // namespace raygate
