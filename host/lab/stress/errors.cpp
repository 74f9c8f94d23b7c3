#include "host/lab/stress/errors.h"

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

}  // namespace raygate::lab
