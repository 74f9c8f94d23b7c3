// Lines read from the SDRAM equal the lines written, and all commands obey the data sheet
// (sdram_model.h).
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <optional>
#include <random>

#include "Vsdram_controller.h"
#include "Vsdram_controller___024root.h"
#include "sim/model.h"
#include "sim/sdram_model.h"

namespace raygate {
namespace {

using Line = std::array<std::uint32_t, 16>;
constexpr int kStart = 200 * 40 + 20;  // clocks until the controller takes the first line

class SdramControllerTest : public testing::Test {
 protected:
  SdramControllerTest() {
    model_->read_valid_i = model_->write_valid_i = model_->line_ready_i = 0;
    model_.reset();
  }

  void clock() {
    model_.clock();
    model_->sdram_data_i = sdram_.clock({
        .ras_n = model_->sdram_ras_no != 0,
        .cas_n = model_->sdram_cas_no != 0,
        .we_n = model_->sdram_we_no != 0,
        .bank = model_->sdram_bank_o,
        .address = model_->sdram_address_o,
        .drives = model_->sdram_drive_o != 0,
        .data = model_->sdram_data_o,
    });
  }

  Model<Vsdram_controller> model_;
  SdramModel sdram_{40.0};
};

TEST_F(SdramControllerTest, LinesComeAsTheyWent) {
  std::mt19937 random(2);
  const auto chance = [&](unsigned of_256) { return random() % 256 < of_256; };
  std::map<std::uint32_t, Line> memory;
  std::vector<std::uint32_t> numbers;
  std::optional<std::pair<unsigned, std::uint32_t>> reading;  // id, number
  int compared = 0, written = 0;
  std::uint32_t number = 0;
  Line data{};
  for (int now = 0; now < 120'000; ++now) {
    if (model_->write_valid_i == 0 && chance(8)) {
      // neighbouring and distant lines, and numbers beyond memory, which wrap
      number = chance(128) ? random() % 64 : random() % (1u << 28);
      for (std::uint32_t& word : data) word = random();
      model_->write_valid_i = 1;
      model_->write_line_i = number;
      std::memcpy(&model_->write_data_i, &data, sizeof data);
    }
    if (model_->read_valid_i == 0 && !numbers.empty() && chance(128)) {
      model_->read_valid_i = 1;
      model_->read_line_i = numbers[random() % numbers.size()];
      model_->read_id_i = random() % 128;
    }
    model_->line_ready_i = chance(100);
    model_.eval();
    const bool write = (model_->write_valid_i & model_->write_ready_o) != 0;
    const bool read = (model_->read_valid_i & model_->read_ready_o) != 0;
    ASSERT_FALSE(write && read);
    if ((model_->line_valid_o & model_->line_ready_i) != 0) {
      ASSERT_TRUE(reading);
      ASSERT_EQ(model_->line_id_o, reading->first);
      Line line{};
      std::memcpy(&line, &model_->line_o, sizeof line);
      ASSERT_EQ(line, memory.at(reading->second & 0x7FFFF));
      reading.reset();
      ++compared;
    }
    if (write) {
      memory[number & 0x7FFFF] = data;
      numbers.push_back(number);
      ++written;
    }
    if (read) {
      ASSERT_FALSE(reading);
      reading = {model_->read_id_i, model_->read_line_i};
    }
    clock();
    if (write) model_->write_valid_i = 0;
    if (read) model_->read_valid_i = 0;
  }
  EXPECT_GT(compared, 800);
  EXPECT_GT(written, 500);
}

/// Latency and period of a line, without refreshes, are those in the controller's header.
TEST_F(SdramControllerTest, ALineTakesItsTime) {
  for (int i = 0; i < kStart; ++i) clock();
  int latency = 1'000, period = 1'000;
  model_->read_valid_i = 1;
  model_->line_ready_i = 1;
  model_.eval();
  while (model_->read_ready_o == 0) clock();
  for (unsigned i = 0; i < 40; ++i) {
    model_->read_line_i = i * 100;
    model_.eval();
    int clocks = 0, lines_at = 0;
    do {
      clock();
      ++clocks;
      if (model_->line_valid_o != 0) lines_at = clocks;
    } while (model_->read_ready_o == 0);
    latency = std::min(latency, lines_at);
    period = std::min(period, clocks);
  }
  EXPECT_EQ(latency, 36);
  EXPECT_EQ(period, 37);
}

}  // namespace
}  // namespace raygate
