// Models as public reports about other programs describe them, and where rays hit them.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "host/app/test/program.h"
#include "host/scene/io/test/binary.h"

namespace raygate {
namespace {

struct Report {
  const char* name;
  const char* file;
  std::string bytes;
  const char* rays;
  std::vector<std::string> options;
  const char* out;
  const char* said;  ///< part of the warnings; empty: there is none
};

class Reports : public testing::TestWithParam<Report> {};

TEST_P(Reports, AreAnswered) {
  const Report& report = GetParam();
  const ScratchFolder folder;
  folder.write(report.file, report.bytes);
  folder.write("rays.csv", report.rays);
  std::vector<std::string> arguments = {report.file, "rays.csv"};
  arguments.insert(arguments.end(), report.options.begin(), report.options.end());
  const Outcome outcome = run_program({.arguments = arguments, .folder = folder.path()});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.out, report.out);
  EXPECT_NE(outcome.err.find(report.said), std::string::npos) << outcome.err;
  EXPECT_EQ(outcome.err.find("warning") != std::string::npos, *report.said != '\0') << outcome.err;
}

/// The square of binary.h with one part of its JSON replaced.
std::string square(const std::string& nodes, const std::string& part = "",
                   const std::string& instead = "", std::string buffer = test::square_buffer()) {
  std::string json = test::square_json(nodes);
  json.replace(json.find(part), part.size(), instead);
  return test::glb(json, std::move(buffer));
}

/// Its buffer with positions of 16 bits, 65535 being 1.
std::string quantised_buffer() {
  std::string positions;
  for (const int code : {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}) {
    positions += test::bytes_of(static_cast<std::uint16_t>(65535 * code));
  }
  return test::square_buffer().replace(0, positions.size(), positions);
}

const std::vector<std::string> kNearest = {"--columns", "triangle,t,side"},
                               kAny = {"--hits", "any"},
                               kAll = {"--hits", "all", "--columns", "ray,triangle,t"};

INSTANTIATE_TEST_SUITE_P(
    , Reports,
    testing::Values(
        Report{"FirstFaceOfAPlyWithoutArea",  // trimesh#1494, #790
               "a.ply",
               "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\n"
               "property float z\nelement face 3\nproperty list uchar int vertex_indices\n"
               "end_header\n0 0 0\n1 0 0\n2 0 0\n0 1 0\n1 1 0\n3 0 1 2\n3 0 1 3\n3 1 4 3\n",
               "0.25,0.25,1,0,0,-1\n0.75,0.75,1,0,0,-1\n", kNearest,
               "triangle,t,side\n1,1,-1\n2,1,-1\n", "face of zero area, left out"},
        Report{"ConcaveFaceOverContinuedLines",  // obj2gltf#79, trimesh#2560
               "a.obj",
               "v 0 0 0\r\nv 3 0 0\r\nv 3 2 0\r\nv 2 2 0\r\nv 2 1 0\r\nv 1 1 0\r\nv 1 2 0\r\n"
               "v 0 2 0\r\nf 1 2 3 \\\r\n4 5 \\\r\n6 7 8\r\n",
               "0.5,1.5,1,0,0,-1\n1.5,1.5,1,0,0,-1\n2.5,1.5,1,0,0,-1\n1.5,0.5,1,0,0,-1\n", kAny,
               "ray,hit\n0,1\n1,0\n2,1\n3,1\n", ""},
        Report{"ShortFacesAmongOthers",  // three.js#9204, tobj#36
               "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1\nf 1 2\nf 1 2 3\n", "0.25,0.25,1,0,0,-1\n",
               kNearest, "triangle,t,side\n0,1,-1\n", "face of fewer than 3 corners, left out"},
        Report{"FarFromTheOrigin",  // three-mesh-bvh#112, Open3D#5777
               "a.obj",
               "v 500000.125 4649776.25 10\nv 500001.125 4649776.25 10\n"
               "v 500000.125 4649777.25 10\nf 1 2 3\n",
               "500000.375,4649776.5,20,0,0,-1\n", kNearest, "triangle,t,side\n0,10,-1\n", ""},
        Report{"FarFromTheOriginWithAFaceThere", "a.obj",
               "v 500000 4649776.3 10\nv 500001 4649776.3 10\nv 500000 4649778.3 10\nv 0 0 0\n"
               "v 1 0 0\nv 0 1 0\nf 1 2 3\nf 4 5 6\n",
               "500000.25,4649777,20,0,0,-1\n", kNearest, "triangle,t,side\n0,10,-1\n",
               "corners moved by up to 0.2, more than a hundredth of their face"},
        Report{"RaysFromFarAway",  // pytracer#22
               "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
               "0.25,0.25,1e30,0,0,-1\n0.25,0.25,-1e30,0,0,1\n0.75,0.75,1e30,0,0,-1\n", kAny,
               "ray,hit\n0,1\n1,1\n2,0\n", ""},
        Report{"FacesInOnePlace",  // embree#52, trimesh#1097
               "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 3\nf 3 2 1\n",
               "0.25,0.25,1,0,0,-1\n", kAll, "ray,triangle,t\n0,0,1\n0,1,1\n0,2,1\n", ""},
        Report{"ThroughADiagonal",  // trimesh#1766, embree#174
               "a.obj",
               "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n",
               "0.5,0.5,1,0,0,-1\n0.25,0.25,1,0,0,-1\n",
               {"--hits", "all", "--columns", "ray,t"},
               "ray,t\n0,1\n1,1\n",
               ""},
        Report{"MirroredNode",  // glTF#2059, castle-engine#336
               "a.glb", square(R"([{"mesh": 0, "scale": [-1, 1, 1]}])"), "-0.75,0.25,1,0,0,-1\n",
               kNearest, "triangle,t,side\n0,1,-1\n", ""},
        Report{"NodeMirroredTwice", "a.glb", square(R"([{"mesh": 0, "scale": [-1, -2, 0.5]}])"),
               "-0.75,-0.5,1,0,0,-1\n", kNearest, "triangle,t,side\n0,1,-1\n", ""},
        Report{"RequiredInstancing",  // glTF#2402, glTFast#107
               "a.glb",
               square(R"([{"mesh": 0, "extensions": {"EXT_mesh_gpu_instancing":
                          {"attributes": {"TRANSLATION": 0}}}}])",
                      R"("asset")",
                      R"("extensionsRequired": ["EXT_mesh_gpu_instancing"],
                         "extensionsUsed": ["EXT_mesh_gpu_instancing"], "asset")"),
               "1.75,1.25,1,0,0,-1\n", kNearest, "triangle,t,side\n4,1,-1\n", ""},
        Report{"QuantisedPositions",  // glTFRuntime#57, three.js#21553
               "a.glb",
               square(R"([{"mesh": 0, "scale": [2, 2, 2]}])",
                      R"({"bufferView": 0, "componentType": 5126)",
                      R"({"bufferView": 0, "normalized": true, "componentType": 5123)",
                      quantised_buffer()),
               "1.5,0.5,1,0,0,-1\n", kNearest, "triangle,t,side\n0,1,-1\n", ""}),
    [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace raygate
