// The tests that every float core goes through in every format.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "sim/test/fp/core_check.h"

namespace raygate {

/// One test of a format; its name for test lists.
class FormatTest : public testing::TestWithParam<FloatFormat> {
 protected:
  /// `op` on all pairs of the 8-bit format, on crossed edges and a million pairs of the others, in
  /// all modes, against the oracle.
  void run(FloatOp op) {
    const auto cores = rtl_float_cores(GetParam());
    ASSERT_NE(cores, nullptr);
    CoreCheck check(*cores, op);
    if (GetParam() == kFloat8) {
      check.exhaustive();
    } else {
      check.structured(1'000'000, test_seed());
    }
    expect_clean(check);
  }

  static void expect_clean(const CoreCheck& check) {
    EXPECT_GT(check.cases(), 0u);
    EXPECT_EQ(check.differences(), 0u) << check.report();
    std::printf("%llu cases\n", static_cast<unsigned long long>(check.cases()));
  }
};

inline const auto kAllFormats = testing::Values(kBinary32, kBinary16, kBfloat16, kFloat8);

inline std::string format_name(const testing::TestParamInfo<FloatFormat>& info) {
  if (info.param == kBinary32) return "binary32";
  if (info.param == kBinary16) return "binary16";
  return info.param == kBfloat16 ? "bfloat16" : "float8";
}

}  // namespace raygate
