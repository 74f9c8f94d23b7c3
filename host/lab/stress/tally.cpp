#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>

#include "host/lab/stress/stress.h"

// Error bounds of the unit's t = d / (I . n) and P = (d I) / (I . n) in binary32
//
// These bounds of the relative errors of t and of each coordinate of P depend on the sine of the
// angle between ray and plane. u = 2^-24 is the unit roundoff. N and D are the exact normal and
// plane distance, n and d the record's floats, I the direction (floats, so exact), V the float
// result of I . n. |.| is a vector's length, |.|_1 the sum of its magnitudes.
//
// 1. Words. triangle_normal guarantees a double within 2^-34 |N|_1 of each component, to first
//    order, and |N|_1 <= sqrt(3) |N|. Each is then rounded to float, with a relative error u. (A
//    subnormal word adds 2^-150, which is negligible: the largest word is at least 2^-60.) So
//      |I . n - I . N| <= u sum |I_k N_k| (1 + 2^-9) + 2^-34 sqrt(3) |N| |I|_1
//    With sum |I_k N_k| <= |I| |N| (Cauchy and Schwarz) and |I|_1 <= sqrt(3) |I|, this is
//      <= (1 + 2^-9 + 3 * 2^-10) u |I| |N|.
//    plane_distance is within 2^-32 |D| of D, and is rounded once: |d - D| <= (1 + 2^-7) u |D|.
// 2. The dot product. Each product takes part in at most three roundings:
//      |V - I . n| <= 3.00001 u sum |I_k n_k| <= (3 + 2^-9) u |I| |N|.
// 3. |I . N| = sine |I| |N|. So by 1 and 2, V's relative error is at most r = (4 + 2^-6) u / sine.
// 4. The division rounds once. In P, the product d I_k is rounded, too. So the bounds are
//      (1 + (1 + 2^-7) u) (1 + u)^m / (1 - r) - 1, with m = 1 for t and m = 2 for P.

