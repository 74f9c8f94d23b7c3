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
#include "host/lab/stress/shot.h"
#include "host/scene/scene.h"

namespace raygate::lab {

/// A subject's result for one ray and one triangle.
struct Answer {
  bool hit = false;
  bool doubt = false;                                 ///< resolved by exact arithmetic on the host
  float t = std::numeric_limits<float>::quiet_NaN();  ///< of a hit; NaN: not computed
  /// P, relative to the origin; NaN: not computed.
  glm::vec3 point{std::numeric_limits<float>::quiet_NaN()};
  float point_error = std::numeric_limits<float>::infinity();  ///< bound of the relative error of P
  Interval bounds{0.0, std::numeric_limits<double>::infinity()};  ///< bounds of a hit's exact t
  /// The hit that the renderer uses, if that is another.
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

  /// Replaces `answers` by those for `shots`.
  virtual void run(std::span<const Shot> shots, Answers& answers) = 0;
};

struct SubjectKind {
  std::string name{};
  std::string what{};                                ///< one line for the report
  bool exact = false;                                ///< any wrong decision fails the run
  bool simulated = false;                            ///< Verilated hardware
  bool binary32 = false;                             ///< the bounds of tally.cpp for t and P apply
  double share = 0.1;                                ///< fraction of the requested number of tests
  std::function<std::unique_ptr<Subject>()> make{};  ///< called once per thread
};

/// Returns all subjects of this build, in the order of the report.
[[nodiscard]] std::vector<SubjectKind> all_subjects();

/// Return parts of that list.
[[nodiscard]] std::vector<SubjectKind> engine_subjects();
[[nodiscard]] std::vector<SubjectKind> trace_subjects();
[[nodiscard]] std::vector<SubjectKind> variant_subjects();  ///< of variants.json
[[nodiscard]] std::vector<SubjectKind> float_subjects();    ///< common float32 tests of ray tracers
[[nodiscard]] std::vector<SubjectKind> embree_subjects();   ///< empty without Embree

/// A hit test in float32.
using TriangleTest = Answer(const glm::vec3& origin, const glm::vec3& direction,
                            const Corners& triangle);
/// The test of Möller and Trumbore, "Fast, minimum storage ray/triangle intersection", 1997, for
/// both sides, without an epsilon.
TriangleTest moeller_trumbore;
/// The test of Woop, Benthin and Wald, "Watertight ray/triangle intersection", 2013: shears the
/// triangle so that the ray runs along an axis; recomputes zero edge functions in double.
TriangleTest woop;

/// Returns the number of hits of each ray with Embree, in default and robust mode, by name; empty
/// without Embree.
[[nodiscard]] std::vector<std::pair<std::string, std::vector<std::uint32_t>>> embree_hit_counts(
    const Scene& scene, std::span<const Ray> rays);

/// Sets `nearest` to the hit of each ray with the smallest t, the first of equals.
void nearest_by_t(std::span<const Shot> shots, Answers& answers);

/// Returns a scene of these triangles with one material.
[[nodiscard]] Scene scene_of(const Mesh& mesh);

}  // namespace raygate::lab
