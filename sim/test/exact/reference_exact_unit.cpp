#include "sim/test/exact/reference_exact_unit.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <initializer_list>
#include <vector>

namespace raygate {
namespace {

using Wide = __int128;

// Clocks from the request to the first step, and from a step to the clock with the step's sum.
constexpr int kFirstStep = 5, kSeen = 4;

/// A binary32 number, significand * 2^(exponent - 150).
struct Fields {
  bool negative;
  int exponent;
  std::uint32_t significand;

  explicit Fields(float x) {
    const auto word = std::bit_cast<std::uint32_t>(x);
    const std::uint32_t field = word >> 23 & 0xFF;
    negative = word >> 31 != 0;
    exponent = static_cast<int>(field == 0 ? 1 : field);
    significand = (word & 0x7FFFFF) | (field == 0 ? 0 : 0x800000);
  }
};

/// The smallest and the largest biased exponent of nonzero numbers.
struct Range {
  int low = 255, high = 0;

  void add(const glm::vec3& v) {
    for (int k = 0; k < 3; ++k) {
      if (v[k] == 0.0f) continue;
      low = std::min(low, Fields(v[k]).exponent);
      high = std::max(high, Fields(v[k]).exponent);
    }
  }
};

/// Balanced digits of a number, least significant first.
using Number = std::vector<std::int64_t>;
using Vector = std::array<Number, 3>;

/// The product x y, or -x y if `negate`.
struct Term {
  const Number& x;
  const Number& y;
  bool negate = false;
};

int sign_of(const Number& number) {
  for (std::size_t k = number.size(); k-- > 0;) {
    if (number[k] != 0) return number[k] > 0 ? 1 : -1;
  }
  return 0;
}

class Machine {
 public:
  explicit Machine(const ExactRequest& request, int width)
      : request_(request),
        width_(width),
        sure_bit_(width - 1 + std::bit_width(products(width) - 1u)) {
    Range coordinates, direction;
    coordinates.add(request.ray.origin);
    for (const glm::vec3& corner : request.triangle) coordinates.add(corner);
    if (request.against == ExactRequest::Against::kOther) {
      for (const glm::vec3& corner : request.other) coordinates.add(corner);
    }
    if (coordinates.high == 0) coordinates.low = coordinates.high = 1;
    direction.add(request.ray.direction);
    unit_ = coordinates.low;
    direction_unit_ = direction.low;
    digits_ = count(coordinates.high - coordinates.low);
    direction_digits_ = count(direction.high - direction.low);
  }

  ExactAnswer run() {
    using Against = ExactRequest::Against;
    const glm::vec3& o = request_.ray.origin;
    const FloatCorners& t = request_.triangle;
    if (request_.asks_hit) {
      const bool hit = hits();
      if (!hit || request_.against == Against::kNothing) return {hit, 0, answer_};
    }
    Number distance, slope, other_distance, other_slope;
    const Vector b = difference(t[1], t[0]), c = difference(t[2], t[0]);
    a_ = difference(t[0], o);
    direction_ = load_direction();
    const auto fraction = static_cast<std::size_t>(fraction_digits());
    if (request_.against == Against::kLimit) {
      load_limit(other_distance, other_slope);
      const Vector normal = cross(b, c);
      distance = dot(a_, normal, fraction);
      slope = dot(direction_, normal, fraction);
    } else {
      const Vector normal = cross(b, c);
      const Vector other_b = difference(request_.other[1], request_.other[0]);
      const Vector other_c = difference(request_.other[2], request_.other[0]);
      distance = dot(a_, normal, fraction);
      const Vector other_normal = cross(other_b, other_c);
      const Vector other_a = difference(request_.other[0], o);
      slope = dot(direction_, normal, fraction);
      other_distance = dot(other_a, other_normal, fraction);
      other_slope = dot(direction_, other_normal, fraction);
    }
    fence();
    const int order = sign({{distance, other_slope}, {slope, other_distance, true}});
    return {true, order * sign_of(distance) * sign_of(other_distance), answer_};
  }

 private:
  /// Returns the maximum number of products in a column.
  static unsigned products(int width) { return static_cast<unsigned>(6 * count(253, width)); }
  static int count(int spread, int width) { return (spread + 27 + width - 1) / width; }
  [[nodiscard]] int count(int spread) const { return count(spread, width_); }
  [[nodiscard]] int fraction_digits() const {
    return 2 * digits_ + std::max(digits_, direction_digits_);
  }

  bool hits() {
    const glm::vec3& o = request_.ray.origin;
    const FloatCorners& t = request_.triangle;
    const Vector b = difference(t[1], o), c = difference(t[2], o);
    a_ = difference(t[0], o);
    direction_ = load_direction();
    const Vector bc = cross(b, c), ca = cross(c, a_);
    const int plane = side(a_, bc);
    if (plane == 0 || edge(bc) != plane) return false;
    const Vector ab = cross(a_, b);
    return edge(ca) == plane && edge(ab) == plane;
  }

  int side(const Vector& x, const Vector& y) {
    return sign({{x[0], y[0]}, {x[1], y[1]}, {x[2], y[2]}});
  }
  int edge(const Vector& normal) {
    int found = side(direction_, normal);
    for (int k = 0; k < 3 && found == 0; ++k) found = sign_of(normal[static_cast<std::size_t>(k)]);
    return found;
  }

