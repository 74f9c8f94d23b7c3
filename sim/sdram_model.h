// SDRAM of 16 bits at its pins: 4 banks of 8,192 rows of 512 words, CAS latency 2, single words.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace raygate {

/// SDRAM by the data sheets of MT48LC16M16A2 and AS4C16M16. The SDRAM takes a command between two
/// edges of its user's clock. Read data is valid at the second edge after the edge that puts out
/// the command. Throws std::runtime_error if the user violates a data sheet: a command too early, a
/// row that is not open, a refresh too late.
class SdramModel {
 public:
  /// State of the pins in a clock.
  struct Pins {
    bool ras_n = true, cas_n = true, we_n = true;
    unsigned bank = 0, address = 0;
    bool drives = false;
    std::uint16_t data = 0;
  };

  explicit SdramModel(double clock_mhz)
      : clock_ns_(1000.0 / clock_mhz), words_(std::size_t{1} << 24) {}

  /// Takes the pins after the user's last clock edge; returns the data pins at the next edge.
  std::uint16_t clock(const Pins& pins) {
    ++now_;
    const std::uint16_t out = coming_;
    coming_ = kNoise;
    const unsigned command =
        (pins.ras_n ? 4u : 0u) | (pins.cas_n ? 2u : 0u) | (pins.we_n ? 1u : 0u);
    if (pins.drives != (command == kWrite)) broken("data is driven beside a write");
    if (command == kNone) return out;
    if (now_ < ready_at_) broken("a command while it is busy");
    Bank& bank = banks_[pins.bank];
    const bool is_all = (pins.address & kAll) != 0;
    switch (command) {
      case kActivate:
        need(is_set_ && bank.row < 0, "a row is opened");
        need(now_ >= bank.free_at, "a row is opened early");
        check_refresh();
        bank.row = static_cast<int>(pins.address);
        bank.words_at = now_ + clocks(20.0);
        bank.closes_at = now_ + clocks(45.0);
        break;
      case kRead:
      case kWrite: {
        need(bank.row >= 0 && now_ >= bank.words_at, "a word of no open row");
        std::uint16_t& word =
            words_[pins.bank << 22 | static_cast<unsigned>(bank.row) << 9 | (pins.address & 511)];
        if (command == kRead) coming_ = word;
        if (command == kWrite) word = pins.data;
        if (is_all) {
          const std::uint64_t behind = now_ + (command == kWrite ? clocks(15.0) + 1 : 1);
          bank.row = -1;
          bank.free_at = std::max(behind, bank.closes_at) + clocks(20.0);
        }
        break;
      }
      case kPrecharge:
        need(is_all && now_ * clock_ns_ >= 200'000.0, "the first command before 200 us");
        for (Bank& each : banks_) each = {-1, 0, 0, now_ + clocks(20.0)};
        is_precharged_ = true;
        break;
      case kRefresh:
        need(is_precharged_, "refresh before precharge");
        for (const Bank& each : banks_) {
          need(each.row < 0 && now_ >= each.free_at, "refresh of an open row");
        }
        check_refresh();
        ++refreshes_;
        refreshed_at_ = now_;
        ready_at_ = now_ + clocks(70.0);
        break;
      case kMode:
        need(refreshes_ >= 2 && pins.bank == 0 && pins.address == 0x20, "its mode is set");
        is_set_ = true;
        ready_at_ = now_ + 2;
        break;
      default:
        broken("a burst is ended");
    }
    return out;
  }

 private:
  struct Bank {
    int row = -1;                                            // -1: no open row
    std::uint64_t words_at = 0, closes_at = 0, free_at = 0;  // earliest clocks: word, close, open
  };

  // Commands: bits RAS, CAS, WE, active low. kAll: the address bit for auto-precharge or all banks.
  static constexpr unsigned kNone = 7, kActivate = 3, kRead = 5, kWrite = 4, kPrecharge = 2,
                            kRefresh = 1, kMode = 0, kAll = 1u << 10;
  static constexpr std::uint16_t kNoise = 0xA5A5;  // read while no device drives the data pins

  [[nodiscard]] std::uint64_t clocks(double ns) const {
    const auto whole = static_cast<std::uint64_t>(ns / clock_ns_);
    return static_cast<double>(whole) * clock_ns_ < ns ? whole + 1 : whole;
  }
  [[noreturn]] void broken(const std::string& what) const {
    throw std::runtime_error("SDRAM, clock " + std::to_string(now_) + ": " + what);
  }
  void need(bool holds, const char* what) const {
    if (!holds) broken(what);
  }
  /// Checks the time since the last refresh: 64 ms / 8,192 rows = 7.8125 us at most.
  void check_refresh() const {
    need(!is_set_ || static_cast<double>(now_ - refreshed_at_) * clock_ns_ <= 7'812.5,
         "a refresh is late");
  }

  double clock_ns_;
  std::vector<std::uint16_t> words_;
  std::array<Bank, 4> banks_{};
  std::uint64_t now_ = 0, ready_at_ = 0, refreshed_at_ = 0, refreshes_ = 0;
  std::uint16_t coming_ = kNoise;
  bool is_precharged_ = false, is_set_ = false;
};

}  // namespace raygate
