// Requests for the exact unit, from the stress suites and from random bits, with their results by
// host/exact, checked against integers.
#pragma once

#include <cmath>
#include <vector>

#include "host/lab/stress/cases.h"
#include "sim/test/exact/reference_exact_unit.h"

namespace raygate::lab {

struct ExactCase {
  ExactRequest request;
  bool hit = false;
  int order = 0;
};

/// Returns a request with its results by host/exact.
inline ExactCase case_of(const ExactRequest& request) {
  using Against = ExactRequest::Against;
  const bool hit = !request.asks_hit || hits_triangle(request.ray, widened(request.triangle));
  int order = 0;
  if (hit && request.against == Against::kLimit) {
    order = compare_hit_to_limit(request.ray, widened(request.triangle), request.limit);
  } else if (hit && request.against == Against::kOther) {
    order = compare_hits(request.ray, widened(request.triangle), widened(request.other));
  }
  return {request, hit, order};
}

/// Makes cases from the shots of a suite in binary32. Up to three hits of a ray are compared with a
/// limit near the hit's t and with the next hit (or the same triangle, rotated). Random triangles
/// are tested for a hit. Each ray also adds a case of random numbers, whose exponents have the
/// whole range of float or span only 12.
class ExactCases {
 public:
  ExactCases(const Suite& suite, std::uint64_t seed) : generate_(suite.make()), random_(seed) {}

  /// Returns the next shot's cases. Throws std::logic_error if host/exact and find_truth differ.
  std::vector<ExactCase> next() {
    using Against = ExactRequest::Against;
    std::vector<ExactCase> cases;
    const Shot shot = generate_(random_);
    const Mesh& triangles = *shot.mesh;
    const Truth truth = find_truth(shot);
    for (std::size_t i = 0; i < shot.directions.size(); ++i) {
      if (!is_usable(shot.directions[i])) continue;
      ExactRequest request{.ray = {glm::vec3(shot.origin), glm::vec3(shot.directions[i])}};
      const auto& order = truth.orders[i];
      for (std::size_t k = 0; k < order.size() && k < 3; ++k) {
        const Verdict& verdict = truth.verdicts[i * triangles.size() + order[k]];
        request.triangle = rounded(triangles[order[k]]);
        request.asks_hit = random_.one_in(2);
        request.against = Against::kLimit;
        request.limit = static_cast<float>(verdict.t);
        if (random_.one_in(2)) request.limit = std::nextafter(request.limit, 2.0f * request.limit);
        if (random_.one_in(8)) request.limit *= 2.0f;
        if (request.limit > 0.0f && std::isfinite(request.limit)) add(cases, request, true);
        request.against = Against::kOther;
        request.other = {request.triangle[1], request.triangle[2], request.triangle[0]};
        if (k + 1 < order.size()) request.other = rounded(triangles[order[k + 1]]);
        add(cases, request, true);
        if (k + 1 < order.size() && cases.back().order > 0) differ();
      }
      for (int n = 0; n < 2; ++n) {
        const auto k = static_cast<std::size_t>(random_.below(static_cast<int>(triangles.size())));
        request.triangle = rounded(triangles[k]);
        request.asks_hit = true;
        request.against = Against::kNothing;
        add(cases, request, truth.verdicts[i * triangles.size() + k].hit);
      }
      add_bits(cases);
    }
    return cases;
  }

 private:
  [[noreturn]] static void differ() { throw std::logic_error("host/exact differs from integers"); }

  static void add(std::vector<ExactCase>& cases, const ExactRequest& request, bool hit) {
    cases.push_back(case_of(request));
    if (cases.back().hit != hit) differ();
  }

  void add_bits(std::vector<ExactCase>& cases) {
    const int span = random_.one_in(2) ? 276 : 12, least = random_.below(277 - span) - 149;
    const auto any = [&] {
      return static_cast<float>(std::ldexp(random_.uniform(-1, 1), least + random_.below(span)));
    };
    const auto point = [&] { return glm::vec3(any(), any(), any()); };
    ExactRequest request{.ray = {point(), point()}};
    if (!is_usable(request.ray.direction)) return;
    request.triangle = {point(), point(), point()};
    request.other = {point(), point(), point()};
    request.asks_hit = random_.one_in(2);
    request.against =
        request.asks_hit ? ExactRequest::Against::kNothing : ExactRequest::Against::kOther;
    cases.push_back(case_of(request));
  }

  Generator generate_;
  Random random_;
};

}  // namespace raygate::lab