  /// Removes the lowest digit, balanced, from a sum, and returns the digit.
  std::int64_t take_digit(Wide& sum) const {
    const Wide half = Wide{1} << (width_ - 1);
    const Wide digit = ((sum + half) & (2 * half - 1)) - half;
    sum = (sum - digit) >> width_;
    return static_cast<std::int64_t>(digit);
  }

  /// Returns digit k of significand * 2^shift.
  [[nodiscard]] Wide slice(std::uint32_t significand, int shift, int k) const {
    const int by = shift - width_ * k;
    if (by >= width_ || by <= -24) return 0;
    return by < 0 ? Wide{significand} >> -by
                  : (Wide{significand} << by) & ((Wide{1} << width_) - 1);
  }

  /// Returns x - y, in units of 2^(unit - 150), one digit per clock.
  Number difference(float x, float y, int unit, int digits) {
    const Fields a(x), b(y);
    Number number;
    Wide sum = 0;
    for (int k = 0; k < digits; ++k) {
      const Wide from = slice(a.significand, a.exponent - unit, k);
      const Wide other = slice(b.significand, b.exponent - unit, k);
      sum += (a.negative ? -from : from) - (b.negative ? -other : other);
      number.push_back(take_digit(sum));
      ++clock_;
    }
    return number;
  }
  Vector difference(const glm::vec3& x, const glm::vec3& y) {
    Vector vector;
    for (int k = 0; k < 3; ++k) {
      vector[static_cast<std::size_t>(k)] = difference(x[k], y[k], unit_, digits_);
    }
    return vector;
  }
  Vector load_direction() {
    Vector vector;
    for (int k = 0; k < 3; ++k) {
      vector[static_cast<std::size_t>(k)] =
          difference(request_.ray.direction[k], 0.0f, direction_unit_, direction_digits_);
    }
    return vector;
  }
  /// Loads the request's limit as a fraction limit / one, in t's unit 2^(unit_ - direction_unit_).
  /// t = D / S is then compared with the limit by comparing D * one with S * limit.
  void load_limit(Number& limit, Number& one) {
    const Fields fields(request_.limit);
    const int gap = unit_ - (fields.exponent + direction_unit_ - 150);
    const int digits = count(gap < 0 ? -gap : std::max(gap - 23, 0));
    const auto load = [&](std::uint32_t significand, int shift) {
      Number number;
      Wide sum = 0;
      for (int k = 0; k < digits; ++k) {
        sum += slice(significand, shift, k);
        number.push_back(take_digit(sum));
        ++clock_;
      }
      return number;
    };
    limit = load(fields.significand, std::max(-gap, 0));
    one = load(1, std::max(gap, 0));
  }

  /// Returns the sum of a column's products. Takes one clock per product, at least one.
  Wide column(std::initializer_list<Term> terms, int k) {
    const int x = static_cast<int>(terms.begin()->x.size());
    const int y = static_cast<int>(terms.begin()->y.size());
    Wide sum = 0;
    int clocks = 0;
    for (int i = std::max(0, k - y + 1); i <= std::min(x - 1, k); ++i) {
      for (const Term& term : terms) {
        const Wide product = Wide{term.x[static_cast<std::size_t>(i)]} *
                             Wide{term.y[static_cast<std::size_t>(k - i)]};
        sum += term.negate ? -product : product;
        ++clocks;
      }
    }
    clock_ += std::max(clocks, 1);
    return sum;
  }

  Number sum(std::initializer_list<Term> terms, std::size_t digits) {
    Number number;
    Wide left = 0;
    for (std::size_t k = 0; k < digits; ++k) {
      left += column(terms, static_cast<int>(k));
      number.push_back(take_digit(left));
    }
    return number;
  }
  Number dot(const Vector& x, const Vector& y, std::size_t digits) {
    return sum({{x[0], y[0]}, {x[1], y[1]}, {x[2], y[2]}}, digits);
  }
  Vector cross(const Vector& x, const Vector& y) {
    const auto component = [&](std::size_t j, std::size_t k) {
      return sum({{x[j], y[k]}, {x[k], y[j], true}}, 2 * x[0].size());
    };
    return {component(1, 2), component(2, 0), component(0, 1)};
  }

  /// Returns the sign of the sum of terms. Adds columns from the highest until the sign is known.
  int sign(std::initializer_list<Term> terms) {
    const auto top = static_cast<int>(terms.begin()->x.size() + terms.begin()->y.size()) - 2;
    const Wide sure = Wide{1} << sure_bit_;
    Wide sum = 0;
    bool known = false;
    for (int k = top; k >= 0; --k) {
      // The sign has become known, and the next instruction follows.
      if (known && clock_ > answer_ - 1) break;
      const Wide more = column(terms, k);
      if (known) continue;
      sum = (sum << width_) + more;
      known = k == 0 || sum >= sure || sum < -sure;
      if (known) answer_ = clock_ - 1 + kSeen + 1;
    }
    // Steps issued before the sign became known still take their clocks.
    clock_ = std::min(clock_, answer_);
    return (sum > 0) - (sum < 0);
  }

  /// Waits until all numbers are written.
  void fence() { clock_ += kSeen; }

  const ExactRequest& request_;
  int width_, sure_bit_, unit_, direction_unit_, digits_, direction_digits_;
  int clock_ = kFirstStep;  // clock of the next step
  int answer_ = 0;          // clock after the last sign was known
  Vector a_, direction_;
};

}  // namespace

ExactAnswer decide(const ExactRequest& request, int width) { return Machine(request, width).run(); }

}  // namespace raygate
