#include "host/intersect/unit/record_cache.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>
#include <new>
#include <span>
#include <thread>

#include "host/intersect/polygon_record.h"

namespace raygate {
namespace {

constexpr std::uint32_t kBatch = 4 * Bvh::kMaxLeafSize;  // records made at once

}  // namespace

void RecordCache::Free::operator()(void* memory) const { std::free(memory); }

RecordCache::RecordCache(const Bvh& bvh, const glm::vec3& origin) : bvh_(bvh), origin_(origin) {
  const std::size_t primitives = std::max<std::size_t>(bvh.primitive_count(), 1);
  // Not initialised on purpose: a page takes no memory until a record is written to it.
  records_.reset(static_cast<PolygonRecord*>(
      std::aligned_alloc(alignof(PolygonRecord), primitives * sizeof(PolygonRecord))));
  if (records_ == nullptr) throw std::bad_alloc();
  states_ = std::make_unique<std::atomic<State>[]>(primitives);
}

std::uint64_t RecordCache::make(std::uint32_t first, std::uint32_t count) {
  std::uint64_t made = 0;
  const std::uint32_t end = first + count;
  for (std::uint32_t primitive = first; primitive < end;) {
    const std::uint32_t begin = primitive;
    std::array<Corners, kBatch> corners;
    for (; primitive < end && primitive - begin < kBatch && claim(primitive); ++primitive) {
      corners[primitive - begin] = bvh_.corners_of(primitive);
    }
    if (const std::uint32_t claimed = primitive - begin; claimed != 0) {
      make_records(origin_, std::span(corners).first(claimed),
                   std::span(&records_[begin], claimed));
      made += claimed;
      for (std::uint32_t i = begin; i < primitive; ++i) {
        states_[i].store(State::kMade, std::memory_order_release);
      }
    }
    if (primitive < end && primitive - begin < kBatch) ++primitive;  // made by another thread
  }
  for (std::uint32_t primitive = first; primitive < end; ++primitive) {
    while (states_[primitive].load(std::memory_order_acquire) != State::kMade)
      std::this_thread::yield();
  }
  return made;
}

bool RecordCache::claim(std::uint32_t primitive) {
  State expected = State::kNone;
  return states_[primitive].compare_exchange_strong(expected, State::kBusy);
}

RecordCache& RecordCaches::at(const glm::vec3& origin, std::uint64_t& made) {
  const std::scoped_lock lock(mutex_);
  const auto [at, is_new] =
      caches_.try_emplace(std::bit_cast<std::array<std::uint32_t, 3>>(origin), bvh_, origin);
  const std::uint32_t primitives = bvh_.primitive_count();
  if (is_new && !on_first_touch_ && primitives != 0) (void)at->second.leaf(0, primitives, made);
  return at->second;
}

}  // namespace raygate
