// Random numbers for generators: the same on every machine for the same seed.
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <random>

namespace raygate::lab {

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53;
  }
  /// Returns a number whose logarithm is uniformly distributed.
  double log_uniform(double low, double high) {
    return std::exp(uniform(std::log(low), std::log(high)));
  }
  int below(int n) { return static_cast<int>(engine_() % static_cast<std::uint64_t>(n)); }
  bool one_in(int n) { return below(n) == 0; }
  double sign() { return one_in(2) ? 1.0 : -1.0; }
  /// Returns a point in the cube from -1 to 1.
  glm::dvec3 point() {
    const double x = uniform(-1, 1), y = uniform(-1, 1), z = uniform(-1, 1);
    return {x, y, z};
  }
  glm::dvec3 unit() {
    for (;;) {
      const glm::dvec3 p = point();
      const double square = glm::dot(p, p);
      if (square > 0.01 && square < 1.0) return p / std::sqrt(square);
    }
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace raygate::lab
