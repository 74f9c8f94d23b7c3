#include "sim/test/fp/format_test.h"

namespace raygate {
namespace {

using FpAdder = FormatTest;

TEST_P(FpAdder, Add) { run(FloatOp::kAdd); }
TEST_P(FpAdder, Sub) { run(FloatOp::kSub); }

INSTANTIATE_TEST_SUITE_P(Formats, FpAdder, kAllFormats, format_name);

}  // namespace
}  // namespace raygate
