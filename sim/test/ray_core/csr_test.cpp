// csr by AXI4-Lite with random pauses on every channel, against a model of what the
// header says.
#include <gtest/gtest.h>

#include <array>
#include <random>

#include "Vcsr.h"
#include "sim/model.h"

namespace raygate {
namespace {

constexpr std::uint32_t kSeed = 20261122;
constexpr unsigned kEvents = 11;  // ray_core_pkg::NumEvents

/// Whether word `n` is a plain register, and which of its bits can be written.
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

  /// A clock; what it did to counters and flags.
  void clock() {
    model_.eval();
    started_ += model_->start_o;
    invalidated_ += model_->invalidate_o;
    model_.clock();
  }

  /// With pauses; address and data in any order. The answer, 0 or 2: okay or refused.
  unsigned write(std::uint32_t address, std::uint32_t data, unsigned strobes = 15) {
    model_->axi_awaddr_i = address;
    model_->axi_wdata_i = data;
    model_->axi_wstrb_i = strobes;
    for (bool address_taken = false, data_taken = false; !address_taken || !data_taken;) {
      if (!address_taken && random_() % 3 == 0) model_->axi_awvalid_i = 1;
      if (!data_taken && random_() % 3 == 0) model_->axi_wvalid_i = 1;
      const bool takes_address = (model_->axi_awvalid_i & model_->axi_awready_o) != 0;
      const bool takes_data = (model_->axi_wvalid_i & model_->axi_wready_o) != 0;
      clock();
      if (takes_address) model_->axi_awvalid_i = 0;
      if (takes_data) model_->axi_wvalid_i = 0;
      address_taken |= takes_address;
      data_taken |= takes_data;
    }
    clock();
    EXPECT_EQ(model_->axi_bvalid_o, 1);
    const unsigned response = model_->axi_bresp_o;
    while (random_() % 2 == 0) clock();
    model_->axi_bready_i = 1;
    clock();
    model_->axi_bready_i = 0;
    EXPECT_EQ(model_->axi_bvalid_o, 0);
    return response;
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

  Model<Vcsr> model_;
  std::mt19937 random_{kSeed};
  int started_ = 0, invalidated_ = 0;
};

TEST_F(CsrTest, PlainRegistersKeepTheirBytes) {
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  std::array<std::uint32_t, 32> words{};
  for (int i = 0; i < 2'000; ++i) {
    const unsigned n = 5 + random_() % 26, strobes = random_() % 16;
    const std::uint32_t data = random_() & bits_of(n);
    ASSERT_EQ(write(4 * n, data | (random_() & ~bits_of(n)), strobes), 0u);
    for (unsigned b = 0; b < 4; ++b) {
      if ((strobes >> b & 1) == 0 || !is_plain(n)) continue;
      words[n] = (words[n] & ~(0xFFu << 8 * b)) | (data & 0xFFu << 8 * b);
    }
    write(0x800 + 4 * n, random_());  // nothing is there
    const unsigned seen = 5 + random_() % 26;
    ASSERT_EQ(read(4 * seen), words[seen]);
  }
  EXPECT_EQ(model_->base_o, std::uint64_t{words[6]} << 32 | words[5]);
  EXPECT_EQ(model_->lines_o, words[7]);
  EXPECT_EQ(model_->corner_o, words[8]);
  EXPECT_EQ(model_->size_o, words[9]);
  EXPECT_EQ(model_->results_o, std::uint64_t{words[29]} << 32 | words[28]);
  EXPECT_EQ(model_->length_o, words[30]);
  for (unsigned v = 0; v < 4; ++v) {
    for (unsigned k = 0; k < 3; ++k) EXPECT_EQ(model_->camera_o[3 * v + k], words[12 + 4 * v + k]);
  }
  EXPECT_EQ(read(0x000), 0x52470001u);
  EXPECT_EQ(read(0x800), 0u);
  EXPECT_EQ(read(0x004), 0u);
}

TEST_F(CsrTest, CommandsLastAClock) {
  write(0x004, 1);
  EXPECT_EQ(started_, 1);
  write(0x004, 2);
  write(0x004, 3, 14);  // not that byte
  EXPECT_EQ(started_, 1);
  EXPECT_EQ(invalidated_, 1);
}

/// While rays are to be made or in the core, what would change them is refused and does nothing.
TEST_F(CsrTest, CommandsWhileBusyAreRefused) {
  EXPECT_EQ(write(0x020, 17), 0u);
  for (const bool camera : {true, false}) {
    model_->camera_busy_i = camera;
    model_->core_busy_i = !camera;
    for (const std::uint32_t command : {1u, 2u, 3u, 7u}) EXPECT_EQ(write(0x004, command), 2u);
    for (const std::uint32_t address : {0x014u, 0x020u, 0x024u, 0x068u}) {
      EXPECT_EQ(write(address, 99), 2u);
    }
    EXPECT_EQ(write(0x004, 4), 0u) << "counters";
    EXPECT_EQ(write(0x00C, 1), 0u) << "enable";
    EXPECT_EQ(write(0x010, 7), 0u) << "flags";
  }
  EXPECT_EQ(read(0x020), 17u);
  EXPECT_EQ(started_ + invalidated_, 0);
  model_->core_busy_i = 0;
  EXPECT_EQ(write(0x004, 1), 0u);
  EXPECT_EQ(started_, 1);
}

/// Caches are emptied for another memory, and not while lines of the one that was are on their way.
TEST_F(CsrTest, AChangedBaseEmptiesTheCaches) {
  for (const std::uint32_t address : {0x014u, 0x018u}) {
    invalidated_ = 0;
    EXPECT_EQ(write(address, 0x1000), 0u);
    EXPECT_EQ(invalidated_, 1);
    model_->outstanding_i = 1;
    EXPECT_EQ(write(address, 0x2000), 2u);
    EXPECT_EQ(write(0x004, 2), 2u);
    EXPECT_EQ(write(0x004, 1), 0u) << "rays do not wait";
    EXPECT_EQ(write(0x020, 5), 0u);
    EXPECT_EQ(read(0x008), 4u);
    model_->outstanding_i = 0;
    EXPECT_EQ(invalidated_, 1);
    EXPECT_EQ(read(address), 0x1000u);
  }
}

/// A command to give up rays is taken while there are some, and holds until there is none.
TEST_F(CsrTest, RaysAreGivenUpUntilNoneIsLeft) {
  model_->camera_busy_i = 1;
  EXPECT_EQ(write(0x004, 8), 0u);
  for (int n = 0; n < 10; ++n) {
    EXPECT_EQ(model_->abort_o, 1);
    if (n == 5) model_->core_busy_i = 1;
    if (n == 7) model_->camera_busy_i = 0;
    clock();
  }
  model_->core_busy_i = 0;
  clock();
  EXPECT_EQ(model_->abort_o, 0);
  EXPECT_EQ(write(0x004, 9, 14), 0u) << "not that byte";
  EXPECT_EQ(model_->abort_o, 0);
}

/// The line that failed first is kept until its flag is lowered.
TEST_F(CsrTest, TheFirstLineThatFailedIsTold) {
  EXPECT_EQ(read(0x028), 0u);
  for (const std::uint32_t line : {0x0ABC'DEF1u, 7u}) {
    model_->error_number_i = line;
    model_->bus_error_i = 1;
    clock();
    model_->error_number_i = 99;
    clock();
    model_->bus_error_i = 0;
    EXPECT_EQ(read(0x028), line);
    write(0x010, 4);
  }
}

/// A rectangle without pixels, which makes no camera busy, is done.
TEST_F(CsrTest, AnEmptyRectangleIsDone) {
  write(0x00C, 2);
  write(0x004, 1);
  EXPECT_EQ(model_->interrupt_o, 1);
  EXPECT_EQ(read(0x010), 2u);
}

TEST_F(CsrTest, FlagsRiseFallAndInterrupt) {
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
  model_->bus_error_i = 1;
  clock();
  model_->bus_error_i = 0;
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

TEST_F(CsrTest, CountersCountTheirEvents) {
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

/// Reads and writes of any word, close upon each other, while the core works: each word and each
/// output as the header says.
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

    // What this clock does.
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
