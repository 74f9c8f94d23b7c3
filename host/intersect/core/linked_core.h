// Linked core: a ray core with its own memory, behind a word link.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "host/intersect/core/core_intersector.h"

namespace raygate {

/// Decodes ray_core_pkg::result_t.
template <class Words>
CoreResult unpack_result(const Words& words) {
  PackedFields fields(words);
  CoreResult result;
  result.error = static_cast<CoreResult::Error>(fields.take(3));
  result.tests = fields.take(28);
  result.point = fields.take_vector();
  result.t_error = fields.take(5);
  result.t = fields.take_float();
  result.triangle = fields.take();
  result.found = fields.take(1) != 0;
  result.tag = fields.take();
  result.kind = static_cast<CoreResult::Kind>(fields.take(1));
  return result;
}

/// Returns the message that sends a ray to hw/board/core_link.sv.
[[nodiscard]] std::array<std::uint32_t, 11> ray_message(const CoreRay& ray);

/// An ordered link of words to and from a board (hw/board/core_link.sv).
class WordLink {
 public:
  virtual ~WordLink() = default;

  /// Sends a word; returns false if it was not accepted and must be sent again.
  virtual bool send(std::uint32_t word) = 0;
  /// Returns the next received word, or none.
  virtual std::optional<std::uint32_t> receive() = 0;
  /// Waits for the board; in simulation, one clock. Throws if the board is silent for too long.
  virtual void wait() = 0;
  /// Sends a break, which aborts the board's message and rays; drops input until the link is quiet.
  virtual void restart() = 0;
  /// Returns simulated clocks since construction; 0 without simulation.
  [[nodiscard]] virtual std::uint64_t clocks() const { return 0; }
};

/// A ray core with its own memory, behind a link. Sends the memory when it has changed, then rays.
/// At most `rays` (the core's capacity) are in flight, since a link may have no back-pressure. Of
/// CoreCounters, only rays, tests, doubts and clocks are counted.
class LinkedCore : public CoreUnit {
 public:
  LinkedCore(std::unique_ptr<WordLink> link, std::size_t rays)
      : link_(std::move(link)), most_(rays) {
    link_->restart();
  }

  void trace(std::span<const MemoryLine> lines, std::span<const CoreRay> rays,
             std::vector<CoreResult>& results) override;
  [[nodiscard]] CoreCounters counters() const override { return counters_; }

 private:
  void load(std::span<const MemoryLine> lines);
  /// Appends the results whose words have all arrived. Returns the number of rays that ended.
  std::size_t take_results(std::vector<CoreResult>& results);

  std::unique_ptr<WordLink> link_;
  std::size_t most_;
  std::vector<MemoryLine> memory_;    ///< contents of the board's memory
  std::vector<std::uint32_t> words_;  ///< words of an incomplete result
  CoreCounters counters_;
};

/// Opens a serial port: four bytes per word, lowest first, 8N1, 2 Mbaud. InputError with the port's
/// name is thrown if the port cannot be opened, and by wait() if the board is silent for 30 s.
[[nodiscard]] std::unique_ptr<WordLink> open_serial_link(const std::filesystem::path& port);

}  // namespace raygate
