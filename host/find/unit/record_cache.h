// The polygon records of one common origin, each made when a ray first comes near its polygon.
#pragma once

#include <atomic>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>

#include "host/find/unit/polygon_record.h"
#include "host/tree/bvh.h"

namespace raygate {

/// Room for a record per slot of the tree, filled leaf by leaf. Threads may ask at once: the first
/// one makes a record, the others wait for it. 65 bytes a slot; pages nobody touches
/// cost nothing.
class RecordCache {
 public:
  RecordCache(const Bvh& bvh, const glm::vec3& origin);

  [[nodiscard]] const glm::vec3& origin() const { return origin_; }

  /// The records of the slots first .. first + count, at least one.
  [[nodiscard]] const PolygonRecord* leaf(std::uint32_t first, std::uint32_t count) {
    for (std::uint32_t slot = first; slot < first + count; ++slot) {
      if (states_[slot].load(std::memory_order_acquire) != State::kMade) {
        make(first, count);
        break;
      }
    }
    return records_.get() + first;
  }

  /// Makes the records that are not there yet. Not while others ask.
  void make_all();

  /// Records made so far, once no thread is asking.
  [[nodiscard]] std::uint64_t made() const { return made_; }

 private:
  enum class State : std::uint8_t { kNone, kBusy, kMade };

  struct Free {
    void operator()(void* memory) const;
  };

  void make(std::uint32_t first, std::uint32_t count);
  bool claim(std::uint32_t slot);

  const Bvh& bvh_;
  glm::vec3 origin_;
  std::unique_ptr<PolygonRecord[], Free> records_;
  std::unique_ptr<std::atomic<State>[]> states_;  // of the slots
  std::atomic<std::uint64_t> made_{0};
};

}  // namespace raygate
