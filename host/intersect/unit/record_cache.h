// Record cache: the polygon records of a common origin, each made on first use.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <mutex>

#include "host/bvh/bvh.h"
#include "host/intersect/polygon_record.h"

namespace raygate {

/// One record per primitive of the BVH, made leaf by leaf. Thread-safe: the first thread makes a
/// record, others wait for it. Takes 65 bytes per primitive; untouched pages take no memory.
class RecordCache {
 public:
  RecordCache(const Bvh& bvh, const glm::vec3& origin);

  [[nodiscard]] const glm::vec3& origin() const { return origin_; }

  /// Returns the records of primitives [first, first + count), at least one. Adds the number of
  /// records that had to be made to `made`.
  [[nodiscard]] const PolygonRecord* leaf(std::uint32_t first, std::uint32_t count,
                                          std::uint64_t& made) {
    for (std::uint32_t primitive = first; primitive < first + count; ++primitive) {
      if (states_[primitive].load(std::memory_order_acquire) != State::kMade) {
        made += make(first, count);
        break;
      }
    }
    return records_.get() + first;
  }

 private:
  enum class State : std::uint8_t { kNone, kBusy, kMade };

  struct Free {
    void operator()(void* memory) const;
  };

  std::uint64_t make(std::uint32_t first, std::uint32_t count);
  bool claim(std::uint32_t primitive);

  const Bvh& bvh_;
  glm::vec3 origin_;
  std::unique_ptr<PolygonRecord[], Free> records_;
  std::unique_ptr<std::atomic<State>[]> states_;  // by primitive
};

/// The caches of all common origins of a scene, each made on first use. Thread-safe.
class RecordCaches {
 public:
  /// `on_first_touch`: records are made when a ray approaches their polygon, otherwise all records
  /// of an origin at once. `bvh` must outlive this object.
  explicit RecordCaches(const Bvh& bvh, bool on_first_touch = true)
      : bvh_(bvh), on_first_touch_(on_first_touch) {}

  /// Returns the cache of an origin. Adds the number of records that had to be made to `made`.
  [[nodiscard]] RecordCache& at(const glm::vec3& origin, std::uint64_t& made);

 private:
  const Bvh& bvh_;
  bool on_first_touch_;
  std::mutex mutex_;
  std::map<std::array<std::uint32_t, 3>, RecordCache> caches_;  // by the origin's bits
};

}  // namespace raygate
