// Random traffic at the AXI ports of the ray core, compared with a small model of the core.
// Registers are read and written with pauses while the core draws and traces. Memory answers in any
// order, with errors and sometimes with noise. Results go to the stream or the buffer. There are
// aborts, and resets in mid-run. Every ray ends once, with the reference model's result or with an
// error that has a cause. RAYGATE_TRAFFIC=<epochs> sets the length (make test LONG=traffic).
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <cstring>
#include <map>
#include <random>
#include <set>
#include <vector>

#include "Vray_core_axi.h"
#include "host/intersect/core/memory_image.h"
#include "host/intersect/core/reference_core.h"
#include "host/intersect/core/test/core_cases.h"
#include "hw/ray_core/registers.h"
#include "sim/core_port.h"
#include "sim/test/ray_core/pixel_grid.h"

namespace raygate {
namespace {

constexpr std::uint32_t kSeed = 20261123;
constexpr std::uint64_t kResults = 0xFEDC'BA98'7654'3FC0;
constexpr std::uint32_t kUsers = 0x8000'0000;       // bit in the tags of the user's own rays
constexpr std::uint32_t kCapability = 0x7013'0401;  // for 16 rays and 64-bit data: registers.md
constexpr glm::vec3 kEye{0.25f, 0.3f, 2.5f};

class AxiTrafficTest : public testing::Test {
 protected:
  AxiTrafficTest() { reset(); }

  // ---- Memory, results and user's rays around the core

  struct Burst {
    std::uint32_t id;
    std::uint64_t line;
    unsigned beat = 0;
  };
  struct Sent {
    CoreRay ray;
    std::vector<CoreResult> words;
  };

  bool one_in(unsigned n) { return random_() % n == 0; }

  /// Resets the core, perhaps in mid-run: everything in flight is lost.
  void reset() {
    model_->s_axil_awvalid = model_->s_axil_wvalid = model_->s_axil_arvalid = 0;
    model_->s_axil_bready = model_->s_axil_rready = 0;
    model_->m_axi_rvalid = model_->m_axi_bvalid = 0;
    model_->ray_valid_i = 0;
    model_.reset();
    bursts_.clear();
    rays_.clear();
    words_ = {};
    enable_ = 0;
    in_flight_ = pixels_left_ = 0;
    forget_records();
    doubts_ = ray_errors_ = bad_beats_ = bad_answers_ = ends_ = 0;
    failed_lines_.clear();
    aborted_ = drawn_ = false;
    ++resets_;
  }
  void forget_records() {
    addresses_ = answered_ = 0;
    written_.clear();
  }

  [[nodiscard]] std::size_t unanswered() const {
    return std::min<std::size_t>(addresses_, written_.size() / 8) - answered_;
  }
  /// is_busy: the core is certainly busy. may_be_busy: the core may be busy, because after an abort
  /// the number of skipped rays of a rectangle is unknown.
  [[nodiscard]] bool is_busy() const {
    return in_flight_ != 0 || addresses_ != answered_ || (pixels_left_ != 0 && !aborted_);
  }
  [[nodiscard]] bool may_be_busy() const { return is_busy() || pixels_left_ != 0; }
  void look_at_busy(bool first) {
    any_busy_ = (any_busy_ && !first) || may_be_busy();
    all_busy_ = (all_busy_ || first) && is_busy();
  }

