// The list of all subjects, and common intersection tests of ray tracers.
#include "host/lab/stress/subjects.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace raygate::lab {
namespace {

/// A hit test in a format T, to which vertices and rays are rounded.
template <class T>
using TriangleTest = Answer(const glm::vec<3, T>& origin, const glm::vec<3, T>& direction,
                            const glm::vec<3, T> (&triangle)[3]);

/// The test of Möller and Trumbore, "Fast, minimum storage ray/triangle intersection", 1997, for
/// both sides, without an epsilon.
template <class T>
Answer moeller_trumbore(const glm::vec<3, T>& origin, const glm::vec<3, T>& direction,
                        const glm::vec<3, T> (&t)[3]) {
  Answer answer;
  const auto ab = t[1] - t[0], ac = t[2] - t[0], from_a = origin - t[0];
  const auto p = glm::cross(direction, ac), q = glm::cross(from_a, ab);
  const T determinant = glm::dot(ab, p);
  if (!(std::abs(determinant) > 0)) return answer;
  const T inverse = 1 / determinant;
  const T u = glm::dot(from_a, p) * inverse, v = glm::dot(direction, q) * inverse;
  const T distance = glm::dot(ac, q) * inverse;
  if (!(u >= 0 && v >= 0 && u + v <= 1 && distance > 0)) return answer;
  answer.hit = true;
  answer.t = distance;
  answer.point = glm::vec3(distance * direction);
  return answer;
}

/// The test of Woop, Benthin and Wald, "Watertight ray/triangle intersection", 2013: shears the
/// triangle so that the ray runs along an axis; recomputes zero edge functions in double.
Answer woop(const glm::vec3& origin, const glm::vec3& direction, const glm::vec3 (&t)[3]) {
  Answer answer;
  const glm::vec3 size = glm::abs(direction);
  const int z = size.x > size.y && size.x > size.z ? 0 : (size.y > size.z ? 1 : 2);
  int x = (z + 1) % 3, y = (z + 2) % 3;
  if (direction[z] < 0.0f) std::swap(x, y);
  const float shear_x = direction[x] / direction[z], shear_y = direction[y] / direction[z];
  const float scale_z = 1.0f / direction[z];
  float px[3], py[3], pz[3];
  for (int k = 0; k < 3; ++k) {
    const glm::vec3 v = t[k] - origin;
    px[k] = v[x] - shear_x * v[z];
    py[k] = v[y] - shear_y * v[z];
    pz[k] = scale_z * v[z];
  }
  float weight[3];
  for (int k = 0; k < 3; ++k) {
    const int b = (k + 1) % 3, c = (k + 2) % 3;
    weight[k] = px[c] * py[b] - py[c] * px[b];
  }
  if (weight[0] == 0.0f || weight[1] == 0.0f || weight[2] == 0.0f) {
    for (int k = 0; k < 3; ++k) {
      const int b = (k + 1) % 3, c = (k + 2) % 3;
      weight[k] = static_cast<float>(static_cast<double>(px[c]) * py[b] -
                                     static_cast<double>(py[c]) * px[b]);
    }
  }
  const bool negative = weight[0] < 0.0f || weight[1] < 0.0f || weight[2] < 0.0f;
  const bool positive = weight[0] > 0.0f || weight[1] > 0.0f || weight[2] > 0.0f;
  const float determinant = weight[0] + weight[1] + weight[2];
  if ((negative && positive) || !(std::abs(determinant) > 0.0f)) return answer;
  const float scaled = (weight[0] * pz[0] + weight[1] * pz[1]) + weight[2] * pz[2];
  const float distance = scaled * (1.0f / determinant);
  if (!(distance > 0.0f)) return answer;
  answer.hit = true;
  answer.t = distance;
  answer.point = distance * direction;
  return answer;
}

template <class T>
class TestSubject : public Subject {
 public:
  explicit TestSubject(TriangleTest<T>* test) : test_(test) {}

  void run(std::span<const Shot> shots, Answers& answers) override {
    answers.tests.clear();
    for (const Shot& shot : shots) {
      for (const glm::vec<3, T> direction : shot.directions) {
        for (const Corners& t : *shot.mesh) {
          answers.tests.push_back(
              test_(shot.origin, direction, {Vector(t[0]), Vector(t[1]), Vector(t[2])}));
        }
      }
    }
    nearest_by_t(shots, answers);
  }

 private:
  using Vector = glm::vec<3, T>;

  TriangleTest<T>* test_;
};

template <class T>
SubjectKind kind(const char* name, const char* what, TriangleTest<T>* test) {
  return {.name = name, .what = what, .binary64 = true, .make = [test] {
            return std::make_unique<TestSubject<T>>(test);
          }};
}

}  // namespace

std::vector<SubjectKind> all_subjects() {
  std::vector<SubjectKind> all;
  for (auto part :
       {engine_subjects(),
        trace_subjects(),
        variant_subjects(),
        {kind<float>("Moeller-Trumbore", "the test most ray tracers use, in float32",
                     moeller_trumbore),
         kind<double>("Moeller-Trumbore 64", "the same in float64, as in libigl", moeller_trumbore),
         kind<float>("Woop 2013", "the watertight test, in float32, not fused", woop)},
        embree_subjects()}) {
    std::ranges::move(part, std::back_inserter(all));
  }
  return all;
}

void nearest_by_t(std::span<const Shot> shots, Answers& answers) {
  answers.nearest.clear();
  auto answer = answers.tests.cbegin();
  for (const Shot& shot : shots) {
    for (std::size_t ray = 0; ray < shot.directions.size(); ++ray) {
      std::optional<std::uint32_t> nearest;
      double t = std::numeric_limits<double>::infinity();
      for (std::uint32_t i = 0; i < shot.mesh->size(); ++i, ++answer) {
        if (!answer->hit || (nearest && !(answer->t < t))) continue;
        nearest = i;
        t = answer->t;
      }
      answers.nearest.push_back(nearest);
    }
  }
}

}  // namespace raygate::lab
