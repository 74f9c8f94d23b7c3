#include "sim/fp/vector_check.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <sstream>

#include "host/base/input_error.h"
#include "sim/fp/vectors.h"
#include "sim/test/fp/oracle.h"

namespace raygate {
namespace {

// Vectors as testfloat_gen writes them, by the oracle. `spoil` is the number of those given wrong,
// turn by turn in the result and in the flags.
std::string vectors(const VectorFunction& function, const VectorCheckOptions& options, int count,
                    int spoil = 0) {
  PairSource source(function.format, function.op, 7);
  const int digits = function.format.width() / 4;
  std::string text;
  for (int i = 0; i < count; ++i) {
    const auto [a, b] = source.next();
    FloatResult result =
        is_comparison(function.op)
            ? oracle_compare(function.format, function.op, a, b)
            : round_exact(function.format, exact_result(function.format, function.op, a, b),
                          options.rounding, options.tininess);
    if (i < spoil && i % 2 == 0) result.bits ^= 1;
    if (i < spoil && i % 2 == 1) result.flags ^= kInexact;
    char line[64];
    std::snprintf(line, sizeof line, "%0*X %0*X %0*X %02X\n", digits, a, digits, b,
                  is_comparison(function.op) ? 1 : digits, result.bits, result.flags);
    text += line;
  }
  return text;
}

VectorCheckSummary check(const VectorFunction& function, const VectorCheckOptions& options,
                         const std::string& text, std::string* shown = nullptr) {
  const auto cores = rtl_float_cores(function.format);
  std::istringstream in(text);
  std::ostringstream out;
  const VectorCheckSummary summary = check_vectors(in, "in", *cores, options, out);
  if (shown != nullptr) *shown = out.str();
  return summary;
}

TEST(VectorCheck, AgreesWithTheOracleInAllFunctionsAndModes) {
  for (const VectorFunction& function : vector_functions()) {
    for (int mode = 0; mode < 5; ++mode) {
      for (int tininess = 0; tininess < 2; ++tininess) {
        VectorCheckOptions options;
        options.op = function.op;
        options.rounding = static_cast<RoundingMode>(mode);
        options.tininess = static_cast<Tininess>(tininess);
        options.check_nans = true;
        std::string shown;
        const auto summary = check(function, options, vectors(function, options, 500), &shown);
        EXPECT_EQ(summary.vectors, 500u);
        EXPECT_EQ(summary.differences, 0u) << function.name << ", rounding " << mode << shown;
      }
    }
  }
}

TEST(VectorCheck, FindsEveryWrongVectorAndShowsTwenty) {
  for (const VectorFunction& function : vector_functions()) {
    VectorCheckOptions options;
    options.op = function.op;
    options.check_nans = true;
    std::string shown;
    const auto summary = check(function, options, vectors(function, options, 100, 50), &shown);
    EXPECT_EQ(summary.vectors, 100u);
    EXPECT_EQ(summary.differences, 50u) << function.name;
    EXPECT_EQ(std::count(shown.begin(), shown.end(), '\n'), 20) << shown;
  }
}

const VectorFunction kAdd32{"f32_add", kBinary32, FloatOp::kAdd};

TEST(VectorCheck, TakesAnyNanForAnotherUnlessToldNotTo) {
  VectorCheckOptions options;
  const std::string text = "7F800000 FF800000 FFC12345 10\n";  // inf - inf, with a payload
  EXPECT_EQ(check(kAdd32, options, text).differences, 0u);
  options.check_nans = true;
  EXPECT_EQ(check(kAdd32, options, text).differences, 1u);
  options.check_nans = false;
  EXPECT_EQ(check(kAdd32, options, "7F800000 FF800000 7F800000 10\n").differences, 1u);
}

TEST(VectorCheck, ReadsAnyCaseBlanksAndLineEnds) {
  const auto summary = check(kAdd32, {},
                             "3f800000\t3F800000  40000000 00\r\n"
                             " 3F800000 00000000 3F800000 00");
  EXPECT_EQ(summary.vectors, 2u);
  EXPECT_EQ(summary.differences, 0u);
}

TEST(VectorCheck, RefusesWhatIsNoVectorWithItsLine) {
  const std::string good = "3F800000 3F800000 40000000 00\n";
  for (const std::string bad :
       {"", "3F800000", "3F800000 3F800000 40000000", "3F800000 3F800000 40000000 00 0",
        "3F80000 3F800000 40000000 00", "3F8000000 3F800000 40000000 00",
        "3F80000G 3F800000 40000000 00", "0x3F8000 3F800000 40000000 00",
        "-3F80000 3F800000 40000000 00", "3F800000 3F800000 40000000 20",
        "3F800000 3F800000 40000000 0", "3F800000,3F800000,40000000,00"}) {
    try {
      check(kAdd32, {}, good + good + bad + "\n" + good);
      ADD_FAILURE() << "took \"" << bad << '"';
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).rfind("in:3: ", 0), 0u) << error.what();
    }
  }
  VectorCheckOptions less;
  less.op = FloatOp::kLt;
  EXPECT_THROW(check({"f32_lt", kBinary32, FloatOp::kLt}, less, "3F800000 3F800000 2 00\n"),
               InputError);
}

TEST(VectorCheck, CountsNoVectorsInNothing) { EXPECT_EQ(check(kAdd32, {}, "").vectors, 0u); }

}  // namespace
}  // namespace raygate
