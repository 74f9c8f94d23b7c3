#include <gmpxx.h>

#include <cmath>

#include "host/lab/stress/cases.h"

namespace raygate::lab {
namespace {

/// A vector of integers, in units of 2^-149. Every coordinate is a multiple of this unit.
struct Vector {
  mpz_class x, y, z;
};

Vector whole(const glm::dvec3& v) {
  const auto units = [](double x) { return mpz_class(std::ldexp(x, 149)); };
  return {units(v.x), units(v.y), units(v.z)};
}

Vector operator-(const Vector& a, const Vector& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }

Vector cross(const Vector& a, const Vector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

mpz_class dot(const Vector& a, const Vector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

/// Returns a / b, also for numbers beyond the range of double.
double quotient(const mpf_class& a, const mpf_class& b) { return mpf_class(a / b).get_d(); }

mpf_class length(const Vector& v) { return sqrt(mpf_class(dot(v, v), 128)); }

bool usable(const glm::dvec3& direction) {
  return direction != glm::dvec3(0.0) && std::isfinite(direction.x) && std::isfinite(direction.y) &&
         std::isfinite(direction.z);
}

/// A triangle, with the values that do not depend on the ray.
struct Target {
  Vector normal, edges[3];
  mpz_class distance;
  mpf_class normal_length;

  Target(const Vector& origin, const Corners& corners) {
    const Vector a = whole(corners[0]) - origin, b = whole(corners[1]) - origin,
                 c = whole(corners[2]) - origin;
    edges[0] = cross(a, b), edges[1] = cross(b, c), edges[2] = cross(c, a);
    normal = cross(b - a, c - a);
    distance = dot(a, edges[1]);
    normal_length = length(normal);
  }
};

Verdict decide(const Target& target, const Vector& direction) {
  Verdict verdict;
  const int side = sgn(target.distance);
  verdict.hit = side != 0;
  for (const Vector& edge : target.edges) {
    int edge_side = sgn(dot(direction, edge));
    if (edge_side == 0) {
      verdict.tie = true;
      for (const mpz_class* part : {&edge.x, &edge.y, &edge.z}) {
        if (edge_side == 0) edge_side = sgn(*part);
      }
    }
    if (edge_side != side) verdict.hit = false;
  }
  return verdict;
}

}  // namespace

Truth find_truth(const Shot& shot) {
  Truth truth;
  std::vector<Target> targets;
  const Vector origin = whole(shot.origin);
  for (const Corners& corners : *shot.mesh) targets.emplace_back(origin, corners);
  for (const glm::dvec3& ray : shot.directions) {
    std::vector<std::uint32_t>& order = truth.orders.emplace_back();
    bool tied = false;
    if (!usable(ray)) {
      truth.verdicts.resize(truth.verdicts.size() + targets.size());
      truth.nearest_tied.push_back(tied);
      continue;
    }
    const Vector direction = whole(ray);
    const mpf_class direction_length = length(direction);
    struct Depth {
      mpz_class distance, slope;  // t = distance / slope, both positive
    };
    std::vector<Depth> depths;  // of the ray's hits so far, in order
    for (std::uint32_t i = 0; i < targets.size(); ++i) {
      Verdict verdict = decide(targets[i], direction);
      tied = tied || verdict.tie;
      if (verdict.hit) {
        const Depth depth{abs(targets[i].distance), abs(dot(direction, targets[i].normal))};
        verdict.t = quotient(mpf_class(depth.distance), mpf_class(depth.slope));
        verdict.sine =
            quotient(mpf_class(depth.slope), targets[i].normal_length * direction_length);
        // Hits at equal distance that are already in the list have lower indices.
        std::size_t place = order.size();
        for (; place > 0; --place) {
          const Depth& other = depths[place - 1];
          const int before = sgn(depth.distance * other.slope - other.distance * depth.slope);
          tied = tied || before == 0;
          if (before >= 0) break;
        }
        order.insert(order.begin() + static_cast<std::ptrdiff_t>(place), i);
        depths.insert(depths.begin() + static_cast<std::ptrdiff_t>(place), depth);
      }
      truth.verdicts.push_back(verdict);
    }
    truth.nearest_tied.push_back(tied);
  }
  return truth;
}

}  // namespace raygate::lab
