// This project as a peer, used like in the renderer: the rays of a tile at a time, exact arithmetic
// for doubts of float32, and P for every nearest hit.
#include <algorithm>
#include <memory>
#include <vector>

#include "host/bvh/bvh.h"
#include "host/intersect/cpu/cpu_intersector.h"
#include "host/lab/rays/rays.h"

namespace raygate::lab {
namespace {

class RaygatePeer : public Peer {
 public:
  explicit RaygatePeer(const Scene& scene) : bvh_(scene) {}

  [[nodiscard]] const std::string& name() const override { return name_; }

  void prepare(const RaySet& set) override { set_ = &set; }

  void run(Found& found) override {
    CpuIntersector intersector(bvh_);
    const std::span<const Ray> rays(set_->rays);
    std::vector<NearestHit> hits(intersector.traits().batch);
    for (std::size_t first = 0; first < rays.size(); first += hits.size()) {
      const std::size_t count = std::min(hits.size(), rays.size() - first);
      set_->find(intersector, first, std::span(hits).first(count));
      for (std::size_t i = 0; i < count; ++i) {
        found.triangle[first + i] = triangle_of(hits[i]);
        found.t[first + i] = static_cast<float>(hits[i].t.low);
      }
    }
  }

 private:
  [[nodiscard]] std::uint32_t triangle_of(const NearestHit& hit) const {
    // Branchless, as a branch on the ray's hit would be unpredictable.
    const std::uint32_t found = hit.primitive != NearestHit::kNone ? 1 : 0;
    static_assert(Found::kNone == ~std::uint32_t{0});
    const std::uint32_t triangle = bvh_.triangle_of(hit.primitive & (0 - found));
    return (set_->any_hit ? Found::kSome : triangle) | (found - 1);
  }

  std::string name_ = "raygate";
  Bvh bvh_;
  const RaySet* set_ = nullptr;
};

}  // namespace

std::unique_ptr<Peer> make_raygate(const Scene& scene) {
  return std::make_unique<RaygatePeer>(scene);
}

}  // namespace raygate::lab