namespace raygate::lab {
namespace {

constexpr std::size_t kFailures = 5;

/// Largest error, in ulps and at any angle, of hits that the host delivers. The host computes them
/// from the corners (precise_hit in host/exact/exact.h).
constexpr double kDeliveredUlp = 0.5 + 0x1p-10;

constexpr double kU = 0x1p-24;

double bound(double sine, int roundings) {
  const double slope = (4.0 + 0x1p-6) * kU / sine;
  if (!(slope < 1.0)) return std::numeric_limits<double>::infinity();
  double factor = (1.0 + (1.0 + 0x1p-7) * kU) / (1.0 - slope);
  for (int i = 0; i < roundings; ++i) factor *= 1.0 + kU;
  return factor - 1.0;
}

/// Return bounds of the relative errors of the unit's t and P in a hit without doubt whose exact
/// values are normal floats. `sine`: of the angle between ray and plane. The bounds are about (2 +
/// 4 / sine) 2^-24 and (3 + 4 / sine) 2^-24; infinite if no bound is proven.
double bound_of_t(double sine) { return bound(sine, 1); }
double bound_of_point(double sine) { return bound(sine, 2); }

/// Returns the distance of neighbouring floats near x, in double.
double ulp(double x) { return std::ldexp(1.0, std::max(std::ilogb(x), -126) - 23); }

/// Returns whether x is in the range of normal floats.
bool ordinary(double x) { return std::abs(x) >= 0x1p-126 && std::abs(x) < 0x1p127; }

/// Returns whether t is in the interval, within the error of the oracle's t.
bool holds(const Interval& interval, double t) {
  constexpr double kError = 0x1p-49;  // of t, and of this computation
  return interval.low <= t * (1.0 + kError) && t * (1.0 - kError) <= interval.high;
}

/// Error of a value in ulps of the exact value, and relative to the exact value.
struct Off {
  double ulps, relative;
};

std::optional<Off> off(double value, double exact) {
  if (std::isnan(value) || !ordinary(exact)) return std::nullopt;
  const double difference = std::abs(value - exact);
  return Off{difference / ulp(exact), difference / std::abs(exact)};
}

/// Returns the largest error of P's three coordinates.
std::optional<Off> off(const glm::vec3& point, const glm::dvec3& direction, double t) {
  std::optional<Off> worst;
  for (int k = 0; k < 3; ++k) {
    const auto error = off(point[k], t * direction[k]);
    if (!error) continue;
    if (!worst) worst = Off{0.0, 0.0};
    worst = Off{std::max(worst->ulps, error->ulps), std::max(worst->relative, error->relative)};
  }
  return worst;
}

void add_errors(const Answer& answer, const Verdict& truth, const glm::dvec3& direction,
                bool bounded, Tally& tally) {
  if (!ordinary(truth.t)) return;
  if (const auto error = off(answer.t, truth.t)) {
    if (bounded && !answer.doubt) {
      tally.t_of_bound = std::max(tally.t_of_bound, error->relative / bound_of_t(truth.sine));
    }
  }
  if (const auto error = off(answer.point, direction, truth.t)) {
    tally.point_of_said = std::max(tally.point_of_said, error->relative / answer.point_error);
    if (bounded && !answer.doubt) {
      tally.point_of_bound =
          std::max(tally.point_of_bound, error->relative / bound_of_point(truth.sine));
    }
  }
  if (const auto error = off(answer.delivered.t, truth.t)) {
    tally.delivered_t_ulp = std::max(tally.delivered_t_ulp, error->ulps);
  }
  if (const auto error = off(answer.delivered.point, direction, truth.t)) {
    tally.delivered_point_ulp = std::max(tally.delivered_point_ulp, error->ulps);
  }
}

/// Returns a line of test/regressions.txt: origin, direction and vertices, as hexadecimal floats.
std::string text_of(const glm::dvec3& origin, const glm::dvec3& direction,
                    std::span<const Corners> triangles) {
  std::string text;
  const auto add = [&](const glm::dvec3& v, const char* before) {
    char words[96];
    std::snprintf(words, sizeof words, "%s%a %a %a", before, v.x, v.y, v.z);
    text += words;
  };
  add(origin, "");
  add(direction, "  ");
  for (const Corners& triangle : triangles) {
    for (const glm::dvec3& vertex : triangle) add(vertex, "  ");
  }
  return text;
}

}  // namespace

bool Tally::spotless() const {
  return wrong + wrong_ties + wrong_nearest + wrong_tied_nearest + wrong_order + escapes +
                 double_hits ==
             0 &&
         t_of_bound <= 1.0 && point_of_bound <= 1.0 && point_of_said <= 1.0 &&
         delivered_t_ulp <= kDeliveredUlp && delivered_point_ulp <= kDeliveredUlp;
}

Row Tally::row() const {
  return {{"tests", tests},
          {"rays", rays},
          {"refused", refused},
          {"wrong", wrong},
          {"wrong_ties", wrong_ties},
          {"escapes", escapes},
          {"double_hits", double_hits},
          {"wrong_nearest", wrong_nearest},
          {"wrong_tied_nearest", wrong_tied_nearest},
          {"orders", orders},
          {"wrong_order", wrong_order},
          {"hits", hits},
          {"doubts", doubts},
          {"t_of_bound", t_of_bound},
          {"point_of_bound", point_of_bound},
          {"point_of_said", point_of_said},
          {"delivered_t_ulp", delivered_t_ulp},
          {"delivered_point_ulp", delivered_point_ulp},
          {"failures", failures}};
}

void count(std::span<const Shot> shots, std::span<const Truth> truths, const Answers& answers,
           const SubjectKind& subject, Tally& tally) {
  const auto fails = [&](const Shot& shot, const glm::dvec3& direction,
                         std::span<const Corners> triangles) {
    if (tally.failures.size() == kFailures) return;
    tally.failures.push_back(text_of(shot.origin, direction, triangles));
  };
  std::size_t test = 0, ray_number = 0;
  for (std::size_t s = 0; s < shots.size(); ++s) {
    const Shot& shot = shots[s];
    const Mesh& triangles = *shot.mesh;
    const Truth& truth = truths[s];
    auto verdict = truth.verdicts.begin();
    for (std::size_t ray = 0; ray < shot.directions.size(); ++ray, ++ray_number) {
      const glm::dvec3& direction = shot.directions[ray];
      if (!answers.refused.empty() && answers.refused[ray_number]) {
        ++tally.refused;
        test += triangles.size();
        verdict += static_cast<std::ptrdiff_t>(triangles.size());
        continue;
      }
      std::uint64_t hits = 0, true_hits = 0;
      for (const Corners& triangle : triangles) {
        const Answer& answer = answers.tests[test++];
        const Verdict& exact = *verdict++;
        ++tally.tests;
        tally.doubts += answer.doubt;
        hits += answer.hit;
        true_hits += exact.hit;
        if (answer.hit != exact.hit || (exact.hit && !holds(answer.bounds, exact.t))) {
          ++(exact.tie ? tally.wrong_ties : tally.wrong);
          if (subject.exact || !exact.tie) fails(shot, direction, {&triangle, 1});
        } else if (exact.hit) {
          add_errors(answer, exact, direction, subject.binary32, tally);
        }
      }
      ++tally.rays;
      tally.hits += hits;
      tally.escapes += shot.inside && hits == 0;
      tally.double_hits += shot.inside && hits > true_hits;
      if (!answers.orders.empty()) {
        ++tally.orders;
        if (answers.orders[ray_number] != truth.orders[ray]) {
          ++tally.wrong_order;
          fails(shot, direction, triangles);
        }
      }
      if (answers.nearest[ray_number] != truth.nearest(ray)) {
        const bool tied = truth.nearest_tied[ray];
        ++(tied ? tally.wrong_tied_nearest : tally.wrong_nearest);
        if (subject.exact || !tied) fails(shot, direction, triangles);
      }
    }
  }
}

}  // namespace raygate::lab
