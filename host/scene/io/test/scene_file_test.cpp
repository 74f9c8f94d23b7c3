// scene.json: reads every key. Invalid contents give a one-line error that names file and line.
#include <gtest/gtest.h>

#include "host/base/input_error.h"
#include "host/base/test/damage.h"
#include "host/base/test/temp_folder.h"
#include "host/scene/instances.h"
#include "host/scene/io/scene_loader.h"

namespace raygate {
namespace {

constexpr std::string_view kWhole = R"({
  "obj": "room.obj",
  "camera": {"eye": [0, 1, 5], "target": [0, 1, 0], "up": [0, 1, 0.5], "fov": 39.5},
  "point_lights": [{"position": [1, 2, 3], "intensity": [10, 20, 30]}],
  "area_lights": [
    {"corner": [0, 3, 0], "edges": [[1, 0, 0], [0, 0, 2]], "radiance": 5}
  ],
  "background": [0.1, 0.2, 0.3],
  "render": {"size": "320x200", "spp": 16, "exposure": -0.5, "integrator": "path"}
}
)";

class ReadSceneFile : public testing::Test {
 protected:
  [[nodiscard]] SceneFile read(std::string_view text) const {
    return read_scene_file(folder_.write("s.json", text));
  }
  [[nodiscard]] std::string error(std::string_view text) const {
    return folder_.error_of([&] { (void)read(text); });
  }

  const TempFolder folder_;
};

TEST_F(ReadSceneFile, EveryKey) {
  const SceneFile scene = read(kWhole);
  EXPECT_EQ(scene.obj, folder_.path() / "room.obj");
  const std::optional<CameraSetting>& camera = scene.camera.camera;
  ASSERT_TRUE(camera);
  EXPECT_EQ(camera->eye, glm::dvec3(0, 1, 5));
  EXPECT_EQ(camera->target, glm::dvec3(0, 1, 0));
  EXPECT_EQ(camera->up, glm::dvec3(0, 1, 0.5));
  EXPECT_EQ(camera->fov, 39.5);
  ASSERT_EQ(scene.point_lights.size(), 1u);
  EXPECT_EQ(scene.point_lights[0].position, glm::dvec3(1, 2, 3));
  EXPECT_EQ(scene.point_lights[0].intensity, glm::dvec3(10, 20, 30));
  ASSERT_EQ(scene.area_lights.size(), 1u);
  EXPECT_EQ(scene.area_lights[0].corner, glm::dvec3(0, 3, 0));
  EXPECT_EQ(scene.area_lights[0].edges[1], glm::dvec3(0, 0, 2));
  EXPECT_EQ(scene.area_lights[0].radiance, glm::vec3(5)) << "one number is grey";
  EXPECT_EQ(scene.background, glm::vec3(0.1f, 0.2f, 0.3f));
  ASSERT_EQ(scene.options.size(), 4u);
  EXPECT_EQ(scene.options[0].name, "exposure") << "sorted by name";
  EXPECT_EQ(scene.options[0].text, "-0.5");
  EXPECT_EQ(scene.options[1].where, (folder_.path() / "s.json:9").string());
  EXPECT_EQ(scene.options[2].text, "320x200");
  EXPECT_EQ(scene.options[3].text, "16");
}

TEST_F(ReadSceneFile, NothingIsNeeded) {
  const SceneFile scene = read("{}");
  EXPECT_EQ(scene.obj, folder_.path() / "s.obj") << "the same name";
  EXPECT_FALSE(scene.camera.camera);
  EXPECT_TRUE(scene.point_lights.empty() && scene.area_lights.empty());
  EXPECT_FALSE(scene.background);
}

TEST_F(ReadSceneFile, UpAndFieldOfViewAreKnownWithoutACamera) {
  const SceneFile scene = read(R"({"camera": {"up": [0, 0, 1], "fov": 50}})");
  EXPECT_FALSE(scene.camera.camera);
  EXPECT_EQ(scene.camera.up, glm::dvec3(0, 0, 1));
  EXPECT_EQ(scene.camera.fov, 50.0);
}

