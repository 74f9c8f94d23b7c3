// Compares csr with a model of its documentation: words read, and all outputs in every clock, under
// AXI4-Lite accesses with random pauses on every channel.
#include <gtest/gtest.h>

#include <array>
#include <random>

#include "Vcsr.h"
#include "sim/model.h"

namespace raygate {
namespace {

constexpr std::uint32_t kSeed = 20261122;
constexpr unsigned kEvents = 11;  // ray_core_pkg::NumEvents

/// Returns whether word `n` is a plain register: its access in registers.md is `idle`.
bool is_plain(unsigned n) {
  return (n >= 5 && n <= 9) || (n >= 12 && n < 27 && n % 4 != 3) || (n >= 28 && n <= 30);
}
std::uint32_t bits_of(unsigned n) { return n == 5 || n == 28 ? ~63u : n == 7 ? 0x0FFF'FFFFu : ~0u; }

class CsrTest : public testing::Test {
 protected:
  CsrTest() {
    model_->axi_awvalid_i = model_->axi_wvalid_i = model_->axi_bready_i = 0;
    model_->axi_arvalid_i = model_->axi_rready_i = 0;
    model_->camera_busy_i = model_->core_busy_i = model_->doubt_i = model_->bus_error_i = 0;
    model_->outstanding_i = model_->ray_error_i = model_->error_number_i = 0;
    model_->writing_i = model_->full_i = model_->write_error_i = model_->written_i = 0;
    model_->events_i = 0;
    model_.reset();
  }

  Model<Vcsr> model_;
  std::mt19937 random_{kSeed};
};

/// Reads and writes any words in close succession while the core works. Each word and each output
/// must be as the header says.
TEST_F(CsrTest, AnyTrafficIsAsTheHeaderSays) {
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  std::array<std::uint32_t, 32> words{};
  std::array<std::uint64_t, kEvents + 1> counts{};
  std::uint32_t enable = 0, flags = 0, error_line = 0, expected = 0, address_here = 0,
                data_here = 0, strobes = 0;
  bool drawing = false, aborting = false, written = false, answered = false, has_address = false,
       has_data = false;
  unsigned response = 0, refusals = 0;
  unsigned writes = 0, reads = 0;
  const auto value = [&](unsigned word) -> std::uint32_t {
    if (word == 0) return 0x52470001;
    if (word == 2) {
      return model_->writing_i << 3 | model_->outstanding_i << 2 | model_->core_busy_i << 1 |
             model_->camera_busy_i;
    }
    if (word == 3) return enable;
    if (word == 4) return flags;
    if (word == 10) return error_line;
    if (word == 31) return model_->written_i;
    if (word >= 5 && word < 31) return words[word];
    if (word >= 64 && word < 64 + 2 * counts.size()) {
      return static_cast<std::uint32_t>(counts[(word - 64) / 2] >> (word % 2 == 0 ? 0 : 32));
    }
    return 0;
  };
  const auto address = [&] {
    const unsigned kind = random_() % 4;
    return 4 * (kind < 2 ? random_() % 32 : kind == 2 ? 64 + random_() % 32 : random_() % 1024);
  };
  for (int i = 0; i < 60'000; ++i) {
    if (i % 5'000 == 4'999) {  // a reset in mid-run
      model_->axi_awvalid_i = model_->axi_wvalid_i = model_->axi_arvalid_i = 0;
      model_.reset();
      words = {};
      counts = {};
      enable = flags = error_line = 0;
      drawing = aborting = written = answered = has_address = has_data = false;
    }
    if (model_->axi_awvalid_i == 0 && random_() % 4 != 0) {
      model_->axi_awaddr_i = address();
      model_->axi_awvalid_i = 1;
    }
    if (model_->axi_wvalid_i == 0 && random_() % 4 != 0) {
      model_->axi_wdata_i = random_();
      model_->axi_wstrb_i = random_() % 16;
      model_->axi_wvalid_i = 1;
    }
    if (model_->axi_arvalid_i == 0 && random_() % 4 != 0) {
      model_->axi_araddr_i = address();
      model_->axi_arvalid_i = 1;
    }
    model_->axi_bready_i = random_() % 2;
    model_->axi_rready_i = random_() % 2;
    if (random_() % 16 == 0) model_->camera_busy_i = random_() % 2;
    if (random_() % 16 == 0) model_->core_busy_i = random_() % 2;
    model_->doubt_i = random_() % 16 == 0;
    model_->bus_error_i = random_() % 16 == 0;
    model_->error_number_i = random_() % (1u << 28);
    model_->ray_error_i = random_() % 16 == 0;
    model_->full_i = random_() % 16 == 0;
    model_->write_error_i = random_() % 16 == 0;
    model_->written_i = random_();
    if (random_() % 16 == 0) model_->writing_i = random_() % 2;
    if (random_() % 16 == 0) model_->outstanding_i = random_() % 2;
    model_->events_i = random_() & ((1u << kEvents) - 1);
    model_.eval();
    ASSERT_EQ(model_->axi_bvalid_o, written);
    if (written) {
      ASSERT_EQ(model_->axi_bresp_o, response);
    }
    ASSERT_EQ(model_->axi_rvalid_o, answered);
    ASSERT_EQ(model_->axi_awready_o, !has_address);
    ASSERT_EQ(model_->axi_wready_o, !has_data);
    ASSERT_EQ(model_->axi_arready_o, !answered);
    if (answered) {
      ASSERT_EQ(model_->axi_rdata_o, expected);
    }
    ASSERT_EQ(model_->base_o, std::uint64_t{words[6]} << 32 | words[5]);
    ASSERT_EQ(model_->lines_o, words[7]);
    ASSERT_EQ(model_->abort_o, aborting);
    ASSERT_EQ(model_->drawing_o, drawing);
    ASSERT_EQ(model_->corner_o, words[8]);
    ASSERT_EQ(model_->size_o, words[9]);
    ASSERT_EQ(model_->results_o, std::uint64_t{words[29]} << 32 | words[28]);
    ASSERT_EQ(model_->length_o, words[30]);
    for (unsigned n = 0; n < 12; ++n) {
      ASSERT_EQ(model_->camera_o[n], words[12 + n / 3 * 4 + n % 3]);
    }
    ASSERT_EQ(model_->interrupt_o, (enable & flags) != 0);

    // The model's events in this clock.
    const bool takes_address = model_->axi_awvalid_i != 0 && !has_address;
    const bool takes_data = model_->axi_wvalid_i != 0 && !has_data;
    const bool write = has_address && has_data && !written;
    const bool read = model_->axi_arvalid_i != 0 && !answered;
    if (read) expected = value(model_->axi_araddr_i / 4);
    const unsigned word = write ? address_here / 4 : 1023;
    std::uint32_t mask = 0;
    for (unsigned b = 0; b < 4; ++b) mask |= (strobes >> b & 1) * (0xFFu << 8 * b);
    const std::uint32_t data = data_here & mask;
    const bool busy = (model_->camera_busy_i | model_->core_busy_i) != 0;
    const bool base = word == 5 || word == 6;
    const bool refused = (busy && (is_plain(word) || (word == 1 && (data & 3) != 0))) ||
                         (model_->outstanding_i != 0 && (base || (word == 1 && (data & 2) != 0))) ||
                         (model_->writing_i != 0 && word == 1 && (data & 16) != 0);
    const bool starts = word == 1 && (data & 1) != 0 && !refused;
    ASSERT_EQ(model_->start_o, starts);
    ASSERT_EQ(model_->rewind_o, word == 1 && (data & 16) != 0 && !refused);
    ASSERT_EQ(model_->invalidate_o, (base || (word == 1 && (data & 2) != 0)) && !refused);
    if (word == 3) enable = (data | (enable & ~mask)) & 63;
    if (model_->bus_error_i != 0 && (flags & 4) == 0) error_line = model_->error_number_i;
    aborting = (word == 1 && (data & 8) != 0 && !refused) || (aborting && busy);
    if (word == 4) flags &= ~data;
    flags |= model_->doubt_i | (drawing && !busy ? 2u : 0u) | (model_->bus_error_i != 0 ? 4u : 0u) |
             (model_->ray_error_i != 0 ? 8u : 0u) | (model_->full_i != 0 ? 16u : 0u) |
             (model_->write_error_i != 0 ? 32u : 0u);
    drawing = starts || model_->camera_busy_i != 0 || (drawing && busy);
    if (is_plain(word) && !refused) words[word] = (data & bits_of(word)) | (words[word] & ~mask);
    counts[0] += model_->core_busy_i;
    for (unsigned n = 0; n < kEvents; ++n) counts[n + 1] += model_->events_i >> n & 1;
    if (word == 1 && (data & 4) != 0 && !refused) counts = {};
    if (write) response = refused ? 2 : 0;
    refusals += write && refused;
    written = write || (written && model_->axi_bready_i == 0);
    answered = read || (answered && model_->axi_rready_i == 0);
    writes += write;
    reads += read;
    model_.clock();
    if (takes_address) {
      address_here = model_->axi_awaddr_i;
      model_->axi_awvalid_i = 0;
    }
    if (takes_data) {
      data_here = model_->axi_wdata_i;
      strobes = model_->axi_wstrb_i;
      model_->axi_wvalid_i = 0;
    }
    has_address = takes_address || (has_address && !write);
    has_data = takes_data || (has_data && !write);
    if (read) model_->axi_arvalid_i = 0;
  }
  EXPECT_GT(writes, 10'000u);
  EXPECT_GT(reads, 10'000u);
  EXPECT_GT(refusals, 1'000u);
}

}  // namespace
}  // namespace raygate
