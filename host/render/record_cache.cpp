#include "host/render/record_cache.h"

#include <algorithm>
#include <cstdlib>
#include <new>
#include <thread>

namespace raygate {

void RecordCache::Free::operator()(void* memory) const { std::free(memory); }

RecordCache::RecordCache(const Bvh& bvh, const glm::vec3& origin) : bvh_(bvh), origin_(origin) {
  const std::size_t slots = std::max<std::size_t>(bvh.slot_count(), 1);
  // Not initialised on purpose: a page is the system's until a record is written to it.
  records_.reset(static_cast<PolygonRecord*>(
      std::aligned_alloc(alignof(PolygonRecord), slots * sizeof(PolygonRecord))));
  if (records_ == nullptr) throw std::bad_alloc();
  states_ = std::make_unique<std::atomic<State>[]>(slots);
}

void RecordCache::make(std::uint32_t first, std::uint32_t count) {
  State expected = State::kNone;
  if (!states_[first].compare_exchange_strong(expected, State::kBusy)) {
    while (states_[first].load(std::memory_order_acquire) != State::kMade) {
      std::this_thread::yield();
    }
    return;
  }
  for (std::uint32_t slot = first; slot < first + count; ++slot) {
    new (&records_[slot]) PolygonRecord(make_record(origin_, bvh_.corners_of(slot)));
  }
  made_.fetch_add(count, std::memory_order_relaxed);
  states_[first].store(State::kMade, std::memory_order_release);
}

}  // namespace raygate