TEST_F(ReadSceneFile, WhatIsNoJson) {
  EXPECT_EQ(error(""), "s.json: the file is empty");
  EXPECT_TRUE(error("{\n  \"obj\" \"a\"\n}").starts_with("s.json:2: not JSON: "))
      << error("{\n  \"obj\" \"a\"\n}");
  EXPECT_TRUE(error("{\n").starts_with("s.json:1: not JSON: "));
  EXPECT_TRUE(error("v 0 0 0\n").starts_with("s.json:1: not JSON: "));
  EXPECT_TRUE(error("{} {}").starts_with("s.json:1: not JSON: "));
  EXPECT_TRUE(error("{\"obj\": \"\xFF\"}").starts_with("s.json:1: not JSON: "));
  EXPECT_TRUE(error(std::string(100'000, '[')).starts_with("s.json:1: not JSON: "));
  EXPECT_EQ(error("{\n\"obj\": \"a\",\n\"obj\": \"b\"}"), "s.json:3: key 'obj' is there twice");
  // The time must not grow with the square of the number of keys.
  std::string many;
  for (int i = 0; i < 100000; ++i) many.append("\"").append(std::to_string(i)).append("\": 0,\n");
  EXPECT_EQ(error("{\n" + many + "\"99999\": 1}"), "s.json:100002: key '99999' is there twice");
}

TEST_F(ReadSceneFile, ValuesOfTheWrongKindOrOutOfRange) {
  const std::string keys =
      "obj, camera, instances, point_lights, spot_lights, directional_lights, area_lights, "
      "environment, background, render";
  const std::pair<const char*, std::string> rows[] = {
      {"[]", "1: scene: an array of 0, expected an object with " + keys},
      {"{\n  \"colour\": 1\n}", "2: scene: unknown key 'colour', expected some of " + keys},
      {R"({"obj": 5})", "1: obj: 5, expected the name of a scene"},
      {R"({"camera": {"eye": [0, 0, 1]}})", "1: camera: 'target' is missing"},
      {R"({"camera": {"eye": [0, 0, 1], "up": [0, 1, 0]}})", "1: camera: 'target' is missing"},
      {R"({"camera": {"up": [0, 0, 0]}})",
       "1: camera.up: an array of 3, expected a direction across the view"},
      {"{\"camera\": {\n\"eye\": [0, 0],\n\"target\": [0, 0, 0]}}",
       "2: camera.eye: an array of 2, expected [x, y, z]"},
      {"{\"camera\": {\n\"eye\": [0,\n0,\n\"up\"],\n\"target\": [0, 0, 0]}}",
       "4: camera.eye[2]: 'up', expected a number within the range of float"},
      {R"({"camera": {"eye": [0, 0, 1], "target": [0, 0, 0], "fov": 180}})",
       "1: camera.fov: 180, expected degrees above 0 and below 180"},
      {R"({"camera": {"eye": [0, 0, 1], "target": [0, 0, 0], "up": [0, 0, 2]}})",
       "1: camera.up: an array of 3, expected a direction across the view"},
      {R"({"camera": {"eye": [1, 2, 3], "target": [1, 2, 3]}})",
       "1: camera.target: an array of 3, expected another point than the eye"},
      {R"({"camera": {"projection": "fisheye"}})",
       "1: camera.projection: 'fisheye', expected perspective or orthographic"},
      {R"({"camera": {"aperture": -1}})",
       "1: camera.aperture: -1, expected the radius of a lens, 0 or more"},
      {R"({"camera": {"focus": 0}})", "1: camera.focus: 0, expected a distance, more than 0"},
      {R"({"environment": {}})", "1: environment: 'file' is missing"},
      {R"({"environment": {"file": "a", "strength": -1}})",
       "1: environment.strength: -1, expected a factor from 0 to 1e9"},
      {R"({"background": "blue"})",
       "1: background: 'blue', expected [red, green, blue] or one number for all three"},
      {R"({"background": -1})", "1: background: -1, expected no negative number"},
      {R"({"background": [0, 1e39, 0]})",
       "1: background[1]: 1e+39, expected a number within the range of float"},
      {R"({"point_lights": {}})", "1: point_lights: an object, expected an array"},
      {R"({"spot_lights": [{"position": [0, 0, 0], "intensity": 1}]})",
       "1: spot_lights[0]: 'direction' is missing"},
      {R"({"directional_lights": [{"direction": [0, -1], "irradiance": 1}]})",
       "1: directional_lights[0].direction: an array of 2, expected [x, y, z]"},
      {R"({"area_lights": [{"corner": [0, 0, 0], "edges": [[1, 0, 0], [2, 0, 0]],
                            "radiance": 1}]})",
       "1: area_lights[0].edges: an array of 2, expected two that are not parallel"},
      {R"({"render": {"spp": [1]}})",
       "1: render.spp: an array of 1, expected a number or a string, as on the command line"}};
  for (const auto& [text, expected] : rows) EXPECT_EQ(error(text), "s.json:" + expected) << text;
  EXPECT_TRUE(error(R"({"camera": {"eye": [1e999, 2, 3], "target": [1, 2, 3]}})")
                  .starts_with("s.json:1: "));
}

