// Float arithmetic as cheaper hardware would do it, bit for bit.
#pragma once

#include <glm/glm.hpp>

namespace raygate::stress {

/// Binary floats with float32's exponents, and fewer digits or corners cut. Every operation gives
/// the exact result, rounded once, as IEEE 754 defines it but for what the fields say.
struct Arithmetic {
  int digits = 24;          ///< of a significand, the leading one counted; at most 24
  bool truncate = false;    ///< towards zero in place of to nearest even
  bool flush = false;       ///< subnormals, read or made, are zeros
  int quotient_digits = 0;  ///< not 0: quotients are cut off after so many digits

  /// A float taken into this format.
  [[nodiscard]] float read(float x) const;
  [[nodiscard]] glm::vec3 read(const glm::vec3& v) const {
    return {read(v.x), read(v.y), read(v.z)};
  }
  [[nodiscard]] float multiply(float a, float b) const;
  [[nodiscard]] float add(float a, float b) const;
  [[nodiscard]] float divide(float a, float b) const;
  /// (ax bx + ay by) + az bz.
  [[nodiscard]] float dot(const glm::vec3& a, const glm::vec3& b) const;

 private:
  [[nodiscard]] float fit(double value, double rest, int digits, bool truncate) const;
};

}  // namespace raygate::stress
