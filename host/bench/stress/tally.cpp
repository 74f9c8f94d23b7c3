#include "host/bench/stress/tally.h"

#include <algorithm>
#include <cmath>

#include "host/hit/polygon_record.h"

namespace raygate::stress {
namespace {

constexpr std::size_t kFailures = 5;

/// The distance of floats near x, in double.
double ulp(double x) { return std::ldexp(1.0, std::max(std::ilogb(x), -126) - 23); }

/// Whether a float can hold x with all its digits.
bool ordinary(double x) { return std::abs(x) >= 0x1p-126 && std::abs(x) < 0x1p127; }

double sine_between(const glm::vec3& direction, const Corners& t) {
  const glm::dvec3 a(t[0]), i(direction);
  const glm::dvec3 u = glm::dvec3(t[1]) - a, v = glm::dvec3(t[2]) - a;
  const glm::dvec3 normal = glm::cross(u / glm::length(u), v / glm::length(v));
  return std::abs(glm::dot(i, normal)) / (glm::length(i) * glm::length(normal));
}

void add_errors(const Answer& answer, const Verdict& truth, const glm::vec3& direction,
                const Corners& triangle, Tally& tally) {
  if (!ordinary(truth.t)) return;
  if (!std::isnan(answer.t)) {
    const double off = std::abs(answer.t - truth.t);
    tally.t_ulp.add(off / ulp(truth.t));
    tally.t_relative.add(off / truth.t);
    const double sine = sine_between(direction, triangle);
    if (sine > 0.0 && sine <= 1.0001) {
      const int decade = std::clamp(static_cast<int>(-std::log10(sine)), 0, Tally::kDecades - 1);
      tally.t_ulp_by_angle[decade].add(off / ulp(truth.t));
      tally.worst_of_bound = std::max(tally.worst_of_bound, off / truth.t / bound_of_t(sine));
    }
  }
  double worst = -1.0;
  for (int k = 0; k < 3; ++k) {
    const double exact = truth.t * direction[k];
    if (std::isnan(answer.point[k]) || !ordinary(exact)) continue;
    worst = std::max(worst, std::abs(answer.point[k] - exact) / ulp(exact));
  }
  if (worst >= 0.0) tally.point_ulp.add(worst);
}

}  // namespace

void Errors::add(double error) {
  ++count_;
  max_ = std::max(max_, error);
  if (sample_.size() < kSample) {
    sample_.push_back(error);
  } else if (const auto place =
                 static_cast<std::size_t>(random_.uniform(0, 1) * static_cast<double>(count_));
             place < kSample) {
    sample_[place] = error;
  }
}

void Errors::add(const Errors& other) {
  // Each suite's sample has equal weight where they do not fit in one.
  sample_.insert(sample_.end(), other.sample_.begin(), other.sample_.end());
  count_ += other.count_;
  max_ = std::max(max_, other.max_);
}

Errors::Summary Errors::summary() const {
  if (sample_.empty()) return {};
  std::vector<double> sample = sample_;
  const auto at = [&](double fraction) {
    const auto place = sample.begin() + static_cast<std::ptrdiff_t>(
                                            fraction * static_cast<double>(sample.size() - 1));
    std::ranges::nth_element(sample, place);
    return *place;
  };
  return {count_, at(0.5), at(0.99), max_};
}

void Tally::add(const Tally& other) {
  tests += other.tests;
  rays += other.rays;
  wrong += other.wrong;
  ties += other.ties;
  wrong_ties += other.wrong_ties;
  leaks += other.leaks;
  escapes += other.escapes;
  double_hits += other.double_hits;
  wrong_nearest += other.wrong_nearest;
  wrong_tied_nearest += other.wrong_tied_nearest;
  hits += other.hits;
  doubts += other.doubts;
  t_ulp.add(other.t_ulp);
  point_ulp.add(other.point_ulp);
  t_relative.add(other.t_relative);
  for (int k = 0; k < kDecades; ++k) t_ulp_by_angle[k].add(other.t_ulp_by_angle[k]);
  worst_of_bound = std::max(worst_of_bound, other.worst_of_bound);
  failures.insert(failures.end(), other.failures.begin(), other.failures.end());
}

double bound_of_t(double sine) {
  const double distance = 0x1p-24 + 0x1p-32, slope = kEdgeBound * std::sqrt(3.0) * 0x1p-24 / sine;
  if (slope >= 1.0) return std::numeric_limits<double>::infinity();
  return (1.0 + distance) / (1.0 - slope) * (1.0 + 0x1p-24) - 1.0;
}

void count(std::span<const Shot> shots, std::span<const Truth> truths, const Answers& answers,
           Tally& tally) {
  std::size_t test = 0, ray_number = 0;
  for (std::size_t s = 0; s < shots.size(); ++s) {
    const Shot& shot = shots[s];
    const auto& triangles = shot.mesh->triangles;
    const Truth& truth = truths[s];
    auto verdict = truth.verdicts.begin();
    for (std::size_t ray = 0; ray < shot.directions.size(); ++ray, ++ray_number) {
      const glm::vec3& direction = shot.directions[ray];
      std::uint64_t hits = 0, true_hits = 0;
      for (const Corners& triangle : triangles) {
        const Answer& answer = answers.tests[test++];
        const Verdict& exact = *verdict++;
        ++tally.tests;
        tally.ties += exact.tie;
        tally.doubts += answer.doubt;
        hits += answer.hit;
        true_hits += exact.hit;
        if (answer.hit != exact.hit) {
          ++(exact.tie ? tally.wrong_ties : tally.wrong);
          if (tally.failures.size() < kFailures) {
            tally.failures.push_back({shot.origin, direction, triangle});
          }
        } else if (exact.hit) {
          add_errors(answer, exact, direction, triangle, tally);
        }
      }
      ++tally.rays;
      tally.hits += hits;
      tally.leaks += shot.inside && hits % 2 == 0;
      tally.escapes += shot.inside && hits == 0;
      tally.double_hits += shot.inside && hits > true_hits;
      if (answers.nearest[ray_number] != truth.nearest[ray]) {
        ++(truth.nearest_tied[ray] ? tally.wrong_tied_nearest : tally.wrong_nearest);
      }
    }
  }
}

}  // namespace raygate::stress
