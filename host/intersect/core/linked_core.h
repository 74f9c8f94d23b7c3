// Linked core: a ray core with a memory of its own, behind a link that carries words.
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "host/intersect/core/core_unit.h"

namespace raygate {

/// Words to a board and from it, hw/board/core_link.sv's, in their order.
class WordLink {
 public:
  virtual ~WordLink() = default;

  /// Whether the word is taken; if not, it is to be offered again.
  virtual bool send(std::uint32_t word) = 0;
  /// The next word that came, if there is one.
  virtual std::optional<std::uint32_t> receive() = 0;
  /// Lets time pass: a clock in simulation. Throws where the board is silent for too long.
  virtual void wait() = 0;
  /// Clocks since it was made; 0 where nothing is simulated.
  [[nodiscard]] virtual std::uint64_t clocks() const { return 0; }
};

/// Sends the memory when it has changed, then rays, no more at a time than the core holds, for a
/// link may have no way to make its host wait. Counters: rays, triangles, doubts, and the clocks
/// with rays; the board tells no others.
class LinkedCore : public CoreUnit {
 public:
  LinkedCore(std::unique_ptr<WordLink> link, std::size_t rays)
      : link_(std::move(link)), most_(rays) {}

  void trace(std::span<const MemoryLine> lines, std::span<const CoreRay> rays,
             std::vector<CoreResult>& results) override;
  [[nodiscard]] CoreCounters counters() const override { return counters_; }

 private:
  void load(std::span<const MemoryLine> lines);
  /// The result that became whole with the words that came, if there is one.
  std::optional<CoreResult> take_result();
  void count(const CoreResult& result);

  std::unique_ptr<WordLink> link_;
  std::size_t most_;
  std::vector<MemoryLine> memory_;    ///< what the board holds
  std::vector<std::uint32_t> words_;  ///< of a result that is not whole
  CoreCounters counters_;
};

}  // namespace raygate
