#include "host/light/neighbor_clearance.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <utility>

#include "host/bvh/closest_point.h"
#include "host/light/neighbor_clearance_search.h"

namespace raygate {
namespace {

/// Updates the search for `primitive` with the triangles of a leaf, except `primitive` itself.
template <Vectors kCode>
RAYGATE_INLINE void take_in(const Bvh& bvh, const Bvh::Child& leaf, std::uint32_t primitive,
                            NeighborClearanceSearch& search) {
  LaneMask rest = (LaneMask{1} << leaf.count) - 1;
  Bvh::LeafRoom room;
  const float* const corners = BvhView(bvh).corners_of(leaf, room);
  rest &= ~search.behind_an_edge<kCode>(corners, leaf.count);
  if (primitive - leaf.first < leaf.count) rest &= ~(LaneMask{1} << (primitive - leaf.first));
  if (rest == 0) return;
  const LeafCorners others(VectorCode<kCode>{}, corners, leaf.count, search.from());
  rest &= search.near(others);
  if (rest != 0) rest &= ~search.beyond_their_edge(others);
  for (; rest != 0; rest &= rest - 1) {
    const std::uint32_t other = leaf.first + static_cast<std::uint32_t>(std::countr_zero(rest));
    search.consider(other, bvh.corners_of(other));
  }
}

float largest_coordinate(const Bvh& bvh) {
  float size = 0.0f;
  for (int i = 0; i < Bvh::kWidth; ++i) {
    const auto [low, high] = bvh.nodes()[0].box(i);
    if (low.x <= high.x) size = std::max({size, largest(low), largest(high)});
  }
  return size;
}

}  // namespace

void Overlaps::add(std::uint32_t primitive, const Corners& triangle) {
  const auto lane = static_cast<int>(primitives_.size() % kLanes);
  primitives_.push_back(primitive);
  if (lane == 0) {
    Boxes& empty = boxes_.emplace_back();
    for (int k = 0; k < 3; ++k) {
      std::ranges::fill(empty.low[k], std::numeric_limits<float>::infinity());
      std::ranges::fill(empty.high[k], -std::numeric_limits<float>::infinity());
    }
  }
  for (int k = 0; k < 3; ++k) {
    boxes_.back().low[k][lane] = std::min({triangle[0][k], triangle[1][k], triangle[2][k]});
    boxes_.back().high[k][lane] = std::max({triangle[0][k], triangle[1][k], triangle[2][k]});
  }
}

bool lies_beyond(const Corners& other, const Corners& hit, int side) {
  return std::ranges::all_of(
      other, [&](const glm::vec3& vertex) { return orient3d(vertex, hit) != side; });
}

// A float step is at most 2^-23 of the value, or 2^-149.
double spawn_reach(const Corners& corners) {
  const float size = std::max({largest(corners[0]), largest(corners[1]), largest(corners[2])});
  return std::max(0x1p-18 * size, 0x1p-144);
}

// The error of a coordinate along a unit vector, of a difference of two points, is less than 2^-49
// times their largest coordinate.
NeighborClearances::NeighborClearances(const Bvh& bvh)
    : bvh_(bvh),
      margin_(0x1p-45f * largest_coordinate(bvh)),
      slack_(0x1p-47 * largest_coordinate(bvh)),
      known_(std::make_unique<Known[]>(bvh.primitive_count())) {}

NeighborClearances::Found NeighborClearances::look(std::uint32_t primitive) const {
  const Corners corners = bvh_.corners_of(primitive);
  NeighborClearanceSearch search(corners, slack_);
  if (search.has_hope()) {
    in_vectors([&](auto code) RAYGATE_BODY {
      // Leaves are processed some time after they are found, when they are in the cache.
      constexpr std::size_t kMostWaiting = 16;
      Bvh::Child waiting[kMostWaiting];
      std::size_t count = 0;
      const auto look = [&]() RAYGATE_BODY {
        for (std::size_t i = 0; i < count; ++i)
          take_in<code()>(bvh_, waiting[i], primitive, search);
        count = 0;
      };
      const auto found = [&](const Bvh::Child& leaf) RAYGATE_BODY {
        if (count == kMostWaiting) look();
        waiting[count++] = leaf;
        return false;
      };
      (void)any_leaf_near<code()>(bvh_, search.low(), search.high(), found);
      look();
    });
  }
  return {search.found(), std::move(search.overlaps())};
}

const NeighborClearance& NeighborClearances::find(std::uint32_t primitive) const {
  Found looked = look(primitive);
  Known& known = known_[primitive];
  const std::lock_guard lock(mutex_);
  const NeighborClearance& found = clearances_.emplace_back(looked.clearance);
  if (found.length < 0.0f) {
    known.overlaps.store(&overlaps_.emplace_back(std::move(looked.overlaps)),
                         std::memory_order_relaxed);
  }
  known.clearance.store(&found, std::memory_order_release);
  return found;
}

}  // namespace raygate
