// The stress test: counts of a subject's wrong decisions, and its errors.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host/lab/lab.h"
#include "host/lab/stress/subjects.h"

namespace raygate::lab {

/// Results of one subject in one suite.
struct Tally {
  std::uint64_t tests = 0, rays = 0;  ///< rays within the subject's range
  std::uint64_t refused = 0;          ///< rays outside of the subject's range
  /// Tests with a wrong decision, or with an interval that does not contain t, except ties.
  std::uint64_t wrong = 0;
  /// Wrong tests that only the tie-break decides; allowed unless the subject is exact.
  std::uint64_t wrong_ties = 0;
  std::uint64_t escapes = 0;             ///< rays from inside a closed mesh without a hit
  std::uint64_t double_hits = 0;         ///< rays from inside with too many hits
  std::uint64_t wrong_nearest = 0;       ///< rays with a wrong nearest triangle, except ties
  std::uint64_t wrong_tied_nearest = 0;  ///< rays with a wrong nearest triangle in ties
  std::uint64_t orders = 0;              ///< rays for which the subject returned all hits in order
  std::uint64_t wrong_order = 0;         ///< rays among `orders` with a wrong order or wrong hits
  std::uint64_t hits = 0, doubts = 0;
  /// Largest errors, in ulps, of t and of any coordinate of P in hits that the host delivers.
  double delivered_t_ulp = 0.0, delivered_point_ulp = 0.0;
  /// Largest errors of hits without doubt, relative to the bounds of tally.cpp for binary32.
  double t_of_bound = 0.0, point_of_bound = 0.0;
  /// Largest error of P, relative to the reported bound (NearestHit::point_error).
  double point_of_said = 0.0;
  /// The first few failures, as lines of test/regressions.txt; ties only for exact subjects.
  std::vector<std::string> failures;

  /// Returns whether an exact subject passes: no wrong decision, and errors within proven bounds.
  [[nodiscard]] bool spotless() const;
  /// Returns a column for each member.
  [[nodiscard]] Row row() const;
};

/// Compares a subject's answers for some shots with the oracle's.
void count(std::span<const Shot> shots, std::span<const Truth> truths, const Answers& answers,
           const SubjectKind& subject, Tally& tally);

/// Runs a suite with every subject that supports the suite, on at least the subject's share of
/// `tests`. Returns a row for each subject. All subjects see prefixes of one sequence of cases.
[[nodiscard]] std::vector<Row> run(const Suite& suite, std::vector<SubjectKind> subjects,
                                   std::uint64_t tests, std::uint64_t seed);

/// Runs the public acceptance tests of watertightness (watertight.cpp), with `triangles` (at least
/// 4) in a mesh, as many rays, and `seeds` meshes of nomiss. Returns a row for each acceptance test
/// and hit test: "test", "by" and "exact" (name of the hit test, and whether it claims to be
/// exact), "rays", "escapes" and "double_hits" (null for hit tests that find only the nearest hit).
[[nodiscard]] std::vector<Row> watertight_rows(int triangles, int seeds);

}  // namespace raygate::lab
