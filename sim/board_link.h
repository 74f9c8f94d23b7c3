// Link to a Verilated board_core and the SDRAM at its pins.
#pragma once

#include <deque>
#include <stdexcept>

#include "host/intersect/core/linked_core.h"
#include "sim/model.h"
#include "sim/sdram_model.h"

namespace raygate {

/// Transfers up to one word per clock in each direction. `Top`: Verilator's class of board_core.
/// Throws std::runtime_error if the board neither takes nor sends a word for kPatience clocks.
template <class Top>
class BoardLink : public WordLink {
 public:
  BoardLink() {
    model_->word_valid_i = model_->break_i = 0;
    model_->word_ready_i = 1;
    model_->sdram_data_i = 0;
    model_.reset();
  }

  bool send(std::uint32_t word) override {
    if (model_->word_valid_i != 0) return false;
    model_->word_valid_i = 1;
    model_->word_i = word;
    return true;
  }
  std::optional<std::uint32_t> receive() override {
    if (received_.empty()) return std::nullopt;
    const std::uint32_t word = received_.front();
    received_.pop_front();
    return word;
  }
  void wait() override {
    const bool taken = (model_->word_valid_i & model_->word_ready_o) != 0;
    const bool given = model_->word_valid_o != 0;
    if (given) received_.push_back(model_->word_o);
    quiet_ = taken || given ? 0 : quiet_ + 1;
    if (quiet_ > kPatience) {
      throw std::runtime_error("board_core: no word for " + std::to_string(kPatience) + " clocks");
    }
    model_.clock();
    if (taken) model_->word_valid_i = 0;
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
  void restart() override {
    model_->word_valid_i = 0;
    model_->break_i = 1;
    wait();
    model_->break_i = 0;
    for (quiet_ = 0; quiet_ < kQuiet;) wait();
    received_.clear();
  }
  [[nodiscard]] std::uint64_t clocks() const override { return model_.clocks(); }

 private:
  static constexpr int kPatience = 100'000, kQuiet = 100;
  static constexpr double kClockMhz = 40.0;  // board_core's ClockMhz

  Model<Top> model_;
  SdramModel sdram_{kClockMhz};
  std::deque<std::uint32_t> received_;
  int quiet_ = 0;
};

}  // namespace raygate
