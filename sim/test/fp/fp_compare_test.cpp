#include "sim/test/fp/format_test.h"

namespace raygate {
namespace {

using FpCompare = FormatTest;

TEST_P(FpCompare, Eq) { run(FloatOp::kEq); }
TEST_P(FpCompare, Lt) { run(FloatOp::kLt); }
TEST_P(FpCompare, Le) { run(FloatOp::kLe); }

INSTANTIATE_TEST_SUITE_P(Formats, FpCompare, kAllFormats, format_name);

}  // namespace
}  // namespace raygate
