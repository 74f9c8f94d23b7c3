// Engines and variants of arithmetic as subjects, each through the renderer's Intersector.
#include <deque>
#include <type_traits>

#include "host/bvh/bvh.h"
#include "host/exact/test/meshes.h"
#include "host/intersect/core/core_intersector.h"
#include "host/intersect/core/memory_image.h"
#include "host/intersect/core/reference_core.h"
#include "host/intersect/cpu/cpu_intersector.h"
#include "host/intersect/unit/burst_unit.h"
#include "host/intersect/unit/hit_tester.h"
#include "host/lab/stress/subjects.h"
#include "host/variants/variant_hit_tester.h"
#include "sim/rtl_core.h"
#include "sim/rtl_units.h"

namespace raygate::lab {
namespace {

/// Properties of an IntersectorSubject.
struct Way {
  bool one_origin =
      false;          ///< shot by shot, as rays of a common origin; otherwise several shots at once
  bool exact = true;  ///< intervals and errors are checked
  bool delivers = false;          ///< hits that the host delivers are checked, too
  const Variant* unit = nullptr;  ///< the variant whose t is checked; null: none
};

/// Tests an Intersector, which finds only nearest hits. So each triangle is tested alone, in a
/// separate BVH, and the nearest hit with all triangles in one BVH.
class IntersectorSubject : public Subject {
 public:
  IntersectorSubject(IntersectorOf make, const Way& way) : make_(std::move(make)), way_(way) {}

  void run(std::span<const Shot> shots, Answers& answers) override {
    answers.tests.clear();
    answers.nearest.clear();
    answers.refused.clear();
    for_each_mesh(shots, way_.one_origin, [&](std::span<const Shot> mine) { ask(mine, answers); });
  }

 private:
  struct Tree {
    Tree(const Mesh& mesh, const IntersectorOf& make)
        : scene(test::scene_of(mesh)), bvh(scene), intersector(make(bvh)) {}
    Tree(const Tree&) = delete;
    Tree& operator=(const Tree&) = delete;

    Scene scene;
    Bvh bvh;
    std::unique_ptr<Intersector> intersector;
  };

  /// Adds the answers for shots at one mesh.
  void ask(std::span<const Shot> shots, Answers& answers) {
    plant(shots[0].mesh);
    rays_.clear();
    for (const Shot& shot : shots) {
      for (const glm::dvec3& direction : shot.directions) {
        Ray& ray = rays_.emplace_back(glm::vec3(shot.origin), glm::vec3(direction));
        answers.refused.push_back(is_finite(direction) && (glm::dvec3(ray.origin) != shot.origin ||
                                                           glm::dvec3(ray.direction) != direction));
        if (answers.refused.back()) ray.direction = glm::vec3(1.0f);
      }
    }
    torn_.assign(rays_.size(), false);
    const Mesh& triangles = *shots[0].mesh;
    const std::size_t first_test = answers.tests.size(), first_ray = answers.nearest.size();
    search(trees_.front());
    for (const NearestHit& hit : hits_) {
      answers.nearest.push_back(hit.primitive == NearestHit::kNone
                                    ? std::nullopt
                                    : std::optional(trees_.front().bvh.triangle_of(hit.primitive)));
    }
    answers.tests.resize(first_test + rays_.size() * triangles.size());
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      if (triangles.size() > 1) search(trees_[1 + i]);
      for (std::size_t ray = 0; ray < rays_.size(); ++ray) {
        answers.tests[first_test + ray * triangles.size() + i] = answer(ray, triangles[i]);
      }
    }
    // Contradictory results get an invalid triangle index, which counts as wrong.
    for (std::size_t ray = 0; ray < rays_.size(); ++ray) {
      if (torn_[ray]) answers.nearest[first_ray + ray] = triangles.size();
    }
  }

  /// Builds the BVHs of a mesh: one of all triangles and, if there are several, one of each.
  void plant(const MeshPointer& mesh) {
    if (mesh == mesh_) return;
    mesh_ = mesh;
    trees_.clear();
    trees_.emplace_back(*mesh, make_);
    if (mesh->size() == 1) return;
    for (const Corners& triangle : *mesh) trees_.emplace_back(Mesh{triangle}, make_);
  }

  /// Finds the hits of all rays. Rays with a common origin are traced again: all in one full cone,
  /// which repeats rays, and each ray with doubts alone. This must not change the results.
  void search(Tree& tree) {
    hits_.assign(rays_.size(), {});
    work_.assign(rays_.size(), {});
    tree.intersector->nearest(rays_, {.common_origin = way_.one_origin, .work = work_}, hits_);
    if (!way_.one_origin) return;
    const auto again = [&](std::span<const Ray> rays, const auto& number) {
      again_.assign(rays.size(), {});
      tree.intersector->nearest(rays, {.common_origin = true}, again_);
      for (std::size_t i = 0; i < rays.size(); ++i) {
        if (again_[i].primitive != hits_[number(i)].primitive) torn_[number(i)] = true;
      }
    };
    for (std::size_t ray = 0; ray < rays_.size(); ++ray) {
      if (work_[ray].doubts == 0) continue;
      again(std::span(rays_).subspan(ray, 1), [&](std::size_t) { return ray; });
    }
    const auto nth = [&](std::size_t i) { return (i + i / kLanes) % rays_.size(); };
    company_.clear();
    for (std::size_t i = 0; i < kCone; ++i) company_.push_back(rays_[nth(i)]);
    again(company_, nth);
  }