  void clock() {
    model_->m_axi_arready = !one_in(eager_);
    model_->m_axis_tready = !one_in(eager_);
    model_->m_axi_awready = !one_in(eager_);
    model_->m_axi_wready = !one_in(eager_);
    if (model_->m_axi_rvalid == 0 && !bursts_.empty() && one_in(pause_)) offer_beat();
    if (model_->m_axi_bvalid == 0 && unanswered() != 0 && one_in(pause_)) {
      model_->m_axi_bvalid = 1;
      model_->m_axi_bresp = one_in(64) ? 2 + random_() % 2 : 0;
    }
    if (model_->ray_valid_i == 0 && !to_send_.empty() && one_in(pause_)) {
      put_ray(*model_, to_send_.back());
      rays_[to_send_.back().tag] = {to_send_.back(), {}};
      to_send_.pop_back();
    }
    model_.eval();
    if ((model_->m_axi_arvalid & model_->m_axi_arready) != 0) {
      const std::uint64_t base = std::uint64_t{words_[6]} << 32 | words_[5];
      bursts_.push_back({model_->m_axi_arid, (model_->m_axi_araddr - base) / 64});
    }
    const bool beat = (model_->m_axi_rvalid & model_->m_axi_rready) != 0;
    if (beat && model_->m_axi_rresp != 0) {
      ++bad_beats_;
      failed_lines_.insert(answering_);
    }
    const bool ray = (model_->ray_valid_i & model_->ray_ready_o) != 0;
    in_flight_ += ray;
    if ((model_->m_axis_tvalid & model_->m_axis_tready) != 0) {
      std::array<std::uint32_t, 8> record;
      std::memcpy(record.data(), &model_->m_axis_tdata, sizeof record);
      ASSERT_EQ(words_[30], 0u);
      take(result_of(record));
    }
    if ((model_->m_axi_awvalid & model_->m_axi_awready) != 0) {
      ASSERT_LT(addresses_, words_[30]);
      ASSERT_EQ(model_->m_axi_awaddr, kResults + 32 * addresses_++);
    }
    if ((model_->m_axi_wvalid & model_->m_axi_wready) != 0) {
      written_.push_back(static_cast<std::uint32_t>(model_->m_axi_wdata));
      written_.push_back(static_cast<std::uint32_t>(model_->m_axi_wdata >> 32));
    }
    const bool answer = model_->m_axi_bvalid != 0;
    model_.clock();
    if (beat) model_->m_axi_rvalid = 0;
    if (ray) model_->ray_valid_i = 0;
    if (answer) {
      bad_answers_ += model_->m_axi_bresp != 0;
      model_->m_axi_bvalid = 0;
      std::array<std::uint32_t, 8> record;
      std::copy_n(&written_[8 * answered_++], 8, record.begin());
      take(result_of(record));
    }
    look_at_busy(false);
    ++clocks_;
  }

  /// Offers the next beat of any burst. Its data are noise if it has an error or wild_ is set.
  void offer_beat() {
    const std::size_t n = random_() % bursts_.size();
    Burst& burst = bursts_[n];
    const bool fails = failing_ != 0 && one_in(failing_);
    std::uint64_t data = std::uint64_t{random_()} << 32 | random_();
    const auto& lines = image_->lines();
    if (!wild_ && !fails && burst.line < lines.size()) {
      const auto& words = lines[burst.line].words;
      data = std::uint64_t{words[2 * burst.beat + 1]} << 32 | words[2 * burst.beat];
    }
    EXPECT_TRUE(wild_ || burst.line < lines.size()) << burst.line;
    answering_ = static_cast<std::uint32_t>(burst.line);
    model_->m_axi_rid = burst.id;
    model_->m_axi_rdata = data;
    model_->m_axi_rresp = fails ? 2 + random_() % 2 : 0;
    model_->m_axi_rlast = burst.beat == 7;
    model_->m_axi_rvalid = 1;
    if (++burst.beat == 8) bursts_.erase(bursts_.begin() + static_cast<std::ptrdiff_t>(n));
  }

  /// Takes a result, which must belong to a ray in flight.
  void take(const CoreResult& result) {
    doubts_ += result.kind == CoreResult::Kind::kDoubt;
    const bool generated = (result.tag & kUsers) == 0;
    if (generated && !rays_.contains(result.tag)) {
      ASSERT_TRUE(drawn_);
      rays_[result.tag] = {
          {.ray = {kEye, grid_.direction(static_cast<std::uint16_t>(result.tag),
                                         static_cast<std::uint16_t>(result.tag >> 16))}},
          {}};
    }
    const auto sent = rays_.find(result.tag);
    ASSERT_NE(sent, rays_.end());
    std::vector<CoreResult>& words = sent->second.words;
    ASSERT_TRUE(words.empty() || words.back().kind != CoreResult::Kind::kEnd)
        << "its end is its last";
    words.push_back(result);
    if (result.kind != CoreResult::Kind::kEnd) return;
    ++ends_;
    ray_errors_ += result.error != CoreResult::Error::kNone;
    --(generated ? pixels_left_ : in_flight_);
    check(sent->second);
  }

