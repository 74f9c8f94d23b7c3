// Which single faults of a netlist (sim/mutate/netlist.py) test vectors catch.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim/model.h"

namespace raygate {

/// The faults of `Top` that nothing has caught so far.
template <class Top>
class Faults {
 public:
  /// Of these faults; of number 0, the sound netlist, too: it must not differ.
  explicit Faults(std::vector<std::uint32_t> faults) : alive_(std::move(faults)) {
    alive_.insert(alive_.begin(), 0);
  }

  /// Runs `cases` with every fault until one of them shows it. `differs(model, case)` sets inputs,
  /// evaluates and compares. Throws std::logic_error where the sound netlist differs.
  template <class Case, class Differs>
  void run(const std::vector<Case>& cases, const Differs& differs) {
    std::erase_if(alive_, [&](std::uint32_t fault) {
      model_->mutant = fault;
      const bool caught =
          std::ranges::any_of(cases, [&](const Case& one) { return differs(model_, one); });
      if (caught && fault == 0) throw std::logic_error("the netlist without a fault is wrong");
      return caught;
    });
    cases_ += cases.size();
  }

  [[nodiscard]] std::uint64_t cases() const { return cases_; }

  /// Those not caught.
  [[nodiscard]] std::vector<std::uint32_t> survivors() const {
    return {alive_.begin() + 1, alive_.end()};
  }

 private:
  Model<Top> model_;
  std::vector<std::uint32_t> alive_;
  std::uint64_t cases_ = 0;
};

/// Collects cases and hands them on in blocks, small ones first: most faults are caught at once.
template <class Case>
class Blocks {
 public:
  using Sink = std::function<void(const std::vector<Case>&)>;

  explicit Blocks(Sink sink) : sink_(std::move(sink)) {}

  void add(const Case& one) {
    block_.push_back(one);
    if (block_.size() == size_) flush();
  }

  void flush() {
    if (!block_.empty()) sink_(block_);
    block_.clear();
    size_ = std::min<std::size_t>(2 * size_, 1 << 14);
  }

 private:
  Sink sink_;
  std::vector<Case> block_;
  std::size_t size_ = 16;
};

}  // namespace raygate
