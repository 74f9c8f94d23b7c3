#include "host/lab/stress/errors.h"

#include <algorithm>
#include <bit>
#include <limits>

// The unit's t and P
//
// Let u = 2^-24, N and D the exact normal and plane distance, n and d the record's floats, V the
// float result of I . n. |.| of a vector is its length, |.|_1 the sum of its magnitudes.
//
// 1. Words. triangle_normal promises a double within 2^-34 |N|_1, to the first order, of each
//    component, and |N|_1 <= sqrt(3) |N|; then each is rounded to float, by u of itself. (A word
//    that becomes subnormal adds 2^-150, next to a largest one of 2^-60 or more: nothing.)
//      |I . n - I . N| <= u sum |I_k N_k| (1 + 2^-9) + 2^-34 sqrt(3) |N| |I|_1
//    By Cauchy and Schwarz, sum |I_k N_k| <= |I| |N|, and |I|_1 <= sqrt(3) |I|:
//                      <= (1 + 2^-9 + 3 * 2^-10) u |I| |N|.
//    plane_distance is within 2^-32 of D, and is rounded once: |d - D| <= (1 + 2^-7) u |D|.
// 2. The dot product. Each product takes part in three roundings at most:
//      |V - I . n| <= 3.00001 u sum |I_k n_k| <= (3 + 2^-9) u |I| |N|.
// 3. |I . N| = sine |I| |N|. So V is off by r = (4 + 2^-6) u / sine of the exact I . N, at most.
// 4. The division rounds once, and so does the product d I_k that P has before it. I is taken as
//    it is: a float.

namespace raygate::lab {
namespace {

// A bin holds the doubles that agree in sign, exponent and six bits of the fraction. The first one
// ends with 2^-64 and holds 0, the last one begins with 2^64.
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

double in_ulp(double relative) { return relative * 0x1p24; }

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
