// Words pass an 8N1 serial line unchanged, at the line's bit rate.
#include <gtest/gtest.h>

#include <deque>
#include <random>
#include <vector>

#include "Vuart_pair.h"
#include "Vuart_pair___024root.h"
#include "sim/model.h"

namespace raygate {
namespace {

constexpr int kClocksPerBit = 5;  // as in uart_pair.sv

class UartTest : public testing::Test {
 protected:
  UartTest() {
    model_->valid_i = model_->low_i = 0;
    model_.reset();
  }

  void clock() {
    model_.clock();
    if (model_->valid_o != 0) received_.push_back(model_->word_o);
    breaks_ += model_->break_o;
  }
  void send(std::uint32_t word) {
    model_->valid_i = 1;
    model_->word_i = word;
    while (model_->ready_o == 0) clock();
    clock();
    model_->valid_i = 0;
  }
  void wait(int clocks) {
    for (; clocks > 0; --clocks) clock();
  }

  Model<Vuart_pair> model_;
  std::vector<std::uint32_t> received_;
  int breaks_ = 0;
};

TEST_F(UartTest, WordsArrive) {
  std::mt19937 random(1);
  std::vector<std::uint32_t> sent{0, 0xFFFFFFFF, 0x55AA55AA};
  while (sent.size() < 300) sent.push_back(random());
  const std::uint64_t begin = model_.clocks();
  for (const std::uint32_t word : sent) {
    if (random() % 4 == 0) wait(static_cast<int>(random() % 50));
    send(word);
  }
  wait(41 * kClocksPerBit);
  EXPECT_EQ(received_, sent);
  EXPECT_EQ(breaks_, 0);
  EXPECT_GE(model_.clocks() - begin, 40 * kClocksPerBit * sent.size());
}

/// 8N1 bit by bit: a start bit, eight data bits, lowest first, a stop bit; four bytes per word.
TEST_F(UartTest, BitsAreTheStandards) {
  send(0x0180FF53);
  std::vector<bool> expected;
  for (const unsigned byte : {0x53u, 0xFFu, 0x80u, 0x01u}) {
    expected.push_back(false);
    for (unsigned bit = 0; bit < 8; ++bit) expected.push_back((byte >> bit & 1) != 0);
    expected.push_back(true);
  }
  std::vector<bool> got;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    wait(kClocksPerBit / 2);
    got.push_back(model_->serial_o != 0);
    wait(kClocksPerBit - kClocksPerBit / 2);
  }
  EXPECT_EQ(got, expected);
}

/// A line held low causes one break and no word. The next words are complete.
TEST_F(UartTest, ABreakStartsAWordAnew) {
  send(0x12345678);
  wait(15 * kClocksPerBit);  // in the word's second byte
  model_->low_i = 1;
  wait(60 * kClocksPerBit);
  model_->low_i = 0;
  wait(20 * kClocksPerBit);
  EXPECT_TRUE(received_.empty());
  EXPECT_EQ(breaks_, 1);
  send(0xCAFE0123);
  wait(41 * kClocksPerBit);
  EXPECT_EQ(received_, (std::vector<std::uint32_t>{0xCAFE0123}));
}

}  // namespace
}  // namespace raygate
