#include "host/lab/variants/variant_table.h"

#include <gtest/gtest.h>

#include "host/scene/io/input_error.h"

namespace raygate {
namespace {

constexpr const char* kGood =
    "# a comment\n\n"
    "paper serial 8 24 nearest-even kept 21 steps resolved\n"
    "half pipeline 5 11 toward-zero zeros rounded once ignored\n";

TEST(VariantTable, ReadsEachColumn) {
  const auto variants = parse_variants(kGood, "table");
  ASSERT_EQ(variants.size(), 2u);
  EXPECT_EQ(variants[0].name, "paper");
  EXPECT_EQ(variants[0].unit, Variant::Unit::kSerial);
  EXPECT_EQ(variants[0].math, (Arithmetic{.quotient_digits = 21}));
  EXPECT_TRUE(variants[0].doubts);
  EXPECT_TRUE(variants[0].has_hardware());
  EXPECT_EQ(variants[1].math, (Arithmetic{.digits = 11,
                                          .exponent_bits = 5,
                                          .rounding = Rounding::kTowardZero,
                                          .flush = true,
                                          .fused = true}));
  EXPECT_FALSE(variants[1].doubts);
  EXPECT_FALSE(variants[1].has_hardware());
}

void expect_refused(const std::string& line, const std::string& what) {
  try {
    (void)parse_variants("# one line before\n" + line, "table");
    ADD_FAILURE() << line << " was taken";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("table:2: "), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find(what), std::string::npos) << error.what();
  }
}

TEST(VariantTable, SaysWhatIsWrongInWhichLine) {
  expect_refused("a serial 8 24 nearest-even kept 21 steps", "no doubts");
  expect_refused("a serial 8 24 nearest-even kept 21 steps resolved more", "unexpected more");
  expect_refused("a parallel 8 24 nearest-even kept 21 steps resolved", "pipeline, serial");
  expect_refused("a serial 9 24 nearest-even kept 21 steps resolved", "3 to 8");
  expect_refused("a serial 8 x nearest-even kept 21 steps resolved", "digits is x");
  expect_refused("a serial 8 24 nearest-even kept 25 steps resolved", "2 to 24");
  expect_refused("a serial 8 24 nearest kept 21 steps resolved", "rounding is nearest");
  expect_refused("a serial 4 12 nearest-even kept rounded steps resolved", "at most 9");
  expect_refused("a pipeline 8 24 nearest-even kept 21 steps resolved", "rounds its quotients");
  expect_refused("a serial 8 24 nearest-even kept rounded once resolved", "steps");
  expect_refused("a serial 8 24 nearest-even kept rounded steps ignored", "no doubts to ignore");
  // No bound is proven for these.
  expect_refused("a pipeline 8 10 nearest-even kept rounded steps resolved", "11 digits");
  expect_refused("a pipeline 8 24 toward-zero kept rounded steps resolved", "nearest-even");
  expect_refused("a pipeline 8 24 nearest-even zeros rounded steps resolved", "subnormals kept");
}

TEST(VariantTable, TakesANameOnce) {
  const std::string line = "a serial 8 24 nearest-even kept 21 steps resolved\n";
  EXPECT_THROW((void)parse_variants(line + line, "table"), InputError);
}

TEST(VariantTable, OfThisBuildIsSound) {
  EXPECT_FALSE(all_variants_of_arithmetic().empty());
  EXPECT_EQ(variant_named("binary32").math, Arithmetic{});
  EXPECT_THROW((void)variant_named("binary33"), InputError);
}

}  // namespace
}  // namespace raygate
