// require_ieee_floats() refuses arithmetic that would make exact decisions wrong.
#include "host/exact/ieee_floats.h"

#include <gtest/gtest.h>

#include <cfenv>
#include <stdexcept>
#if defined(__SSE__)
#include <immintrin.h>
#endif

namespace raygate {
namespace {

TEST(IeeeFloats, AreWhatWeHave) { EXPECT_NO_THROW(require_ieee_floats()); }

TEST(IeeeFloats, OtherRoundingIsRefused) {
  for (const int mode : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
    std::fesetround(mode);
    EXPECT_THROW(require_ieee_floats(), std::runtime_error);
    std::fesetround(FE_TONEAREST);
  }
}

#if defined(__SSE__)
TEST(IeeeFloats, FlushedSubnormalsAreRefused) {
  const unsigned before = _mm_getcsr();
  for (const unsigned flag : {0x8000u /* FTZ */, 0x0040u /* DAZ */}) {
    _mm_setcsr(before | flag);
    EXPECT_THROW(require_ieee_floats(), std::runtime_error);
    _mm_setcsr(before);
  }
}
#endif

}  // namespace
}  // namespace raygate