TEST_F(ReadSceneFile, LensesAndEnvironments) {
  const SceneFile file = read(R"({
      "camera": {"eye": [0, 0, 1], "target": [0, 0, 0], "projection": "orthographic", "aperture": 0.5,
                 "focus": 3},
      "environment": {"file": "sky.exr", "rotation": 90, "strength": 2}})");
  EXPECT_EQ(file.camera.lens.projection, Projection::kOrthographic);
  EXPECT_EQ(file.camera.lens.aperture, 0.5);
  EXPECT_EQ(file.camera.lens.focus, 3.0) << "also of views";
  EXPECT_EQ(file.environment.file, folder_.path() / "sky.exr");
  EXPECT_EQ(file.environment.rotation, 90.0);
  EXPECT_EQ(file.environment.strength, 2.0);
}

TEST_F(ReadSceneFile, SpotAndDirectionalLights) {
  const SceneFile file = read(R"({
      "spot_lights": [{"position": [1, 2, 3], "direction": [0, -2, 0], "intensity": 9},
          {"position": [0, 0, 0], "direction": [1, 0, 0], "intensity": 1, "inner": 5, "outer": 6}],
      "directional_lights": [{"direction": [0, 0, 1e-30], "irradiance": [1, 2, 3]}]})");
  ASSERT_EQ(file.point_lights.size(), 2u);
  ASSERT_TRUE(file.point_lights[0].spot && file.point_lights[1].spot);
  EXPECT_EQ(file.point_lights[0].spot->axis, glm::dvec3(0, -1, 0));
  EXPECT_EQ(file.point_lights[0].spot->inner, 0.0);
  EXPECT_EQ(file.point_lights[0].spot->outer, 45.0);
  EXPECT_EQ(file.point_lights[1].spot->inner, 5.0);
  ASSERT_EQ(file.directional_lights.size(), 1u);
  EXPECT_EQ(file.directional_lights[0].direction, glm::dvec3(0, 0, 1));
  EXPECT_EQ(file.directional_lights[0].irradiance, glm::vec3(1, 2, 3));
  const auto spot = [&](const std::string& rest) {
    return error(R"({"spot_lights": [{"position": [0, 0, 0], "intensity": 1, )" + rest + "}]}");
  };
  EXPECT_EQ(spot(R"("direction": [0, 0, 0])"),
            "s.json:1: spot_lights[0].direction: an array of 3, expected a direction: not all "
            "three 0");
  EXPECT_EQ(spot(R"("direction": [0, 0, 1], "outer": 91)"),
            "s.json:1: spot_lights[0].outer: 91, expected degrees from the axis, 0.001 to 90");
  EXPECT_EQ(spot(R"("direction": [0, 0, 1], "inner": 46)"),
            "s.json:1: spot_lights[0].inner: 46, expected degrees from the axis, from 0 to "
            "'outer'");
}

TEST_F(ReadSceneFile, LightsJoinTheScene) {
  folder_.write("room.obj", "v 99999 0 0\nv 100001 0 0\nv 100000 1 0\nf 1 2 3\n");
  const SceneFile file = read(R"({"obj": "room.obj", "background": 0.5,
      "point_lights": [{"position": [100000, 5, 1], "intensity": [1, 2, 3]}],
      "area_lights": [{"corner": [100000, 3, 0], "edges": [[1, 0, 0], [0, 0, 2]], "radiance": 7}]})");
  const Scene scene = load_scene(file);
  EXPECT_EQ(scene.background, glm::vec3(0.5f));
  ASSERT_EQ(scene.lights.size(), 1u);
  EXPECT_EQ(scene.origin + glm::dvec3(scene.lights[0].position), glm::dvec3(100000, 5, 1));
  ASSERT_EQ(scene.triangles.size(), 3u);
  ASSERT_EQ(scene.objects.size(), 2u);
  double area = 0.0;
  for (std::size_t i = 1; i < 3; ++i) {
    const Triangle& triangle = scene.triangles[i];
    EXPECT_EQ(scene.materials[triangle.material].emission, glm::vec3(7));
    EXPECT_EQ(scene.materials[triangle.material].diffuse, glm::vec3(0));
    EXPECT_EQ(scene.objects[triangle.object], "light 1");
    const auto corner = [&](std::size_t k) { return scene.positions[triangle.vertices[k]]; };
    area += 0.5 * glm::length(glm::cross(corner(1) - corner(0), corner(2) - corner(0)));
  }
  EXPECT_DOUBLE_EQ(area, 2.0);
}

