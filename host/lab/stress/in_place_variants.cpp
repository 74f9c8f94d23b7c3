// The `cpu` engine's searches in place, by the way ./render goes: tree and CpuFinder.
#include <deque>

#include "host/find/cpu/cpu_finder.h"
#include "host/lab/stress/variants.h"
#include "host/lanes.h"
#include "host/tree/bvh.h"

namespace raygate::stress {
namespace {

enum class Way {
  kRays,  ///< RaySearch: one by one, whatever their origin
  kCones  ///< ConeSearch: those of one origin together
};

/// A search tells a ray's nearest hit and no more. So each triangle is alone in a tree of its own,
/// where that is the decision about it, and all of them are in one, for the nearest of them.
class InPlaceVariant : public Variant {
 public:
  explicit InPlaceVariant(Way way) : way_(way) {}

  void run(std::span<const Shot> shots, Answers& answers) override {
    std::size_t tests = 0, rays = 0;
    for (const Shot& shot : shots) {
      tests += shot.tests();
      rays += shot.directions.size();
    }
    answers.tests.assign(tests, {});
    answers.nearest.assign(rays, std::nullopt);
    std::size_t first_test = 0, first_ray = 0;
    for (const Shot& shot : shots) {
      ask(shot, &answers.tests[first_test], &answers.nearest[first_ray]);
      first_test += shot.tests();
      first_ray += shot.directions.size();
    }
  }

 private:
  struct Tree {
    explicit Tree(const Mesh& mesh) : bvh(scene_of(mesh)), finder(bvh) {}

    Bvh bvh;
    CpuFinder finder;
  };

  /// What a search says about a ray.
  struct Found {
    NearestHit hit;
    bool doubt = false;  ///< float32 left a triangle's edges open
  };

  void ask(const Shot& shot, Answer* tests, std::optional<std::uint32_t>* nearest) {
    plant(shot.mesh);
    rays_.clear();
    for (const glm::vec3& direction : shot.directions) rays_.push_back({shot.origin, direction});
    torn_.assign(rays_.size(), false);
    search(trees_.front());
    for (std::size_t ray = 0; ray < rays_.size(); ++ray) {
      const std::uint32_t slot = found_[ray].hit.slot;
      if (slot != NearestHit::kNone) nearest[ray] = trees_.front().bvh.triangle_of(slot);
    }
    const std::size_t count = shot.mesh->triangles.size();
    for (std::size_t i = 0; i < count; ++i) {
      if (count > 1) search(trees_[1 + i]);
      for (std::size_t ray = 0; ray < rays_.size(); ++ray) {
        tests[ray * count + i] = answer(found_[ray]);
      }
    }
    // One of the two must be wrong: no triangle has that number.
    for (std::size_t ray = 0; ray < rays_.size(); ++ray) {
      if (torn_[ray]) nearest[ray] = static_cast<std::uint32_t>(count);
    }
  }

  /// The trees of a mesh: one of all its triangles and, where they are several, one of each.
  void plant(const std::shared_ptr<const Mesh>& mesh) {
    if (mesh == mesh_) return;
    mesh_ = mesh;
    trees_.clear();
    trees_.emplace_back(*mesh);
    if (mesh->triangles.size() == 1) return;
    for (const Corners& triangle : mesh->triangles) trees_.emplace_back(Mesh{{triangle}});
  }

  /// Searches for all rays at once and, where there were doubts, for each alone to learn whose they
  /// were. Cones are searched once more, full: every ray in several groups and lanes. What a ray
  /// finds must not depend on its company.
  void search(Tree& tree) {
    const Search search = {.common_origin = way_ == Way::kCones};
    found_.assign(rays_.size(), {});
    const std::uint64_t doubts = trace(tree, rays_, search);
    for (std::size_t ray = 0; ray < rays_.size(); ++ray) {
      found_[ray].hit = hits_[ray];
    }
    for (std::size_t ray = 0; doubts != 0 && ray < rays_.size(); ++ray) {
      found_[ray].doubt = trace(tree, std::span(rays_).subspan(ray, 1), search) != 0;
      compare(0, ray);
    }
    if (way_ != Way::kCones) return;
    const auto nth = [&](std::size_t i) { return (i + i / kLanes) % rays_.size(); };
    company_.clear();
    for (std::size_t i = 0; i < kCone; ++i) company_.push_back(rays_[nth(i)]);
    trace(tree, company_, search);
    for (std::size_t i = 0; i < kCone; ++i) compare(i, nth(i));
  }

  /// The number of doubts about edges.
  std::uint64_t trace(Tree& tree, std::span<const Ray> rays, const Search& search) {
    const std::uint64_t before = tree.finder.counters().hit.edge_doubts;
    hits_.resize(rays.size());
    tree.finder.find(rays, search, hits_);
    return tree.finder.counters().hit.edge_doubts - before;
  }

  /// Whether ray `number` of the last trace has found what ray `ray` had found before.
  void compare(std::size_t number, std::size_t ray) {
    if (hits_[number].slot != found_[ray].hit.slot) torn_[ray] = true;
  }

  static Answer answer(const Found& found) {
    Answer answer;
    answer.hit = found.hit.slot != NearestHit::kNone;
    answer.doubt = found.doubt;
    if (answer.hit) {
      answer.point = found.hit.point;
      answer.bounds = found.hit.t;
    }
    return answer;
  }

  static constexpr std::size_t kCone = 64;  // rays of a full one

  Way way_;
  std::shared_ptr<const Mesh> mesh_;  // whose trees these are
  std::deque<Tree> trees_;
  // Room to work in.
  std::vector<Ray> rays_, company_;
  std::vector<NearestHit> hits_;  // of the last trace
  std::vector<Found> found_;
  std::vector<bool> torn_;  // of the rays: found different things in different company
};

VariantKind kind(const char* name, const char* what, Way way) {
  return {name, what, true, 0.5, "", [way] { return std::make_unique<InPlaceVariant>(way); }};
}

}  // namespace

std::vector<VariantKind> in_place_variants() {
  return {kind("cpu in place", "the searches in place, ray by ray", Way::kRays),
          kind("cpu cones", "the searches in place for rays of one origin, in cones", Way::kCones)};
}

}  // namespace raygate::stress