  /// Checks a ray's final result: it must be the reference model's, or an error that has a cause.
  void check(const Sent& sent) {
    const CoreResult& end = sent.words.back();
    if (end.error == CoreResult::Error::kAbort) {
      ASSERT_TRUE(aborted_);
    }
    if (end.error == CoreResult::Error::kMemory) {
      ASSERT_GT(bad_beats_, 0u);
    }
    if (end.error == CoreResult::Error::kCycle) {
      ASSERT_TRUE(wild_);
    }
    ASSERT_NE(end.error, CoreResult::Error::kDirection);
    if (wild_ || end.error != CoreResult::Error::kNone) return;
    std::vector<CoreResult> expected;
    ReferenceCore().trace(image_->lines(), {&sent.ray, 1}, expected);
    if (sent.ray.any_hit || expected.size() != 1 || sent.words.size() != 1) return;
    ++compared_;
    ASSERT_EQ(end.found, expected[0].found) << end.tag;
    if (!end.found) return;
    ASSERT_EQ(end.triangle, expected[0].triangle);
    ASSERT_EQ(end.t, expected[0].t);
    ASSERT_EQ(end.t_error, expected[0].t_error);
    ASSERT_EQ(end.point, expected[0].point);
  }

  // ---- Register accesses, with pauses; address and data come in any order

  unsigned write(std::uint32_t address, std::uint32_t data, unsigned strobes = 15) {
    model_->s_axil_awaddr = address;
    model_->s_axil_wdata = data;
    model_->s_axil_wstrb = strobes;
    look_at_busy(true);
    for (bool address_taken = false, data_taken = false; !address_taken || !data_taken;) {
      if (!address_taken && one_in(2)) model_->s_axil_awvalid = 1;
      if (!data_taken && one_in(2)) model_->s_axil_wvalid = 1;
      const bool takes_address = (model_->s_axil_awvalid & model_->s_axil_awready) != 0;
      const bool takes_data = (model_->s_axil_wvalid & model_->s_axil_wready) != 0;
      clock();
      if (takes_address) model_->s_axil_awvalid = 0;
      if (takes_data) model_->s_axil_wvalid = 0;
      address_taken |= takes_address;
      data_taken |= takes_data;
    }
    model_->s_axil_bready = 0;
    for (int n = 0; model_->s_axil_bvalid == 0; ++n) {
      EXPECT_LT(n, 4);
      clock();
    }
    const unsigned response = model_->s_axil_bresp;
    while (one_in(2)) clock();
    model_->s_axil_bready = 1;
    clock();
    model_->s_axil_bready = 0;
    return response;
  }
  std::uint32_t read(std::uint32_t address) {
    model_->s_axil_araddr = address;
    while (one_in(2)) clock();
    model_->s_axil_arvalid = 1;
    clock();
    model_->s_axil_arvalid = 0;
    while (one_in(2)) clock();
    EXPECT_EQ(model_->s_axil_rvalid, 1);
    EXPECT_EQ(model_->s_axil_rresp, 0);
    model_->s_axil_rready = 1;
    const std::uint32_t data = model_->s_axil_rdata;
    clock();
    model_->s_axil_rready = 0;
    return data;
  }
  /// Writes an `idle` register (registers.md) with writable `bits`. Returns false if refused.
  bool set(std::uint32_t address, std::uint32_t data, std::uint32_t bits = ~0u) {
    const unsigned response = write(address, data);
    EXPECT_TRUE(response == 0 ? !all_busy_ : any_busy_) << std::hex << address;
    if (response == 0) words_[address / 4] = data & bits;
    return response == 0;
  }

