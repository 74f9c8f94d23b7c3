// This project's answers, as the renderer gets them: a wavefront a tile, polygon records made on
// first touch (none is left from the run before), exact arithmetic for what float32 leaves open,
// and P for every hit.
#include <algorithm>
#include <memory>
#include <optional>

#include "host/find/unit/cpu_hit_tester.h"
#include "host/find/unit/record_cache.h"
#include "host/find/unit/wavefront.h"
#include "host/lab/rays/peer.h"
#include "host/tree/bvh.h"

namespace raygate::rays {
namespace {

constexpr std::size_t kTileRays = std::size_t{128} * 128;  // as many as the renderer traces at once

class RaygatePeer : public Peer {
 public:
  explicit RaygatePeer(const Scene& scene) : bvh_(scene) {}

  [[nodiscard]] const std::string& name() const override { return name_; }

  void prepare(const RaySet& set) override { set_ = &set; }

  void run(Found& found) override {
    CpuHitTester tester;
    Wavefront wavefront(bvh_, tester);
    std::optional<RecordCache> records;
    Search search;
    if (set_->common_origin) search.common = &records.emplace(bvh_, set_->rays[0].origin);
    const std::span<const Ray> rays(set_->rays);
    for (std::size_t first = 0; first < rays.size(); first += kTileRays) {
      const std::size_t count = std::min(kTileRays, rays.size() - first);
      if (!set_->limits.empty()) search.limits = std::span(set_->limits).subspan(first, count);
      if (set_->any_hit) search.enough_before = search.limits;
      wavefront.trace(rays.subspan(first, count), search);
      for (std::size_t i = 0; i < count; ++i) {
        const NearestHit& hit = wavefront.nearest(i);
        found.triangle[first + i] = triangle_of(hit);
        found.t[first + i] = static_cast<float>(hit.t.low);
      }
    }
  }

 private:
  [[nodiscard]] std::uint32_t triangle_of(const NearestHit& hit) const {
    if (hit.slot == NearestHit::kNone) return Found::kNone;
    return set_->any_hit ? Found::kSome : bvh_.triangle_of(hit.slot);
  }

  std::string name_ = "raygate";
  Bvh bvh_;
  const RaySet* set_ = nullptr;
};

}  // namespace

std::unique_ptr<Peer> make_raygate(const Scene& scene) {
  return std::make_unique<RaygatePeer>(scene);
}

}  // namespace raygate::rays
