// Multiplies every pair of operands in the Verilated booth_multiplier of WIDTH bits.
#include <cstdint>
#include <cstdio>

#include "Vbooth_multiplier.h"
#include "verilated.h"

int main() {
  constexpr std::uint64_t kEnd = 1ULL << WIDTH;
  VerilatedContext context;
  Vbooth_multiplier multiplier(&context);
  std::uint64_t tried = 0;
  for (std::uint64_t a = 0; a < kEnd; ++a) {
    multiplier.a_i = a;
    for (std::uint64_t b = 0; b < kEnd; ++b) {
      multiplier.b_i = b;
      multiplier.eval();
      ++tried;
      if (multiplier.product_o != a * b) {
        std::printf("%llu * %llu gave %llu\n", static_cast<unsigned long long>(a),
                    static_cast<unsigned long long>(b),
                    static_cast<unsigned long long>(multiplier.product_o));
        return 1;
      }
    }
  }
  std::printf("%llu products\n", static_cast<unsigned long long>(tried));
  return tried == kEnd * kEnd ? 0 : 1;
}
