// Subjects of the stress test: engines, variants of arithmetic, and other ray tracers' tests.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "host/exact/exact.h"
#include "host/intersect/intersector.h"
#include "host/lab/stress/cases.h"
#include "host/scene/scene.h"

namespace raygate::lab {

/// A subject's result for one ray and one triangle.
struct Answer {
  bool hit = false;
  bool doubt = false;  ///< resolved by exact arithmetic on the host
  double t = std::numeric_limits<double>::quiet_NaN();  ///< of a hit; NaN: not computed
  /// P, relative to the origin; NaN: not computed.
  glm::vec3 point{std::numeric_limits<float>::quiet_NaN()};
  float point_error = std::numeric_limits<float>::infinity();  ///< bound of the relative error of P
  Interval bounds{0.0, std::numeric_limits<double>::infinity()};  ///< bounds of a hit's exact t
  /// The hit that the renderer uses, if it differs from `t` and `point`.
  PreciseHit delivered{std::numeric_limits<float>::quiet_NaN(),
                       glm::vec3(std::numeric_limits<float>::quiet_NaN())};
};

/// A subject's results for some shots.
struct Answers {
  std::vector<Answer> tests;  ///< by shot, in the order of Shot::tests
  /// By shot, then by ray: the nearest triangle.
  std::vector<std::optional<std::uint32_t>> nearest;
  /// By shot, then by ray: all triangles that the ray hits, nearest first. Empty if not provided.
  std::vector<std::vector<std::uint32_t>> orders;
  std::vector<bool> refused;  ///< by shot, then by ray: outside of the subject's range; empty: none
};

class Subject {
 public:
  virtual ~Subject() = default;

  /// Replaces `answers` by the answers for `shots`.
  virtual void run(std::span<const Shot> shots, Answers& answers) = 0;
};

/// Makes intersectors, which share a unit.
using IntersectorOf = std::function<std::unique_ptr<Intersector>(const Bvh&)>;

struct SubjectKind {
  std::string name{};
  std::string what{};      ///< one line for the report
  bool exact = false;      ///< any wrong decision fails the run
  bool simulated = false;  ///< Verilated hardware
  bool binary32 = false;   ///< the bounds of tally.cpp for t and P apply
  bool binary64 = false;   ///< takes suites of binary64 vertices, too
  double share = 0.1;      ///< fraction of the requested number of tests
  std::function<std::unique_ptr<Subject>()> make{};
  std::function<IntersectorOf()> engine{};  ///< makes the engine or variant
};

/// Returns all subjects of this build, in the order of the report.
[[nodiscard]] std::vector<SubjectKind> all_subjects();

/// Return parts of all_subjects().
[[nodiscard]] std::vector<SubjectKind> engine_subjects();
[[nodiscard]] std::vector<SubjectKind> trace_subjects();
[[nodiscard]] std::vector<SubjectKind> variant_subjects();  ///< of variants.json
[[nodiscard]] std::vector<SubjectKind> embree_subjects();

/// Returns the number of hits of each ray with Embree, in default and robust mode, by name.
[[nodiscard]] std::vector<std::pair<std::string, std::vector<std::uint32_t>>> embree_hit_counts(
    const Scene& scene, std::span<const Ray> rays);

/// Calls `ask` for each series of shots at one mesh, or for each shot if `alone`.
template <class Ask>
void for_each_mesh(std::span<const Shot> shots, bool alone, const Ask& ask) {
  while (!shots.empty()) {
    std::size_t together = 1;
    while (!alone && together < shots.size() && shots[together].mesh == shots[0].mesh) ++together;
    ask(shots.first(together));
    shots = shots.subspan(together);
  }
}

/// Sets `nearest` to each ray's hit with the smallest t; of equal ones, the first.
void nearest_by_t(std::span<const Shot> shots, Answers& answers);

}  // namespace raygate::lab
