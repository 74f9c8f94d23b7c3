// Tally: counts of a subject's wrong decisions, and its errors in ulps.
#pragma once

#include <cstdint>
#include <vector>

#include "host/lab/results.h"
#include "host/lab/stress/oracle.h"
#include "host/lab/stress/shot.h"
#include "host/lab/stress/subjects.h"

namespace raygate::lab {

/// Results of one subject in one suite.
struct Tally {
  std::uint64_t tests = 0, rays = 0;  ///< rays within the subject's range
  std::uint64_t refused = 0;          ///< rays outside of the subject's range
  /// Tests with a wrong decision, or with an interval that does not contain t, except ties.
  std::uint64_t wrong = 0;
  std::uint64_t ties = 0;  ///< tests that only the tie-break decides
  /// Wrong decisions among `ties`; allowed unless the subject is exact.
  std::uint64_t wrong_ties = 0;
  std::uint64_t escapes = 0;             ///< rays from inside a closed mesh without a hit
  std::uint64_t double_hits = 0;         ///< rays from inside with too many hits
  std::uint64_t wrong_nearest = 0;       ///< rays with a wrong nearest triangle, except ties
  std::uint64_t wrong_tied_nearest = 0;  ///< likewise among ties
  std::uint64_t orders = 0;              ///< rays for which the subject returned all hits in order
  std::uint64_t wrong_order = 0;         ///< rays among `orders` with a wrong order or wrong hits
  std::uint64_t hits = 0, doubts = 0;
  /// Largest errors of correct hits, in ulps: of t, and of any coordinate of P.
  double t_ulp = 0.0, point_ulp = 0.0;
  /// Largest errors of the hits that the host delivers.
  double delivered_t_ulp = 0.0, delivered_point_ulp = 0.0;
  /// Largest errors of sure hits, relative to the bounds of tally.cpp for binary32.
  double t_of_bound = 0.0, point_of_bound = 0.0;
  /// Largest error of P, relative to the reported bound (NearestHit::point_error).
  double point_of_said = 0.0;
  std::vector<Case> failures;  ///< the first few; ties only for exact subjects

  /// Returns the number of wrong decisions on hits, nearest and order; ties if `exact`.
  [[nodiscard]] std::uint64_t wrong_decisions(bool exact) const {
    return wrong + wrong_nearest + (exact ? wrong_ties + wrong_tied_nearest + wrong_order : 0);
  }
  /// Returns whether an exact subject passes: no wrong decision, and errors within proven bounds.
  [[nodiscard]] bool spotless() const;
  /// Returns a column for each member.
  [[nodiscard]] Row row() const;
};

/// Compares a subject's answers for some shots with the oracle's.
void count(std::span<const Shot> shots, std::span<const Truth> truths, const Answers& answers,
           const SubjectKind& subject, Tally& tally);

}  // namespace raygate::lab
