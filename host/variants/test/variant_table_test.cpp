#include "host/variants/variant_table.h"

#include <gtest/gtest.h>

#include "host/base/test/temp_folder.h"

namespace raygate {
namespace {

TEST(VariantTable, ReadsEachColumn) {
  const auto variants = parse_variants(
      R"([{"variant": "paper", "unit": "serial", "quotient_digits": 21},
          {"variant": "half", "exponent_bits": 5, "digits": 11, "rounding": "toward-zero",
           "flush": true, "fused": true, "doubts": false, "brought": "folder"}])",
      "table");
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
  EXPECT_EQ(variants[0].brought + ":" + variants[1].brought, ":folder");
  EXPECT_FALSE(variants[1].has_hardware());
}

void expect_refused(const std::string& rest, const std::string& what) {
  const std::string error =
      input_error_of([&] { (void)parse_variants(R"([{"variant": "a", )" + rest + "}]", "table"); });
  EXPECT_TRUE(error.starts_with("table: ")) << rest << ": " << error;
  EXPECT_NE(error.find(what), std::string::npos) << error;
}

TEST(VariantTable, SaysWhatIsWrongOfWhich) {
  expect_refused(R"("digit": 3)", "has digit, expected ");
  expect_refused(R"("digits": "3")", "digits is \"3\"");
  expect_refused(R"("doubts": "ignored")", "doubts is \"ignored\"");
  expect_refused(R"("unit": "parallel")", "pipeline or serial");
  expect_refused(R"("exponent_bits": 9)", "3 to 8");
  expect_refused(R"("quotient_digits": 25)", "0 to 24");
  expect_refused(R"("rounding": "nearest")", "rounding is \"nearest\"");
  expect_refused(R"("unit": "serial", "exponent_bits": 4, "digits": 12)", "too many digits");
  expect_refused(R"("quotient_digits": 21)", "rounds its quotients");
  expect_refused(R"("unit": "serial", "fused": true)", "fused");
  expect_refused(R"("unit": "serial", "doubts": false)", "no doubts to ignore");
  // No bound is proven for these.
  expect_refused(R"("digits": 10)", "11 digits");
  expect_refused(R"("rounding": "toward-zero")", "nearest-even");
  expect_refused(R"("flush": true)", "subnormals");
  EXPECT_THROW((void)parse_variants("[{]", "table"), InputError);
}

TEST(VariantTable, TakesANameOnce) {
  EXPECT_THROW((void)parse_variants(R"([{"variant": "a"}, {"variant": "a"}])", "table"),
               InputError);
}

TEST(VariantTable, OfThisBuildIsSound) {
  ASSERT_FALSE(all_variants_of_arithmetic().empty());
  EXPECT_EQ(all_variants_of_arithmetic().front().math, Arithmetic{});
}

TEST(VariantTable, AnyFormatIsAVariant) {
  const auto wide = variant_of_format("e8p15"), raw = variant_of_format("e5p9-raw");
  ASSERT_TRUE(wide && raw);
  EXPECT_EQ(wide->math, (Arithmetic{.digits = 15}));
  EXPECT_TRUE(wide->doubts);
  EXPECT_EQ(raw->math, (Arithmetic{.digits = 9, .exponent_bits = 5}));
  EXPECT_FALSE(raw->doubts);
  EXPECT_EQ(wide->name + " " + raw->name, "e8p15 e5p9-raw");
  for (const char* text : {"", "e8", "e9p15", "e8p15-row", "e8p150"}) {
    EXPECT_FALSE(variant_of_format(text)) << text;
  }
  for (const char* text : {"e8p2-raw", "e8p25", "e8p10", "e3p12-raw"}) {
    EXPECT_THROW((void)variant_of_format(text), InputError) << text;
  }
}

}  // namespace
}  // namespace raygate