TEST_F(ReadSceneFile, InstancesOfModels) {
  folder_.write("room.obj", "v 0 0 0\nv 9 0 0\nv 0 9 0\nf 1 2 3\n");
  folder_.write("far.obj",
                "o first\nv 99999 0 0\nv 100001 0 0\nv 100000 1 0\nf 1 2 3\n"
                "o second\nf 3 2 1\n");
  const SceneFile file = read(R"({"obj": "room.obj", "instances": [{"model": "far.obj", "places": [
      [1, 2, 3], [2, 0, 0, -200000, 0, 0, -1, 1, 0, 1, 0, 2], [-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]]}]})");
  const Scene kept = load_scene(file);
  Scene written = kept;
  resolve_instances(written, InstanceMode::kFlatten, "room.json");
  EXPECT_EQ(kept.instances.size(), 3u);
  EXPECT_EQ(kept.meshes.size(), 2u);
  EXPECT_EQ(kept.triangles.size(), 1u);
  ASSERT_EQ(written.triangles.size(), 7u);
  const auto corner = [&](std::size_t triangle, std::size_t k) {
    return written.origin + glm::dvec3(written.positions[written.triangles[triangle].vertices[k]]);
  };
  EXPECT_EQ(corner(1, 0), glm::dvec3(100000, 2, 3));
  EXPECT_EQ(corner(3, 2), glm::dvec3(0, 1, 3));
  EXPECT_EQ(corner(5, 2), glm::dvec3(-99999, 0, 0));
  EXPECT_EQ(written.objects[written.triangles[4].object], "second");
  EXPECT_EQ(written.triangles[4].object, written.triangles[2].object + 2);
}

TEST_F(ReadSceneFile, InstancesThatAreNoneAreRefused) {
  const auto expect = [&](const std::string& instance, const std::string& name) {
    const std::string found = error(R"({"instances": [)" + instance + "]}");
    EXPECT_TRUE(found.starts_with("s.json:1: " + name + ": ")) << found;
  };
  expect(R"({"model": 3, "places": []})", "instances[0].model");
  expect(R"({"model": "a.obj"})", "instances[0]");
  expect(R"({"model": "a.obj", "places": [[1, 2]]})", "instances[0].places[0]");
  expect(R"({"model": "a.obj", "places": [[1, 2, "3"]]})", "instances[0].places[0][2]");
  folder_.write("room.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const SceneFile missing =
      read(R"({"obj": "room.obj", "instances": [{"model": "no.obj", "places": [[0, 0, 0]]}]})");
  EXPECT_THROW((void)load_scene(missing), InputError);
  const SceneFile huge = read(R"({"obj": "room.obj", "instances": [{"model": "room.obj", "places":
      [[3e38, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]]}]})");
  EXPECT_THROW((void)load_scene(huge), InputError);
}

TEST_F(ReadSceneFile, LightsBeyondFloatAreRefused) {
  folder_.write("room.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const SceneFile tiny = read(R"({"obj": "room.obj", "area_lights": [
      {"corner": [1e6, 3, 0], "edges": [[1e-6, 0, 0], [0, 0, 1e-6]], "radiance": 7}]})");
  EXPECT_THROW((void)load_scene(tiny), InputError);
}

/// Damaged files are read, or refused in one line that names the file.
TEST_F(ReadSceneFile, DamagedFilesAreReadOrRefused) {
  const std::uint64_t seed = 20240607;
  RecordProperty("seed", std::to_string(seed));
  constexpr const char* kSplinters[] = {"null", "{}",   "[]", "\"",  "[",       "}",    ",",
                                        ":",    "true", "\n", "180", "\"fov\"", "\x01", "\\u00"};
  test::Damage damage(seed, kSplinters);
  int refused = 0, read_well = 0;
  for (int round = 0; round < 5000; ++round) {
    const std::string result = error(damage(std::string(kWhole)));
    (result == "(read)" ? read_well : refused) += 1;
    if (result != "(read)") {
      ASSERT_TRUE(result.starts_with("s.json:")) << result;
      ASSERT_EQ(result.find('\n'), std::string::npos) << result;
    }
  }
  EXPECT_GT(refused, 1000);
  EXPECT_GT(read_well, 100);
}

}  // namespace
}  // namespace raygate
