#include "host/lab/stress/oracle.h"

#include <gmpxx.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace raygate::lab {
namespace {

using Wide = __int128;

template <class Int>
struct Vector {
  Int x, y, z;
};

template <class Int>
Vector<Int> operator-(const Vector<Int>& a, const Vector<Int>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

template <class Int>
Vector<Int> cross(const Vector<Int>& a, const Vector<Int>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

template <class Int>
Int dot(const Vector<Int>& a, const Vector<Int>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

int sign(const Wide& x) { return (x > 0) - (x < 0); }
int sign(const mpz_class& x) { return sgn(x); }

double magnitude(const Wide& x) { return std::abs(static_cast<double>(x)); }

mpz_class big(const mpz_class& x) { return x; }
mpz_class big(const Wide& x) {
  const bool negative = x < 0;
  const auto bits =
      negative ? -static_cast<unsigned __int128>(x) : static_cast<unsigned __int128>(x);
  mpz_class result = static_cast<unsigned long>(bits >> 64);
  result <<= 64;
  result += static_cast<unsigned long>(bits);
  return negative ? mpz_class(-result) : result;
}

/// The range of powers of two of a set of floats.
struct Span {
  int low = 200, high = -200;  // all are multiples of 2^low and below 2^high

  void add(float x) {
    if (x == 0.0f) return;
    int exponent;
    const auto significand = static_cast<long>(std::ldexp(std::frexp(x, &exponent), 24));
    high = std::max(high, exponent);
    low = std::min(low, exponent - 24 + __builtin_ctzl(static_cast<unsigned long>(significand)));
  }
  void add(const glm::vec3& v) {
    for (int k = 0; k < 3; ++k) add(v[k]);
  }
  [[nodiscard]] int bits() const { return std::max(high - low, 1); }
};

template <class Int>
Int whole(float x, int low) {
  if (x == 0.0f) return 0;
  int exponent;
  const auto significand = static_cast<long>(std::ldexp(std::frexp(x, &exponent), 24));
  const int shift = exponent - 24 - low;
  Int result = significand;
  if (shift >= 0) {
    result <<= shift;
  } else {
    result >>= -shift;  // drops only zero bits
  }
  return result;
}

template <class Int>
Vector<Int> whole(const glm::vec3& v, int low) {
  return {whole<Int>(v.x, low), whole<Int>(v.y, low), whole<Int>(v.z, low)};
}

/// t = distance / slope, in units of 2^(coordinates' low - directions' low).
template <class Int>
struct Depth {
  Int distance, slope;
};

/// value * 2^exponent, which may exceed the range of double.
struct Scaled {
  double value;
  long exponent;
};

Scaled scaled(const Wide& x) { return {magnitude(x), 0}; }
Scaled scaled(const mpz_class& x) {
  Scaled result{};
  result.value = std::abs(mpz_get_d_2exp(&result.exponent, x.get_mpz_t()));
  return result;
}

double quotient(const Scaled& above, const Scaled& below) {
  return std::ldexp(above.value / below.value, static_cast<int>(above.exponent - below.exponent));
}

template <class Int>
double quotient(const Depth<Int>& depth) {
  return quotient(scaled(depth.distance), scaled(depth.slope));
}

template <class Int>
Scaled length(const Vector<Int>& v) {
  const Scaled parts[] = {scaled(v.x), scaled(v.y), scaled(v.z)};
  Scaled result{0.0, std::numeric_limits<long>::min()};
  for (const Scaled& part : parts) {
    if (part.value != 0.0) result.exponent = std::max(result.exponent, part.exponent);
  }
  for (const Scaled& part : parts) {
    if (part.value == 0.0) continue;
    const double value =
        std::ldexp(part.value, static_cast<int>(std::max(part.exponent - result.exponent, -999L)));
    result.value += value * value;
  }
  result.value = std::sqrt(result.value);
  return result;
}

template <class Int>
int compare(const Depth<Int>& a, const Depth<Int>& b) {
  const double first = quotient(a), second = quotient(b);
  if (std::abs(first - second) > 0x1p-48 * first) return first < second ? -1 : 1;
  return cmp(abs(big(a.distance) * big(b.slope)), abs(big(b.distance) * big(a.slope)));
}

bool usable(const glm::vec3& direction) {
  return direction != glm::vec3(0.0f) && std::isfinite(direction.x) && std::isfinite(direction.y) &&
         std::isfinite(direction.z);
}

/// Values that do not depend on the ray.
template <class Int>
struct Target {
  Vector<Int> normal, edges[3];
  Int distance;

  Target(const Vector<Int>& origin, const Corners& corners, int low) {
    Vector<Int> v[3];
    for (int k = 0; k < 3; ++k) v[k] = whole<Int>(corners[k], low) - origin;
    for (int k = 0; k < 3; ++k) edges[k] = cross(v[k], v[(k + 1) % 3]);
    normal = cross(Vector<Int>(v[1] - v[0]), Vector<Int>(v[2] - v[0]));
    distance = dot(v[0], edges[1]);
  }
};

template <class Int>
Verdict decide(const Target<Int>& target, const Vector<Int>& direction) {
  Verdict verdict;
  const int side = sign(target.distance);
  verdict.hit = side != 0;
  for (const Vector<Int>& edge : target.edges) {
    int edge_side = sign(dot(direction, edge));
    if (edge_side == 0) {
      verdict.tie = true;
      for (const Int* part : {&edge.x, &edge.y, &edge.z}) {
        if (edge_side == 0) edge_side = sign(*part);
      }
    }
    if (edge_side != side) verdict.hit = false;
  }
  return verdict;
}

template <class Int>
Truth find(const Shot& shot, int low, int direction_low) {
  Truth truth;
  truth.verdicts.reserve(shot.tests());
  std::vector<Target<Int>> targets;
  targets.reserve(shot.mesh->triangles.size());
  std::vector<Depth<Int>> depths;  // depths of the ray's hits so far, in order
  const Vector<Int> origin = whole<Int>(shot.origin, low);
  for (const Corners& corners : shot.mesh->triangles) targets.emplace_back(origin, corners, low);
  for (const glm::vec3& ray : shot.directions) {
    std::vector<std::uint32_t>& order = truth.orders.emplace_back();
    bool tied = false;
    if (!usable(ray)) {
      truth.verdicts.resize(truth.verdicts.size() + targets.size());
      truth.nearest_tied.push_back(tied);
      continue;
    }
    const Vector<Int> direction = whole<Int>(ray, direction_low);
    const Scaled direction_length = length(direction);
    depths.clear();
    for (std::uint32_t i = 0; i < targets.size(); ++i) {
      Verdict verdict = decide(targets[i], direction);
      tied = tied || verdict.tie;
      if (verdict.hit) {
        const Depth<Int> depth{targets[i].distance, dot(direction, targets[i].normal)};
        verdict.t = std::ldexp(quotient(depth), low - direction_low);
        const Scaled normal = length(targets[i].normal);
        verdict.sine = quotient(scaled(depth.slope), {normal.value * direction_length.value,
                                                      normal.exponent + direction_length.exponent});
        // Hits at equal distance that are already in the list have lower indices.
        std::size_t place = order.size();
        for (; place > 0; --place) {
          const int before = compare(depth, depths[place - 1]);
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

}  // namespace

Truth find_truth(const Shot& shot) {
  Span coordinates, directions;
  coordinates.add(shot.origin);
  for (const Corners& corners : shot.mesh->triangles) {
    for (const glm::vec3& vertex : corners) coordinates.add(vertex);
  }
  for (const glm::vec3& direction : shot.directions) {
    if (usable(direction)) directions.add(direction);
  }
  // A difference has one more bit, the sum of n products n - 1 more.
  const int normal_bits = 2 * (coordinates.bits() + 2) + 1;
  const bool fits =
      normal_bits + coordinates.bits() + 1 + 2 <= 126 && normal_bits + directions.bits() + 2 <= 126;
  return fits ? find<Wide>(shot, coordinates.low, directions.low)
              : find<mpz_class>(shot, coordinates.low, directions.low);
}

}  // namespace raygate::lab
