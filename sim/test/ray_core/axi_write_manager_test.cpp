// axi_write_manager before a memory with random pauses on every channel: each record is in its
// place, once, and nothing else is written; what has no room waits. sim/checks watches the
// handshakes.
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <deque>
#include <map>
#include <random>

#include "Vaxi_write_manager_128.h"
#include "Vaxi_write_manager_32.h"
#include "Vaxi_write_manager_512.h"
#include "sim/model.h"

namespace raygate {
namespace {

constexpr std::uint32_t kSeed = 20261123;
using Record = std::array<std::uint32_t, 8>;

template <class Top>
class AxiWriteManagerTest : public testing::Test {};
using Tops = testing::Types<Vaxi_write_manager_32, Vaxi_write_manager_128, Vaxi_write_manager_512>;
TYPED_TEST_SUITE(AxiWriteManagerTest, Tops);

TYPED_TEST(AxiWriteManagerTest, EveryRecordIsInItsPlaceOnce) {
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  Model<TypeParam> model;
  std::mt19937 random(kSeed);
  model->record_valid_i = model->axi_awready_i = model->axi_wready_i = model->axi_bvalid_i = 0;
  model->rewind_i = 0;
  const unsigned width = sizeof model->axi_wdata_o, beats = width < 32 ? 32 / width : 1;
  std::map<std::uint64_t, std::uint8_t> memory;
  std::deque<std::uint64_t> addresses;  // of bursts whose data have not all come
  std::deque<std::vector<std::uint8_t>>
      early;  // beats, with their strobes, whose address has not come
  std::vector<Record> records;
  unsigned beat = 0, unanswered = 0, answered = 0, full = 0, errors = 0, told = 0, resets = 0;
  for (int round = 0; round < 60; ++round) {
    model->base_i = (std::uint64_t{random()} << 32 | random()) & ~std::uint64_t{63};
    model->length_i = random() % 64;
    if (round % 4 == 0) {  // a reset in mid-run, records on their way
      model->axi_bvalid_i = model->record_valid_i = 0;
      model.reset();
      beat = unanswered = 0;
      ++resets;
    } else {
      model->rewind_i = 1;
      model.clock();
      model->rewind_i = 0;
    }
    memory.clear();
    addresses.clear();
    early.clear();
    records.clear();
    answered = 0;
    const unsigned eager = 1 + random() % 8, enough = random() % 80;
    for (int clock = 0; clock < 1'000 || (round % 4 != 3 && model->busy_o != 0); ++clock) {
      ASSERT_LT(clock, 20'000) << "records stay on their way";
      if (model->record_valid_i == 0 && records.size() < enough && random() % 8 < eager) {
        for (unsigned n = 0; n < 8; ++n) model->record_i[n] = random();
        model->record_valid_i = 1;
      }
      model->axi_awready_i = random() % 8 < eager;
      model->axi_wready_i = random() % 8 < 9 - eager;
      if (model->axi_bvalid_i == 0 && unanswered != 0 && random() % 4 == 0) {
        model->axi_bvalid_i = 1;
        model->axi_bresp_i = random() % 16 == 0 ? 2 + random() % 2 : 0;
        errors += model->axi_bresp_i != 0;
      }
      model.eval();
      told += model->bus_error_o;
      ASSERT_EQ(model->written_o, answered);
      ASSERT_EQ(model->busy_o, records.size() != answered);
      ASSERT_EQ(model->full_o, model->record_valid_i != 0 && records.size() == model->length_i &&
                                   records.size() == answered);
      full += model->full_o;
      if ((model->record_valid_i & model->record_ready_o) != 0) {
        Record& record = records.emplace_back();
        for (unsigned n = 0; n < 8; ++n) record[n] = model->record_i[n];
        ASSERT_LE(records.size(), model->length_i);
      }
      const bool took = (model->record_valid_i & model->record_ready_o) != 0;
      if ((model->axi_awvalid_o & model->axi_awready_i) != 0) {
        ASSERT_EQ(model->axi_awlen_o + 1, beats);
        ASSERT_EQ(1u << model->axi_awsize_o, std::min(width, 32u));
        addresses.push_back(model->axi_awaddr_o);
      }
      if ((model->axi_wvalid_o & model->axi_wready_i) != 0) {
        std::vector<std::uint8_t>& bytes = early.emplace_back(2 * width);
        std::memcpy(bytes.data(), &model->axi_wdata_o, width);
        for (unsigned n = 0; n < width; ++n) {
          bytes[width + n] = static_cast<std::uint64_t>(model->axi_wstrb_o) >> n & 1;
        }
      }
      while (!addresses.empty() && !early.empty()) {
        // A beat's bytes stand where their addresses modulo the port's width say.
        const std::uint64_t at =
            (addresses.front() + std::uint64_t{beat} * width) & ~std::uint64_t{width - 1};
        for (unsigned n = 0; n < width; ++n) {
          if (early.front()[width + n] == 0) continue;
          ASSERT_TRUE(memory.emplace(at + n, early.front()[n]).second) << "written twice";
        }
        early.pop_front();
        if (++beat == beats) {
          beat = 0;
          ++unanswered;
          addresses.pop_front();
        }
      }
      const bool answer = model->axi_bvalid_i != 0;
      model.clock();
      if (took) model->record_valid_i = 0;
      if (answer) {
        model->axi_bvalid_i = 0;
        --unanswered;
        ++answered;
      }
    }
    if (model->busy_o != 0) continue;
    ASSERT_EQ(memory.size(), 32 * records.size());
    for (std::size_t n = 0; n < records.size(); ++n) {
      for (unsigned b = 0; b < 32; ++b) {
        const auto byte = memory.find(model->base_i + 32 * n + b);
        ASSERT_NE(byte, memory.end());
        ASSERT_EQ(byte->second, records[n][b / 4] >> b % 4 * 8 & 0xFF);
      }
    }
  }
  EXPECT_GT(full, 100u);
  EXPECT_GT(errors, 10u);
  EXPECT_EQ(told, errors);
  EXPECT_EQ(resets, 15u);
}

}  // namespace
}  // namespace raygate
