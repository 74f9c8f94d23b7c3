#include "host/lab/stress/errors.h"

#include <algorithm>
#include <bit>
#include <limits>

// The unit's t and P
//
// Let u = 2^-24, N and D the exact normal and plane distance, n and d the record's floats, V the
// float result of I . n. |.| of a vector is its length, |.|_1 the sum of its magnitudes.
//
// 1. Words. triangle_normal guarantees a double within 2^-34 |N|_1 of each component, to first
//    order, and |N|_1 <= sqrt(3) |N|; then each is rounded to float, by u times itself. (A word
//    that becomes subnormal adds 2^-150, which is negligible next to a largest one of at least
//    2^-60.)
//      |I . n - I . N| <= u sum |I_k N_k| (1 + 2^-9) + 2^-34 sqrt(3) |N| |I|_1
//    By Cauchy and Schwarz, sum |I_k N_k| <= |I| |N|, and |I|_1 <= sqrt(3) |I|:
//      <= (1 + 2^-9 + 3 * 2^-10) u |I| |N|.
//    plane_distance is within 2^-32 of D, and is rounded once: |d - D| <= (1 + 2^-7) u |D|.
// 2. The dot product. Each product takes part in at most three roundings:
//      |V - I . n| <= 3.00001 u sum |I_k n_k| <= (3 + 2^-9) u |I| |N|.
// 3. |I . N| = sine |I| |N|. So the relative error of V is at most r = (4 + 2^-6) u / sine.
// 4. The division rounds once, and so does the product d I_k that precedes it in P. I is a float
//    and exact.

namespace raygate::lab {
namespace {

// A bin contains the doubles with the same sign, exponent and first six fraction bits. The first
// bin ends at 2^-64 and contains 0; the last one begins at 2^64.
constexpr int kShift = 52 - 6;
constexpr std::uint64_t kFirst = std::bit_cast<std::uint64_t>(0x1p-64) >> kShift;
constexpr std::size_t kBins = (std::bit_cast<std::uint64_t>(0x1p64) >> kShift) - kFirst + 2;

std::size_t bin_of(double error) {
  const std::uint64_t place = std::bit_cast<std::uint64_t>(error) >> kShift;
  return place < kFirst ? 0 : std::min<std::size_t>(place - kFirst + 1, kBins - 1);
}

constexpr double kU = 0x1p-24;

double bound(double sine, int roundings) {
  const double slope = (4.0 + 0x1p-6) * kU / sine;
  if (!(slope < 1.0)) return std::numeric_limits<double>::infinity();
  double factor = (1.0 + (1.0 + 0x1p-7) * kU) / (1.0 - slope);
  for (int i = 0; i < roundings; ++i) factor *= 1.0 + kU;
  return factor - 1.0;
}

}  // namespace

double bound_of_t(double sine) { return bound(sine, 1); }
double bound_of_point(double sine) { return bound(sine, 2); }

void Errors::add(double error) {
  bins_.resize(kBins);
  ++bins_[bin_of(error)];
  max_ = std::max(max_, error);
}

std::vector<std::pair<double, std::uint64_t>> Errors::bins() const {
  std::vector<std::pair<double, std::uint64_t>> filled;
  for (std::size_t bin = 0; bin < bins_.size(); ++bin) {
    if (bins_[bin] == 0) continue;
    filled.emplace_back(std::bit_cast<double>((kFirst + bin) << kShift), bins_[bin]);
  }
  return filled;
}

}  // namespace raygate::lab