  void configure();
  void disturb();
  void settle();
  void start();

  Bvh bodies_{test::scene_of(test::bodies())};
  Bvh box_{test::scene_of(test::box(glm::vec3(-0.7f), glm::vec3(0.6f)))};
  MemoryImage images_[2]{MemoryImage(bodies_), MemoryImage(box_)};
  const MemoryImage* image_ = images_;
  PixelGrid grid_{};
  bool wild_ = false;     // memory returns noise
  unsigned failing_ = 0;  // one beat in this many has an error; 0: none
  unsigned eager_ = 4, pause_ = 2;
  std::mt19937 random_{kSeed};
  test::Random rays_random_;
  Model<Vray_core_axi> model_;
  std::vector<Burst> bursts_;
  std::map<std::uint32_t, Sent> rays_;  // by tag
  std::vector<CoreRay> to_send_;
  std::array<std::uint32_t, 32> words_{};  // plain registers
  std::uint32_t enable_ = 0, next_tag_ = 0;
  std::size_t addresses_ = 0, answered_ = 0;  // numbers of results: address taken, acknowledged
  std::vector<std::uint32_t> written_;
  long in_flight_ = 0, pixels_left_ = 0;
  bool any_busy_ = false, all_busy_ = false, aborted_ = false, drawn_ = false;
  std::set<std::uint32_t> failed_lines_;
  std::uint32_t answering_ = 0;  // the line of the offered beat
  unsigned doubts_ = 0, ray_errors_ = 0, bad_beats_ = 0, bad_answers_ = 0;
  unsigned ends_ = 0;  // ends since the counters were cleared
  unsigned compared_ = 0, refused_ = 0, resets_ = 0, aborts_ = 0, wild_ends_ = 0, failures_ = 0;
  std::uint64_t clocks_ = 0;
};

/// Sets another memory, camera and buffer. Must be called while nothing is traced.
void AxiTrafficTest::configure() {
  image_ = &images_[random_() % 2];
  wild_ = one_in(6);
  failing_ = one_in(3) ? 10 + random_() % 200 : 0;
  eager_ = 2 + random_() % 8;
  pause_ = 1 + random_() % 4;
  rays_.clear();
  doubts_ = ray_errors_ = bad_beats_ = bad_answers_ = 0;
  failed_lines_.clear();
  aborted_ = drawn_ = false;
  ASSERT_TRUE(set(RAYGATE_BASE, random_(), ~63u));
  ASSERT_TRUE(set(RAYGATE_BASE_HIGH, random_()));
  const auto lines = static_cast<std::uint32_t>(image_->lines().size());
  ASSERT_TRUE(set(RAYGATE_LINES, wild_ ? 100 : lines, (1u << 28) - 1));
  ASSERT_TRUE(set(RAYGATE_RESULTS, static_cast<std::uint32_t>(kResults), ~63u));
  ASSERT_TRUE(set(RAYGATE_RESULTS_HIGH, static_cast<std::uint32_t>(kResults >> 32)));
  ASSERT_TRUE(set(RAYGATE_LENGTH, one_in(2) ? 0 : 1 + random_() % 60));
  const glm::vec3 right(0.05f, 0.001f, 0.0f), down(0.0f, -0.05f, 0.002f);
  const std::uint32_t x = random_() % 1000, y = random_() % 1000;
  grid_ = {
      glm::vec3(-0.6f, 0.5f, -1.0f) - static_cast<float>(x) * right - static_cast<float>(y) * down,
      right, down};
  ASSERT_TRUE(set(RAYGATE_CORNER, y << 16 | x));
  ASSERT_TRUE(set(RAYGATE_SIZE, (1 + random_() % 12) << 16 | (1 + random_() % 12)));
  const glm::vec3 vectors[]{kEye, grid_.first, grid_.right, grid_.down};
  for (unsigned n = 0; n < 12; ++n) {
    ASSERT_TRUE(set(RAYGATE_EYE + 16 * (n / 3) + 4 * (n % 3),
                    std::bit_cast<std::uint32_t>(vectors[n / 3][static_cast<int>(n % 3)])));
  }
  ASSERT_EQ(write(RAYGATE_COMMAND, RAYGATE_COMMAND_CLEAR | RAYGATE_COMMAND_REWIND), 0u);
  ends_ = 0;
  forget_records();
  ASSERT_EQ(write(RAYGATE_FLAGS, 63), 0u);
}

/// Starts a rectangle, unless the core refuses.
void AxiTrafficTest::start() {
  const long pixels = (words_[9] & 0xFFFF) * (words_[9] >> 16);
  look_at_busy(true);
  pixels_left_ += pixels;  // before its first ray can end
  drawn_ = true;
  const long before = in_flight_;
  if (write(RAYGATE_COMMAND, RAYGATE_COMMAND_START) != 0) {
    ASSERT_TRUE(before != 0 || in_flight_ != 0 || addresses_ != answered_ || ends_ != 0);
    pixels_left_ -= pixels;
    drawn_ = false;
    ++refused_;
  }
}

/// Makes a random register access, at any time. The response must be that of registers.md.
void AxiTrafficTest::disturb() {
  const std::uint32_t word = random_() % 32, data = random_();
  switch (random_() % 8) {
    case 0:  // writes a plain register's value back
      if (word >= 7 && word < 31 && word != 10 && word != 11 && (word < 12 || word % 4 != 3)) {
        refused_ += !set(4 * word, words_[word]);
      }
      break;
    case 1:
      ASSERT_EQ(write(RAYGATE_ENABLE, data, 1), 0u);
      enable_ = data & 63;
      break;
    case 2:  // addresses without registers
      ASSERT_EQ(write(0x200 + 4 * (data % 100), data), 0u);
      ASSERT_EQ(read(0x200 + 4 * (data % 100)), 0u);
      break;
    case 3: {
      look_at_busy(true);
      const unsigned response = write(RAYGATE_COMMAND, RAYGATE_COMMAND_INVALIDATE);
      if (all_busy_) {
        ASSERT_EQ(response, 2u);
      }
      refused_ += response == 2;
      break;
    }
    case 4:
      if (!one_in(8)) break;
      aborted_ = true;
      ASSERT_EQ(write(RAYGATE_COMMAND, RAYGATE_COMMAND_ABORT), 0u);
      ++aborts_;
      break;
    default:
      if (word == 0) {
        ASSERT_EQ(read(0), 0x5247'0001u);
      }
      if (word == 3) {
        ASSERT_EQ(read(RAYGATE_ENABLE), enable_);
      }
      if (word == 1 || word >= 5) {
        if (word != 10 && word != 31) {
          ASSERT_EQ(read(4 * word), word == 11 ? kCapability : words_[word]) << word;
        }
      }
  }
}

/// Waits until nothing is traced, and empties the buffer whenever it is full. Checks the end state.
void AxiTrafficTest::settle() {
  for (int n = 0; !to_send_.empty() || model_->ray_valid_i != 0 ||
                  (read(RAYGATE_STATUS) & ~RAYGATE_STATUS_READING) != 0;
       ++n) {
    ASSERT_LT(n, 100'000) << "it does not come to an end";
    for (int i = 0; i < 10; ++i) clock();
    if ((read(RAYGATE_FLAGS) & RAYGATE_FLAGS_FULL) == 0) continue;
    ASSERT_EQ(answered_, words_[30]);
    ASSERT_EQ(read(RAYGATE_WRITTEN), answered_);
    forget_records();
    ASSERT_EQ(write(RAYGATE_COMMAND, RAYGATE_COMMAND_REWIND), 0u);
    ASSERT_EQ(write(RAYGATE_FLAGS, RAYGATE_FLAGS_FULL), 0u);
  }
  for (int n = 0; read(RAYGATE_STATUS) != 0; ++n) ASSERT_LT(n, 10'000) << "lines stay on their way";
  ASSERT_TRUE(bursts_.empty());
  ASSERT_EQ(in_flight_, 0);
  if (!aborted_) {
    ASSERT_EQ(pixels_left_, 0);
  }
  pixels_left_ = 0;
  for (const auto& [tag, sent] : rays_) {
    ASSERT_FALSE(sent.words.empty());
    ASSERT_EQ(sent.words.back().kind, CoreResult::Kind::kEnd);
    wild_ends_ += wild_;
  }
  ASSERT_EQ(read(RAYGATE_COUNTERS_RAY), ends_);
  if (bad_beats_ != 0) {
    ASSERT_TRUE(failed_lines_.contains(read(RAYGATE_ERROR_LINE)));
  }
  ASSERT_EQ(read(RAYGATE_FLAGS) & ~RAYGATE_FLAGS_FULL,
            (doubts_ != 0 ? RAYGATE_FLAGS_DOUBT : 0) | (drawn_ ? RAYGATE_FLAGS_DONE : 0) |
                (bad_beats_ != 0 ? RAYGATE_FLAGS_BUS_ERROR : 0) |
                (ray_errors_ != 0 ? RAYGATE_FLAGS_RAY_ERROR : 0) |
                (bad_answers_ != 0 ? RAYGATE_FLAGS_WRITE_ERROR : 0));
  ASSERT_EQ(model_->interrupt_o, (read(RAYGATE_FLAGS) & enable_) != 0);
}

TEST_F(AxiTrafficTest, IsAsItsModel) {
  const char* text = std::getenv("RAYGATE_TRAFFIC");
  const int epochs = text != nullptr ? std::atoi(text) : 40;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  for (int epoch = 0; epoch < epochs; ++epoch) {
    SCOPED_TRACE("epoch " + std::to_string(epoch));
    random_.seed(kSeed + static_cast<unsigned>(epoch));
    configure();
    if (HasFatalFailure()) return;
    for (int part = 0; part < 2; ++part) {
      if (one_in(2)) start();
      for (const Ray& ray : test::some_rays(test::bodies(), rays_random_, random_() % 60)) {
        CoreRay& sent = to_send_.emplace_back(CoreRay{.ray = ray, .tag = kUsers | next_tag_++});
        if (one_in(4)) sent.t_max = rays_random_.uniform(0.01f, 3.0f);
        if (one_in(4)) sent.skip_id = random_() % bodies_.primitive_count();
        sent.any_hit = one_in(8);
      }
      for (unsigned n = random_() % 60; n != 0 && !HasFatalFailure(); --n) disturb();
      if (one_in(5)) {
        to_send_.clear();
        reset();
        ASSERT_EQ(read(RAYGATE_STATUS), 0u);
        ASSERT_EQ(read(RAYGATE_FLAGS), 0u);
        part = 2;
        break;
      }
      settle();
      failures_ += bad_beats_ != 0;
      if (HasFatalFailure()) return;
      drawn_ = false;
      rays_.clear();
      ASSERT_EQ(write(RAYGATE_FLAGS, 63), 0u);
      doubts_ = ray_errors_ = bad_beats_ = bad_answers_ = 0;
      failed_lines_.clear();
      aborted_ = false;
    }
  }
  std::printf(
      "%d epochs, %llu clocks: %u rays as the reference, %u of wild memories; %u refusals, %u "
      "resets, %u times given up, "
      "%u with errors of memory\n",
      epochs, static_cast<unsigned long long>(clocks_), compared_, wild_ends_, refused_, resets_,
      aborts_, failures_);
  EXPECT_GT(compared_, 10u * static_cast<unsigned>(epochs));
  EXPECT_GT(refused_, 0u);
  EXPECT_GT(resets_, 2u);
  EXPECT_GT(wild_ends_, 0u);
  EXPECT_GT(failures_, 0u);
}

}  // namespace
}  // namespace raygate
