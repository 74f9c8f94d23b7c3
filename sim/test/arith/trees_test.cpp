// Carry-save trees of 2 to 16 rows keep the sum of their rows.
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <random>

#include "Vtrees_top.h"
#include "sim/model.h"

namespace raygate {
namespace {

constexpr int kMaxRows = 16;
constexpr std::uint64_t kMask = (std::uint64_t{1} << 48) - 1;

TEST(TreesTest, KeepTheSumOfTheirRows) {
  Model<Vtrees_top> model;
  std::mt19937_64 random(1);
  for (int i = 0; i < 20'000; ++i) {
    std::array<std::uint64_t, kMaxRows> rows;
    for (std::uint64_t& row : rows) {
      row = random() & kMask;
      if (random() % 4 == 0) row = random() % 2 ? kMask : 0;
    }
    for (int bit = 0; bit < 48 * kMaxRows; ++bit) {
      std::uint32_t& word = model->rows_i[bit / 32];
      word &= ~(1u << bit % 32);
      word |= static_cast<std::uint32_t>(rows[bit / 48] >> bit % 48 & 1) << bit % 32;
    }
    model.clock();
    std::uint64_t total = rows[0];
    for (int count = 2; count <= kMaxRows; ++count) {
      total = (total + rows[count - 1]) & kMask;
      const std::uint64_t got = model->total_o[2 * count] |
                                static_cast<std::uint64_t>(model->total_o[2 * count + 1]) << 32;
      ASSERT_EQ(got, total) << count << " rows";
    }
  }
}

}  // namespace
}  // namespace raygate
