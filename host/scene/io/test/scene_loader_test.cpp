// Formats by file ending. Damaged files of all formats give a valid scene or a one-line error.
#include "host/scene/io/scene_loader.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cmath>
#include <span>

#include "host/base/input_error.h"
#include "host/base/test/damage.h"
#include "host/base/test/temp_folder.h"
#include "host/exact/exact.h"
#include "host/scene/instances.h"
#include "host/scene/io/test/binary.h"
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

/// Returns the JSON of a glTF file that refers to square.bin and dot.tga.
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

constexpr const char* kSplinters[] = {"\"", "[", "]", "{}", "null", "\n", " ", ",", "2147483647"};

struct Kind {
  std::string name;  ///< if "m.mtl", s.obj is loaded, which uses it
  std::string bytes;
  int rounds = 600;
  int least = 20;  ///< minimum of rounds that load, and of rounds refused
  std::span<const char* const> splinters = kSplinters;
};

/// Expects finite positions, indices in range, unit normals, and triangles that have an area.
void expect_sound(const Scene& scene) {
  ASSERT_FALSE(scene.triangles.empty());
  for (const glm::vec3& p : scene.positions) {
    ASSERT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
  }
  for (const Triangle& triangle : scene.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      ASSERT_LT(triangle.vertices[k], scene.positions.size());
      if (triangle.normals[k] != kNoIndex) {
        ASSERT_LT(triangle.normals[k], scene.normals.size());
        ASSERT_NEAR(glm::length(scene.normals[triangle.normals[k]]), 1.0f, 1e-6f);
      }
      if (triangle.texcoords[k] != kNoIndex) {
        ASSERT_LT(triangle.texcoords[k], scene.texcoords.size());
      }
    }
    const auto& [a, b, c] = triangle.vertices;
    const FloatCorners corners{scene.positions[a], scene.positions[b], scene.positions[c]};
    ASSERT_TRUE(is_left_out(triangle) || triangle_normal(widened(corners)) != glm::dvec3(0.0));
    ASSERT_LT(triangle.material, scene.materials.size());
    ASSERT_LT(triangle.object, scene.objects.size());
  }
}

class DamagedFile : public testing::TestWithParam<Kind> {};

TEST_P(DamagedFile, LoadsSoundlyOrIsRefused) {
  const TempFolder folder;
  const std::uint64_t seed = 20240902;
  RecordProperty("seed", std::to_string(seed));
  const Kind& kind = GetParam();
  test::Damage damage(seed, kind.splinters);
  (void)folder.write("square.bin", test::square_buffer());
  for (const char* name : {"dot.tga", "a b.png"}) {
    (void)folder.write(name, test::tga(1, 1, {{9, 9, 9}}));
  }
  (void)folder.write("m.mtl", kMtl);
  const std::filesystem::path obj = folder.write("s.obj", kObj);
  int loaded = 0, refused = 0;
  for (int round = 0; round < kind.rounds; ++round) {
    const std::string bytes = damage(kind.bytes);
    const std::filesystem::path file = folder.write(kind.name, bytes);
    try {
      Scene scene = load_scene(kind.name == "m.mtl" ? obj : file);
      resolve_instances(scene, InstanceMode::kFlatten, file);
      expect_sound(scene);
      if (testing::Test::HasFatalFailure()) FAIL() << "round " << round << "\n" << bytes;
      ++loaded;
    } catch (const InputError& error) {
      ++refused;
      const std::string what = error.what();
      ASSERT_TRUE(what.starts_with(file.string() + ":")) << what << "\nround " << round;
      ASSERT_EQ(what.find('\n'), std::string::npos) << what;
    }
  }
  EXPECT_GT(loaded, kind.least);
  EXPECT_GT(refused, kind.least);
  rusage use{};
  ::getrusage(RUSAGE_SELF, &use);
  EXPECT_LT(use.ru_maxrss, 2l << 20) << "KB";
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, DamagedFile,
    testing::Values(Kind{"s.obj", std::string(kObj), 15000, 1500, kObjSplinters},
                    Kind{"m.mtl", std::string(kMtl), 5000, 500, kObjSplinters},
                    Kind{"a.ply", std::string(kPlyFile)}, Kind{"b.ply", binary_ply()},
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
