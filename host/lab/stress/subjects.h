// Subjects of the stress test: the engines, cheaper arithmetic, and other people's tests.
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

/// What a variant says about one ray and one triangle.
struct Answer {
  bool hit = false;
  bool doubt = false;                                 ///< exact arithmetic on the host was asked
  float t = std::numeric_limits<float>::quiet_NaN();  ///< of a hit; NaN: the variant has none
  glm::vec3 point{std::numeric_limits<float>::quiet_NaN()};  ///< P, seen from the origin; likewise
  float point_error = std::numeric_limits<float>::infinity();     ///< of itself, P's at most
  Interval bounds{0.0, std::numeric_limits<double>::infinity()};  ///< of a hit's exact t
  /// What the renderer goes on with, where that is another.
  PreciseHit delivered{std::numeric_limits<float>::quiet_NaN(),
                       glm::vec3(std::numeric_limits<float>::quiet_NaN())};
};

/// What a variant says about some shots.
struct Answers {
  std::vector<Answer> tests;                          ///< shot by shot, as Shot::tests says
  std::vector<std::optional<std::uint32_t>> nearest;  ///< shot by shot, ray by ray: its triangle
  /// The same: all triangles that the ray hits, near before far. Empty: the subject gives no order.
  std::vector<std::vector<std::uint32_t>> orders;
  std::vector<bool> refused;  ///< likewise: rays out of the subject's range. Empty: none
};

class Subject {
 public:
  virtual ~Subject() = default;

  /// Replaces `answers` by those for `shots`.
  virtual void run(std::span<const Shot> shots, Answers& answers) = 0;
};

struct SubjectKind {
  std::string name{};
  std::string what{};      ///< one line for the report
  bool exact = false;      ///< it promises to be never wrong: the run fails where it is
  bool simulated = false;  ///< Verilated hardware
  bool binary32 = false;   ///< what errors.h says of t and P holds
  double share = 0.1;      ///< of the number of tests asked for
  std::function<std::unique_ptr<Subject>()> make{};  ///< one for each thread
};

/// All subjects of this build, in the order of the report.
[[nodiscard]] std::vector<SubjectKind> all_subjects();

/// The parts of that list.
[[nodiscard]] std::vector<SubjectKind> engine_subjects();
[[nodiscard]] std::vector<SubjectKind> trace_subjects();
[[nodiscard]] std::vector<SubjectKind> variant_subjects();  ///< of variants.json
[[nodiscard]] std::vector<SubjectKind> float_subjects();    ///< what ray tracers do in float32
[[nodiscard]] std::vector<SubjectKind> embree_subjects();   ///< none without Embree

/// Hit tests in float32.
using TriangleTest = Answer(const glm::vec3& origin, const glm::vec3& direction,
                            const Corners& triangle);
/// Möller and Trumbore, "Fast, minimum storage ray/triangle intersection", 1997, both sides,
/// without an epsilon.
TriangleTest moeller_trumbore;
/// Woop, Benthin and Wald, "Watertight ray/triangle intersection", 2013: the triangle is sheared so
/// that the ray runs along an axis; edge functions of zero are computed again in double.
TriangleTest woop;

/// Returns the number of hits of each ray by Embree, in its default and its robust mode, by name;
/// none without Embree.
[[nodiscard]] std::vector<std::pair<std::string, std::vector<std::uint32_t>>> embree_hit_counts(
    const Scene& scene, std::span<const Ray> rays);

/// Fills `nearest` from the smallest t of each ray's hits, the first of equals.
void nearest_by_t(std::span<const Shot> shots, Answers& answers);

/// A scene of these triangles, one material.
[[nodiscard]] Scene scene_of(const Mesh& mesh);

}  // namespace raygate::lab
