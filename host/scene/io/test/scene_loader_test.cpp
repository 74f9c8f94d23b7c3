// Which file is read as what; and damaged files of all binary kinds: a sound scene, or one clear
// line.
#include "host/scene/io/scene_loader.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include "host/base/input_error.h"
#include "host/base/test/damage.h"
#include "host/base/test/temp_folder.h"
#include "host/scene/instances.h"
#include "host/scene/io/test/binary.h"
#include "host/scene/io/test/sound.h"
#include "host/scene/test/tga.h"

namespace raygate {
namespace {

constexpr std::string_view kTriangleFile = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

TEST(LoadScene, GoesByTheEndingOfTheName) {
  const TempFolder folder;
  EXPECT_EQ(load_scene(folder.write("a.OBJ", kTriangleFile)).triangles.size(), 1u);
  EXPECT_EQ(load_scene(folder.write("a", kTriangleFile)).triangles.size(), 1u);
  EXPECT_THROW((void)load_scene(folder.write("a.stl", kTriangleFile)), InputError);
  const std::filesystem::path file = folder.write("a.fbx", kTriangleFile);
  EXPECT_TRUE(folder.error_of([&] { (void)load_scene(file); })
                  .starts_with("a.fbx: found a .fbx file, expected .obj, .glb, .gltf, .ply or "
                               ".stl; Blender writes them by File > Export"));
}

TEST(LoadScene, AStemMeansTheFileThatIsThere) {
  const TempFolder folder;
  EXPECT_EQ(find_scene_file(folder.path() / "a"), folder.path() / "a.obj");
  (void)folder.write("a.stl", "");
  EXPECT_EQ(find_scene_file(folder.path() / "a"), folder.path() / "a.stl");
  (void)folder.write("a.glb", "");
  EXPECT_EQ(find_scene_file(folder.path() / "a"), folder.path() / "a.glb");
}

constexpr std::string_view kPlyFile =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float "
    "z\n"
    "element face 2\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n3 0 1 2\n";
constexpr std::string_view kStl =
    "solid a\nfacet normal 0 0 1 outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 1 0 endloop "
    "endfacet\nendsolid a\n";

std::string binary_ply() {
  std::string text =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
  text += test::bytes_of(0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f);
  return text + "\3" + test::bytes_of(0, 1, 2);
}

std::string binary_stl_file() {
  return std::string(80, ' ') + test::bytes_of(1) +
         test::bytes_of(0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f,
                        std::uint16_t{0});
}

/// A file of JSON beside square.bin and dot.tga.
std::string whole_gltf() {
  std::string json = test::square_json(
      R"([{"mesh": 0, "children": [1, 2], "rotation": [0, 0, 0, 1], "scale": [1, 1, 1]},
          {"camera": 0, "mesh": 0},
          {"extensions": {"KHR_lights_punctual": {"light": 0}}, "translation": [1, 2, 3]}])",
      R"(, "cameras": [{"type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.1}}],
         "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": 9}]}},
         "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 1],
           "roughnessFactor": 0.5, "baseColorTexture": {"index": 0}}, "emissiveFactor": [1, 0, 0]}],
         "textures": [{"source": 0}], "images": [{"uri": "dot.tga"}])",
      R"(, "material": 0)");
  constexpr std::string_view kBuffer = "\"buffers\": [{";
  return json.insert(json.find(kBuffer) + kBuffer.size(), "\"uri\": \"square.bin\", ");
}

constexpr const char* kSplinters[] = {"\"", "[", "]", "{}", "null", "\n", " ", ",", "2147483647"};

struct Kind {
  const char* name;
  std::string bytes;
};

class DamagedFile : public testing::TestWithParam<Kind> {};

TEST_P(DamagedFile, LoadsSoundlyOrIsRefused) {
  const TempFolder folder;
  const std::uint64_t seed = 20240902;
  RecordProperty("seed", std::to_string(seed));
  test::Damage damage(seed, kSplinters);
  (void)folder.write("square.bin", test::square_buffer());
  (void)folder.write("dot.tga", test::tga(1, 1, {{9, 9, 9}}));
  int loaded = 0, refused = 0;
  for (int round = 0; round < 600; ++round) {
    const std::string bytes = damage(GetParam().bytes);
    const std::filesystem::path file = folder.write(GetParam().name, bytes);
    try {
      Scene scene = load_scene(file);
      resolve_instances(scene, InstanceMode::kFlatten, file);
      test::expect_sound(scene);
      if (testing::Test::HasFatalFailure()) FAIL() << "round " << round << "\n" << bytes;
      ++loaded;
    } catch (const InputError& error) {
      ++refused;
      const std::string what = error.what();
      ASSERT_TRUE(what.starts_with(file.string() + ":")) << what << "\nround " << round;
      ASSERT_EQ(what.find('\n'), std::string::npos) << what;
    }
  }
  EXPECT_GT(loaded, 20);
  EXPECT_GT(refused, 20);
  rusage use{};
  ::getrusage(RUSAGE_SELF, &use);
  EXPECT_LT(use.ru_maxrss, 2l << 20) << "KB";
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, DamagedFile,
    testing::Values(Kind{"a.ply", std::string(kPlyFile)}, Kind{"b.ply", binary_ply()},
                    Kind{"a.stl", std::string(kStl)}, Kind{"b.stl", binary_stl_file()},
                    Kind{"a.gltf", whole_gltf()},
                    Kind{"b.glb",
                         test::glb(test::square_json(R"([{"mesh": 0}])"), test::square_buffer())}),
    [](const auto& info) {
      std::string name = info.param.name;
      name[1] = '_';
      return name;
    });

}  // namespace
}  // namespace raygate
