// Tally: counts of wrong decisions of a subject, and its errors in units of the last place.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "host/lab/results.h"
#include "host/lab/stress/errors.h"
#include "host/lab/stress/oracle.h"
#include "host/lab/stress/shot.h"
#include "host/lab/stress/subjects.h"

namespace raygate::lab {

/// Results of one subject in one suite.
struct Tally {
  std::uint64_t tests = 0, rays = 0;  ///< without rays out of the subject's range
  std::uint64_t refused = 0;          ///< rays out of the subject's range
  /// Tests decided otherwise than the truth, or hit at another t than they say, ties aside.
  std::uint64_t wrong = 0;
  std::uint64_t ties = 0;           ///< tests that only the tie-break decides
  std::uint64_t wrong_ties = 0;     ///< of these, decided otherwise: a sin of exact subjects only
  std::uint64_t escapes = 0;        ///< rays from inside a closed mesh without a hit
  std::uint64_t double_hits = 0;    ///< rays from inside with more hits than there are
  std::uint64_t wrong_nearest = 0;  ///< rays whose first triangle is another, ties aside
  std::uint64_t wrong_tied_nearest = 0;  ///< the same among ties
  std::uint64_t orders = 0;              ///< rays of which the subject gave all hits in order
  std::uint64_t wrong_order = 0;         ///< of these, with another order or other hits
  std::uint64_t hits = 0, doubts = 0;
  /// Of hits that are hits, in ulp of the exact value: t, and the worst coordinate of P; and t's
  /// relative error.
  Errors t_ulp, point_ulp, t_relative;
  /// What the host makes of them in the end.
  Errors delivered_t_ulp, delivered_point_ulp;
  /// t_ulp of sure hits by the angle between ray and plane: decade k holds sines from 10^-k-1 to
  /// 10^-k.
  static constexpr int kDecades = 8;
  std::array<Errors, kDecades> t_ulp_by_angle;
  /// The largest errors of sure hits over what errors.h allows binary32.
  double t_of_bound = 0.0, point_of_bound = 0.0;
  /// The largest error of P over what the hit itself says (NearestHit::point_error).
  double point_of_said = 0.0;
  std::vector<Case> failures;  ///< the first few, ties only of exact subjects

  /// Hit or miss, nearest and order, those on ties for exact subjects alone.
  [[nodiscard]] std::uint64_t wrong_decisions(bool exact) const {
    return wrong + wrong_nearest + (exact ? wrong_ties + wrong_tied_nearest + wrong_order : 0);
  }
  /// What an exact subject must be: never wrong, and no farther off than is proven.
  [[nodiscard]] bool spotless() const;
  /// A column for each member; errors as lists of [end of a bin, errors in it].
  [[nodiscard]] Row row() const;
};

/// Compares a subject's answers for some shots with the truth about them.
void count(std::span<const Shot> shots, std::span<const Truth> truths, const Answers& answers,
           const SubjectKind& subject, Tally& tally);

}  // namespace raygate::lab
