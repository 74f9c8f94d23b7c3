#include "host/lab/stress/subjects.h"

#include <iterator>

namespace raygate::lab {

std::vector<SubjectKind> all_subjects() {
  std::vector<SubjectKind> all;
  for (auto part : {engine_subjects(), trace_subjects(), variant_subjects(), float_subjects(),
                    embree_subjects()}) {
    std::move(part.begin(), part.end(), std::back_inserter(all));
  }
  return all;
}

void nearest_by_t(std::span<const Shot> shots, Answers& answers) {
  answers.nearest.clear();
  auto answer = answers.tests.cbegin();
  for (const Shot& shot : shots) {
    for (std::size_t ray = 0; ray < shot.directions.size(); ++ray) {
      std::optional<std::uint32_t> nearest;
      float t = std::numeric_limits<float>::infinity();
      for (std::uint32_t i = 0; i < shot.mesh->triangles.size(); ++i, ++answer) {
        if (!answer->hit || (nearest && !(answer->t < t))) continue;
        nearest = i;
        t = answer->t;
      }
      answers.nearest.push_back(nearest);
    }
  }
}

Scene scene_of(const Mesh& mesh) {
  Scene scene;
  scene.materials.emplace_back();
  scene.objects.push_back("mesh");
  for (const Corners& corners : mesh.triangles) {
    Triangle triangle;
    for (int k = 0; k < 3; ++k) {
      triangle.vertices[k] = static_cast<std::uint32_t>(scene.positions.size());
      scene.positions.push_back(corners[k]);
    }
    scene.triangles.push_back(triangle);
  }
  return scene;
}

}  // namespace raygate::lab