  /// Returns the answer for ray `number` and the triangle of the last search.
  [[nodiscard]] Answer answer(std::size_t number, const Corners& triangle) const {
    const Ray& ray = rays_[number];
    const NearestHit& hit = hits_[number];
    Answer answer;
    answer.doubt = work_[number].doubts != 0;
    answer.hit = hit.primitive != NearestHit::kNone;
    if (!answer.hit) return answer;
    answer.point = hit.point;
    if (way_.exact) {
      answer.bounds = hit.t;
      answer.point_error = hit.point_error;
    }
    if (way_.unit != nullptr) {
      answer.t = variant_t(*way_.unit, make_record(ray.origin, triangle), ray.direction);
    }
    if (way_.delivers) answer.delivered = precise_hit(ray, triangle);
    return answer;
  }

  static constexpr std::size_t kCone = 64;  // rays of a full cone

  IntersectorOf make_;
  Way way_;
  MeshPointer mesh_;  // mesh of the current BVHs
  std::deque<Tree> trees_;
  // Reused buffers: rays, their hits, and whether hits depend on other rays.
  std::vector<Ray> rays_, company_;
  std::vector<NearestHit> hits_, again_;
  std::vector<RayWork> work_;
  std::vector<bool> torn_;
};

/// Sets `kind.make` and `kind.engine`. Each subject has its own engine, whose BVHs share one unit.
SubjectKind with(SubjectKind kind, const std::function<IntersectorOf()>& engine, const Way& way) {
  kind.make = [=] { return std::make_unique<IntersectorSubject>(engine(), way); };
  kind.engine = engine;
  return kind;
}

SubjectKind cpu(const char* name, const char* what, bool one_origin) {
  return with(
      {.name = name, .what = what, .exact = true, .binary32 = true, .binary64 = true, .share = 0.5},
      [] { return [](const Bvh& bvh) { return std::make_unique<CpuIntersector>(bvh); }; },
      {.one_origin = one_origin, .delivers = true});
}

IntersectorOf by_unit(const std::shared_ptr<HitTester>& tester) {
  return [tester](const Bvh& bvh) { return make_unit_intersector(bvh, tester); };
}

template <class Tester, class Unit, class... Lanes>
SubjectKind unit(const char* name, const char* what, double share, Lanes... lanes) {
  constexpr bool kSimulated =
      std::is_same_v<Unit, RtlBurstUnit> || std::is_same_v<Unit, RtlPlaneUnit>;
  return with({.name = name,
               .what = what,
               .exact = true,
               .simulated = kSimulated,
               .binary32 = true,
               .binary64 = true,
               .share = share},
              [=] { return by_unit(std::make_shared<Tester>(std::make_unique<Unit>(lanes...))); },
              {.delivers = true, .unit = &all_variants_of_arithmetic().front()});
}

/// Returns a subject for the ray core of `make_core`. `binary32`: checks the error bounds of sure
/// hits. Must be false for a core that resolves doubts, whose hits need not be sure in binary32.
SubjectKind core(const char* name, const char* what, double share, bool simulated, bool binary32,
                 std::unique_ptr<CoreUnit> (*make_core)()) {
  return with({.name = name,
               .what = what,
               .exact = true,
               .simulated = simulated,
               .binary32 = binary32,
               .share = share},
              [=]() -> IntersectorOf {
                return [core = std::shared_ptr<CoreUnit>(make_core())](const Bvh& bvh) {
                  return std::make_unique<CoreIntersector>(
                      bvh, std::make_shared<const MemoryImage>(bvh), core);
                };
              },
              {.delivers = true});
}

}  // namespace

std::vector<SubjectKind> engine_subjects() {
  return {
      cpu("cpu rays", "the cpu engine, ray by ray", false),
      cpu("cpu cones", "the cpu engine, rays of one origin in cones", true),
      unit<PipelineHitTester, ReferenceBurstUnit>("model", "the pipelined unit's reference model",
                                                  0.2),
      unit<PipelineHitTester, RtlBurstUnit>("rtl", "the pipelined unit, simulated", 0.02, 1),
      unit<SerialHitTester, ReferencePlaneUnit>("model serial",
                                                "the paper's unit's reference model", 0.1),
      unit<SerialHitTester, RtlPlaneUnit>("rtl serial", "the paper's unit, simulated", 0.02),
      core("model core", "the ray core's reference model", 0.2, false, true,
           []() -> std::unique_ptr<CoreUnit> { return std::make_unique<ReferenceCore>(); }),
      core("rtl core", "the ray core, simulated", 0.02, true, true, [] { return make_rtl_core(); }),
      core("model exact core", "the exact ray core's reference model", 0.2, false, false,
           []() -> std::unique_ptr<CoreUnit> {
             return std::make_unique<ReferenceCore>(ReferenceCore::kStackDepth, true);
           }),
      core("rtl exact core", "the exact ray core, simulated", 0.02, true, false,
           [] { return make_rtl_core({}, {}, {.exact = true}); })};
}

std::vector<SubjectKind> variant_subjects() {
  std::vector<SubjectKind> kinds;
  for (const Variant& variant : all_variants_of_arithmetic()) {
    if (variant.math == Arithmetic{} && variant.doubts) continue;  // tested as an engine
    kinds.push_back(with({.name = variant.name,
                          .what = "a variant of host/variants/variants.json",
                          .exact = variant.doubts,
                          .share = 0.05},
                         [&variant] { return by_unit(make_variant_tester(variant)); },
                         {.exact = variant.doubts, .unit = &variant}));
  }
  return kinds;
}

}  // namespace raygate::lab
