// The polygon records of one common origin, each made when a ray first comes near its polygon.
#pragma once

#include <atomic>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>

#include "host/accel/bvh.h"
#include "host/hit/polygon_record.h"

namespace raygate {

/// Room for a record per slot of the tree, filled leaf by leaf. Threads may ask at once: the first
/// one makes the leaf's records, the others wait for them. 65 bytes a slot; pages nobody touches
/// cost nothing.
class RecordCache {
 public:
  RecordCache(const Bvh& bvh, const glm::vec3& origin);

  /// The records of the leaf's slots first .. first + count.
  [[nodiscard]] const PolygonRecord* leaf(std::uint32_t first, std::uint32_t count) {
    if (states_[first].load(std::memory_order_acquire) != State::kMade) make(first, count);
    return records_.get() + first;
  }

  /// Records made so far, once no thread is asking.
  [[nodiscard]] std::uint64_t made() const { return made_; }

 private:
  enum class State : std::uint8_t { kNone, kBusy, kMade };

  struct Free {
    void operator()(void* memory) const;
  };

  void make(std::uint32_t first, std::uint32_t count);

  const Bvh& bvh_;
  glm::vec3 origin_;
  std::unique_ptr<PolygonRecord[], Free> records_;
  std::unique_ptr<std::atomic<State>[]> states_;  // of leaves, each at its first slot
  std::atomic<std::uint64_t> made_{0};
};

}  // namespace raygate
