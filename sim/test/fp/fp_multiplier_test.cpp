#include "sim/test/fp/format_test.h"

namespace raygate {
namespace {

using FpMultiplier = FormatTest;

TEST_P(FpMultiplier, Mul) { run(FloatOp::kMul); }

INSTANTIATE_TEST_SUITE_P(Formats, FpMultiplier, kAllFormats, format_name);

}  // namespace
}  // namespace raygate
