// Damaged files: whatever comes out loads into a scene that holds together, or is an InputError.
#include <gtest/gtest.h>

#include "host/base/input_error.h"
#include "host/base/test/damage.h"
#include "host/base/test/temp_folder.h"
#include "host/scene/io/scene_loader.h"
#include "host/scene/io/test/sound.h"
#include "host/scene/test/tga.h"

namespace raygate {
namespace {

constexpr std::string_view kObj =
    "# a seed with one of everything\nmtllib m.mtl\no box\nv 0 0 0\nv 2.5 0 0\nv 2.5 2 0.125\n"
    "v 1 0.5 0\nv 0 2e0 -0.1\nvt 0 0\nvt 1 0.5\nvn 0 0 1\nvn 0.1 0.2 0.9\nusemtl red one\n"
    "f 1/1/1 2/2/2 3/1/1 4/2/2 5/1/1\ng a b\nf 1//1 2//2 3//1\nusemtl blue\nf -1 -2 -3\n"
    "f 1/1 2/2 \\\n3/1\ns 1\nf 1 2 3\nf 1 3 5\ns off\nl 1 2\nf 5 4 3 2 1\n";
constexpr std::string_view kMtl =
    "newmtl red one\nKd 0.8 0.1 0.1\nKs 0.5\nNs 10\nNi 1.5\nd 0.5\nTr 0.5\nillum 2\n"
    "newmtl blue\nKe 1 2 3\nTf 1 1 1\nmap_Kd -s 1 2 3 -clamp on a b.png\n"
    "Pr 0.5\nmap_Pm a b.png\nmap_d a b.png\nnorm -bm 0.5 a b.png\n";
constexpr const char* kObjSplinters[] = {
    "/",         "//",      "\\",    "\\\n",         "\n",   "\r",    "#",
    " ",         "\t",      "f ",    "v ",           "vn ",  "vt ",   "g ",
    "o ",        "usemtl ", "s ",    "mtllib ",      ".",    "--",    "mtllib .\n",
    "f 1 2 3\n", "newmtl ", "Kd ",   "map_Kd -s ",   "Pr ",  "norm ", "\xFF",
    "1/1/1",     "+",       "call ", "\xEF\xBB\xBF", "p 1\n"};

TEST(DamagedObj, LoadsSoundlyOrIsRefused) {
  const TempFolder folder;
  const std::uint64_t seed = 20240521;
  RecordProperty("seed", std::to_string(seed));
  test::Damage damage(seed, kObjSplinters);
  folder.write("a b.png", test::tga(1, 1, {{9, 9, 9}}));
  int loaded = 0, refused = 0;
  for (int round = 0; round < 20000; ++round) {
    std::string obj(kObj), mtl(kMtl);
    std::string& damaged = round % 4 == 0 ? mtl : obj;
    damaged = damage(damaged);
    folder.write("m.mtl", mtl);
    const std::filesystem::path file = folder.write("s.obj", obj);
    try {
      const Scene scene = load_obj(file);
      test::expect_sound(scene);
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
