// core_registers by AXI4-Lite with random pauses on every channel, against a model of what the
// header says.
#include <gtest/gtest.h>

#include <array>
#include <random>

#include "Vcore_registers.h"
#include "sim/model.h"

namespace raygate {
namespace {

constexpr std::uint32_t kSeed = 20261122;
constexpr unsigned kEvents = 10;  // ray_core_pkg::NumEvents

class CoreRegistersTest : public testing::Test {
 protected:
  CoreRegistersTest() {
    model_->axi_awvalid_i = model_->axi_wvalid_i = model_->axi_bready_i = 0;
    model_->axi_arvalid_i = model_->axi_rready_i = 0;
    model_->camera_busy_i = model_->core_busy_i = model_->doubt_i = model_->failed_i = 0;
    model_->events_i = 0;
    model_.reset();
  }

  /// A clock; what it did to counters and flags.
  void clock() {
    model_.eval();
    started_ += model_->start_o;
    invalidated_ += model_->invalidate_o;
    model_.clock();
  }

  /// With pauses; address and data in any order.
  void write(std::uint32_t address, std::uint32_t data, unsigned strobes = 15) {
    bool address_there = false, data_there = false;
    model_->axi_awaddr_i = address;
    model_->axi_wdata_i = data;
    model_->axi_wstrb_i = strobes;
    for (bool taken = false; !taken;) {
      address_there |= random_() % 3 == 0;
      data_there |= random_() % 3 == 0;
      model_->axi_awvalid_i = address_there;
      model_->axi_wvalid_i = data_there;
      model_.eval();
      ASSERT_EQ(model_->axi_awready_o, model_->axi_wready_o);
      taken = address_there && data_there && model_->axi_awready_o != 0;
      clock();
    }
    model_->axi_awvalid_i = model_->axi_wvalid_i = 0;
    for (bool done = false; !done;) {
      model_->axi_bready_i = random_() % 2;
      ASSERT_EQ(model_->axi_bvalid_o, 1);
      ASSERT_EQ(model_->axi_bresp_o, 0);
      done = model_->axi_bready_i != 0;
      clock();
    }
    model_->axi_bready_i = 0;
    ASSERT_EQ(model_->axi_bvalid_o, 0);
  }

  std::uint32_t read(std::uint32_t address) {
    model_->axi_araddr_i = address;
    while (random_() % 2 == 0) clock();
    model_->axi_arvalid_i = 1;
    model_.eval();
    EXPECT_EQ(model_->axi_arready_o, 1);
    clock();
    model_->axi_arvalid_i = 0;
    while (random_() % 2 == 0) {
      EXPECT_EQ(model_->axi_rvalid_o, 1);
      clock();
    }
    EXPECT_EQ(model_->axi_rvalid_o, 1);
    EXPECT_EQ(model_->axi_rresp_o, 0);
    const std::uint32_t data = model_->axi_rdata_o;
    model_->axi_rready_i = 1;
    clock();
    model_->axi_rready_i = 0;
    return data;
  }

  Model<Vcore_registers> model_;
  std::mt19937 random_{kSeed};
  int started_ = 0, invalidated_ = 0;
};

TEST_F(CoreRegistersTest, PlainRegistersKeepTheirBytes) {
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  std::array<std::uint32_t, 32> words{};
  for (unsigned n = 5; n < 27; ++n) write(4 * n, words[n] = random_());
  for (int i = 0; i < 2'000; ++i) {
    const unsigned n = 5 + random_() % 22, strobes = random_() % 16;
    const std::uint32_t data = random_();
    write(4 * n, data, strobes);
    for (unsigned b = 0; b < 4; ++b) {
      if ((strobes >> b & 1) == 0) continue;
      words[n] = (words[n] & ~(0xFFu << 8 * b)) | (data & 0xFFu << 8 * b);
    }
    write(0x800 + 4 * n, random_());  // nothing is there
    const unsigned seen = 5 + random_() % 22;
    ASSERT_EQ(read(4 * seen), words[seen]);
  }
  EXPECT_EQ(model_->base_o, std::uint64_t{words[6]} << 32 | words[5]);
  EXPECT_EQ(model_->corner_o, words[8]);
  EXPECT_EQ(model_->size_o, words[9]);
  for (unsigned v = 0; v < 4; ++v) {
    for (unsigned k = 0; k < 3; ++k) EXPECT_EQ(model_->camera_o[3 * v + k], words[12 + 4 * v + k]);
  }
  EXPECT_EQ(read(0x000), 0x52470001u);
  EXPECT_EQ(read(0x800), 0u);
  EXPECT_EQ(read(0x004), 0u);
}

TEST_F(CoreRegistersTest, CommandsLastAClock) {
  write(0x004, 1);
  EXPECT_EQ(started_, 1);
  write(0x004, 2);
  write(0x004, 3, 14);  // not that byte
  EXPECT_EQ(started_, 1);
  EXPECT_EQ(invalidated_, 1);
}

TEST_F(CoreRegistersTest, FlagsRiseFallAndInterrupt) {
  EXPECT_EQ(read(0x010), 0u);
  model_->doubt_i = 1;
  clock();
  model_->doubt_i = 0;
  EXPECT_EQ(read(0x010), 1u);
  EXPECT_EQ(model_->interrupt_o, 0);
  write(0x00C, 3);
  EXPECT_EQ(read(0x00C), 3u);
  EXPECT_EQ(model_->interrupt_o, 1);
  write(0x010, 6);
  EXPECT_EQ(read(0x010), 1u);
  write(0x010, 1);
  EXPECT_EQ(read(0x010), 0u);
  EXPECT_EQ(model_->interrupt_o, 0);
  model_->failed_i = 1;
  clock();
  model_->failed_i = 0;
  EXPECT_EQ(read(0x010), 4u);
  EXPECT_EQ(model_->interrupt_o, 0) << "not enabled";
  // A rectangle is drawn when neither camera nor core has rays left.
  model_->camera_busy_i = 1;
  clock();
  model_->core_busy_i = 1;
  clock();
  EXPECT_EQ(read(0x008), 3u);
  model_->camera_busy_i = 0;
  clock();
  EXPECT_EQ(read(0x010), 4u);
  EXPECT_EQ(read(0x008), 2u);
  model_->core_busy_i = 0;
  clock();
  EXPECT_EQ(read(0x010), 6u);
  EXPECT_EQ(model_->interrupt_o, 1);
  // Rays that no camera made raise nothing.
  write(0x010, 7);
  model_->core_busy_i = 1;
  clock();
  model_->core_busy_i = 0;
  clock();
  EXPECT_EQ(read(0x010), 0u);
}

TEST_F(CoreRegistersTest, CountersCountTheirEvents) {
  std::array<std::uint64_t, kEvents + 1> counts{};
  for (int i = 0; i < 5'000; ++i) {
    model_->events_i = random_() & ((1u << kEvents) - 1);
    model_->core_busy_i = random_() % 2;
    counts[0] += model_->core_busy_i;
    for (unsigned n = 0; n < kEvents; ++n) counts[n + 1] += model_->events_i >> n & 1;
    clock();
  }
  model_->events_i = 0;
  model_->core_busy_i = 0;
  for (unsigned n = 0; n <= kEvents; ++n) {
    EXPECT_EQ(read(0x100 + 8 * n), counts[n]);
    EXPECT_EQ(read(0x104 + 8 * n), 0u);
  }
  write(0x004, 4);
  for (unsigned n = 0; n <= kEvents; ++n) EXPECT_EQ(read(0x100 + 8 * n), 0u);
}

}  // namespace
}  // namespace raygate
