// Tests axi_read_manager with a memory that answers bursts in any order, with interleaved beats and
// random pauses on every channel. Each tag gets its own line, once. sim/checks checks handshakes.
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <map>
#include <random>
#include <set>
#include <vector>

#include "Vaxi_read_manager_32.h"
#include "Vaxi_read_manager_512.h"
#include "sim/model.h"

namespace raygate {
namespace {

constexpr std::uint32_t kSeed = 20261122;
constexpr unsigned kIds = 8;

/// Returns word n of a line of memory.
std::uint32_t word_of(std::uint32_t line, unsigned n) {
  return static_cast<std::uint32_t>((std::uint64_t{line} * 16 + n) * 0x9E37'79B9'7F4A'7C15 >> 32);
}

/// Sets a port of any type in Verilator's class.
template <class Port>
void set_words(Port& port, const std::vector<std::uint32_t>& words) {
  ASSERT_EQ(sizeof port, 4 * words.size());
  std::memcpy(&port, words.data(), sizeof port);
}

template <class Top>
class AxiReadManagerTest : public testing::Test {};
using Tops = testing::Types<Vaxi_read_manager_32, Vaxi_read_manager_512>;
TYPED_TEST_SUITE(AxiReadManagerTest, Tops);

TYPED_TEST(AxiReadManagerTest, EveryTagGetsItsLineOnce) {
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  struct Burst {
    bool open = false;
    std::uint32_t line = 0;
    unsigned beat = 0;
  };
  Model<TypeParam> model;
  std::mt19937 random(kSeed);
  model->read_valid_i = model->line_ready_i = model->axi_arready_i = model->axi_rvalid_i = 0;
  model.reset();
  const unsigned beat_words = sizeof model->axi_rdata_i / 4, beats = 16 / beat_words;
  std::array<Burst, kIds> bursts;
  std::map<std::uint64_t, std::uint32_t> waiting;  // lines by tag
  std::set<std::uint32_t> failing_lines;
  std::uint64_t next_tag = 0, address = 0;
  std::uint32_t line = 0;  // the line requested last, at `address`
  unsigned answering = 0, given = 0, mixed = 0, full = 0, failing = 0, failed = 0, last_id = 0;
  bool fails = false;
  for (int clock = 0; clock < 60'000; ++clock) {
    const unsigned eager = 1 + clock / 4'000 % 7;  // chances in 8
    if (clock % 5'000 == 4'999) {                  // a reset in mid-run
      model->read_valid_i = model->axi_rvalid_i = 0;
      model.reset();
      bursts = {};
      waiting.clear();
      failing_lines.clear();
      failing = failed;
      ASSERT_EQ(model->line_valid_o | model->axi_arvalid_o, 0);
    }
    if (model->read_valid_i == 0 && random() % 8 < 6) {
      model->read_valid_i = 1;
      model->base_i = std::uint64_t{random()} << 32 | random();  // the lowest six bits are ignored
      model->read_line_i = random() % (1u << 28);
      model->read_id_i = next_tag++ % 512;
    }
    // In every other period of 2,000 clocks, ARREADY waits for ARVALID.
    model->axi_arready_i =
        random() % 8 < eager && (clock / 2'000 % 2 == 0 || model->axi_arvalid_o != 0);
    // Sometimes not ready for so long that several lines arrive meanwhile, at any port width.
    model->line_ready_i = random() % 8 < 8 - eager / 2 && clock / 300 % 4 != 3;
    // Offers a beat of any open burst; an offered beat stays until it is taken.
    if (model->axi_rvalid_i == 0 && random() % 8 < eager) {
      const unsigned id = random() % kIds;
      if (bursts[id].open) {
        std::vector<std::uint32_t> words(beat_words);
        for (unsigned n = 0; n < beat_words; ++n) {
          words[n] = word_of(bursts[id].line, bursts[id].beat * beat_words + n);
        }
        set_words(model->axi_rdata_i, words);
        const bool last = bursts[id].beat + 1 == beats, wrong_last = random() % 64 == 0;
        model->axi_rresp_i = random() % 64 == 0 ? 2 : 0;
        model->axi_rlast_i = last != wrong_last;
        fails = model->axi_rresp_i != 0 || wrong_last;
        model->axi_rid_i = answering = id;
        model->axi_rvalid_i = 1;
      }
    }
    model.eval();
    const bool read = (model->read_valid_i & model->read_ready_o) != 0;
    const bool asked = (model->axi_arvalid_o & model->axi_arready_i) != 0;
    const bool answered = (model->axi_rvalid_i & model->axi_rready_o) != 0;
    if (read) waiting[model->read_id_i] = model->read_line_i;
    ASSERT_LE(waiting.size(), kIds + 1) << "a tag has no line";
    full += waiting.size() >= kIds && model->read_valid_i != 0 && !read;
    if (asked) {
      const unsigned id = model->axi_arid_o;
      ASSERT_FALSE(bursts[id].open) << "an ID of its own";
      ASSERT_EQ(model->axi_arlen_o, beats - 1);
      ASSERT_EQ(1u << model->axi_arsize_o, 4 * beat_words);
      ASSERT_EQ(model->axi_arburst_o, 1);
      ASSERT_EQ(model->axi_araddr_o, address);
      bursts[id] = {true, line, 0};
    }
    if (read) {
      line = model->read_line_i;
      address = (model->base_i & ~std::uint64_t{63}) + 64 * std::uint64_t{line};
    }
    failing += answered && fails;
    if (answered && fails) failing_lines.insert(bursts[answering].line);
    failed += model->bus_error_o;
    if (model->bus_error_o != 0) {
      ASSERT_TRUE(failing_lines.contains(model->error_number_o));
    }
    ASSERT_LE(failed, failing);
    if ((model->line_valid_o & model->line_ready_i) != 0) {
      const auto tag = waiting.find(model->line_id_o);
      ASSERT_NE(tag, waiting.end()) << "a tag that waits";
      ASSERT_EQ(model->line_error_o, failing_lines.contains(tag->second));
      for (unsigned n = 0; n < 16; ++n) ASSERT_EQ(model->line_o[n], word_of(tag->second, n));
      failing_lines.erase(tag->second);
      waiting.erase(tag);
      ++given;
    }
    model.clock();
    if (read) model->read_valid_i = 0;
    if (answered) {
      model->axi_rvalid_i = 0;
      mixed += answering != last_id && bursts[last_id].open && bursts[last_id].beat != 0;
      last_id = answering;
      if (++bursts[answering].beat == beats) bursts[answering].open = false;
    }
  }
  EXPECT_GT(given, 400u);
  EXPECT_GT(full, 100u);
  EXPECT_GT(failed, 10u);
  EXPECT_LE(failing - failed, 2u) << "beats that wait";
  EXPECT_GE(mixed, beats > 1 ? 1'000u : 0u);
}

}  // namespace
}  // namespace raygate
