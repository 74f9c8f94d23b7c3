// The engines, by the way the renderer goes: every pair alone for its decision, and the whole shot
// through tree, tester and merging for the nearest hit.
#include <algorithm>

#include "host/find/unit/reference_burst_unit.h"
#include "host/find/unit/reference_plane_unit.h"
#include "host/find/unit/pipeline_hit_tester.h"
#include "host/find/unit/serial_hit_tester.h"
#include "host/find/unit/unit_finder.h"
#include "host/lab/stress/variants.h"
#include "host/tree/bvh.h"
#include "sim/rtl_burst_unit.h"
#include "sim/rtl_plane_unit.h"

namespace raygate::stress {
namespace {

class EngineVariant : public Variant {
 public:
  EngineVariant(std::shared_ptr<HitTester> tester, bool simulated)
      : tester_(std::move(tester)), simulated_(simulated) {}

  void run(std::span<const Shot> shots, Answers& answers) override {
    make_batch(shots, answers);
    results_.clear();
    tester_->test(batch_, results_);
    for (const SureHit& hit : results_.hits) answer(hit, answers) = found(hit);
    for (const Doubt& doubt : results_.doubts) {
      Answer& to = answer(doubt, answers);
      const Shot& shot = *places_[doubt.bundle].shot;
      const Ray ray = {shot.origin, shot.directions[doubt.lane]};
      if (hits_triangle(ray, shot.mesh->triangles[places_[doubt.bundle].triangle])) {
        to = found(doubt);
      }
      to.doubt = true;
    }
    // With one triangle all that remains is the tree's way to it, the same for every engine, and a
    // pipeline run for eight tests is mostly empty: there the simulated ones leave it to the
    // others.
    nearest_by_t(shots, answers);
    std::size_t first_ray = 0;
    for (const Shot& shot : shots) {
      if (!simulated_ || shot.mesh->triangles.size() > 1) trace(shot, &answers.nearest[first_ray]);
      first_ray += shot.directions.size();
    }
  }

 private:
  /// What a bundle of the batch tests.
  struct Place {
    const Shot* shot;
    std::uint32_t triangle;
    std::size_t first_answer;  // of the shot
  };

  /// One bundle for each triangle: eight bursts of one test.
  void make_batch(std::span<const Shot> shots, Answers& answers) {
    std::size_t records = 0, tests = 0;
    for (const Shot& shot : shots) {
      records += shot.mesh->triangles.size();
      tests += shot.tests();
    }
    answers.tests.assign(tests, {});
    batch_.clear();
    places_.clear();
    records_.clear();
    records_.reserve(records);  // bundles point into it
    std::size_t first_answer = 0;
    for (const Shot& shot : shots) {
      RayBundle bundle;
      for (int lane = 0; lane < kLanes; ++lane) {
        const std::size_t ray = std::min<std::size_t>(lane, shot.directions.size() - 1);
        for (int k = 0; k < 3; ++k) bundle.direction[k][lane] = shot.directions[ray][k];
      }
      bundle.lanes = (1u << shot.directions.size()) - 1;
      bundle.record_count = 1;
      for (std::uint32_t i = 0; i < shot.mesh->triangles.size(); ++i) {
        bundle.records = &records_.emplace_back(make_record(shot.origin, shot.mesh->triangles[i]));
        batch_.push_back(bundle);
        places_.push_back({&shot, i, first_answer});
      }
      first_answer += shot.tests();
    }
  }

  template <class Report>
  Answer& answer(const Report& report, Answers& answers) {
    const Place& place = places_[report.bundle];
    return answers.tests[place.first_answer + report.lane * place.shot->mesh->triangles.size() +
                         place.triangle];
  }

  /// P as reported, t as the unit's formula gives it, and both as refined.
  template <class Report>
  Answer found(const Report& report) {
    const RayBundle& bundle = batch_[report.bundle];
    const PolygonRecord& record = *bundle.records;
    const glm::vec3 i = bundle.lane_direction(static_cast<int>(report.lane)), n = record.normal;
    Answer answer;
    answer.hit = true;
    answer.t = record.d / ((n.x * i.x + n.y * i.y) + n.z * i.z);
    answer.point = report.point;
    const Place& place = places_[report.bundle];
    answer.delivered = precise_hit({place.shot->origin, place.shot->directions[report.lane]},
                                   place.shot->mesh->triangles[place.triangle]);
    return answer;
  }

  void trace(const Shot& shot, std::optional<std::uint32_t>* nearest) {
    if (shot.mesh != mesh_) {
      mesh_ = shot.mesh;
      finder_.reset();
      bvh_ = std::make_unique<Bvh>(scene_of(*mesh_));
      finder_ = std::make_unique<UnitFinder>(*bvh_, tester_);
    }
    rays_.clear();
    for (const glm::vec3& direction : shot.directions) rays_.push_back({shot.origin, direction});
    hits_.resize(rays_.size());
    finder_->find(rays_, {.common_origin = true}, hits_);
    for (std::size_t ray = 0; ray < shot.directions.size(); ++ray) {
      const NearestHit& hit = hits_[ray];
      nearest[ray] =
          hit.slot == NearestHit::kNone ? std::nullopt : std::optional(bvh_->triangle_of(hit.slot));
    }
  }

  std::shared_ptr<HitTester> tester_;
  bool simulated_;
  std::shared_ptr<const Mesh> mesh_;  // whose tree and finder these are
  std::unique_ptr<Bvh> bvh_;
  std::unique_ptr<UnitFinder> finder_;
  // Room to work in.
  std::vector<PolygonRecord> records_;
  std::vector<RayBundle> batch_;
  std::vector<Place> places_;
  HitResults results_;
  std::vector<Ray> rays_;
  std::vector<NearestHit> hits_;
};

template <class Tester, class Unit, class... Lanes>
VariantKind engine(const char* name, const char* what, double share, bool simulated,
                   Lanes... lanes) {
  return {name, what, true, share, "24", [=] {
            return std::make_unique<EngineVariant>(
                std::make_shared<Tester>(std::make_unique<Unit>(lanes...)), simulated);
          }};
}

}  // namespace

std::vector<VariantKind> engine_variants() {
  return {
      engine<PipelineHitTester, ReferenceBurstUnit>("cpu", "the pipelined unit's CPU twin", 1.0, false),
      engine<PipelineHitTester, RtlBurstUnit>("rtl", "the pipelined unit, simulated", 0.1, true, 1),
      engine<SerialHitTester, ReferencePlaneUnit>("cpu serial", "the paper's unit's CPU twin", 0.1,
                                            false),
      engine<SerialHitTester, RtlPlaneUnit>("rtl serial", "the paper's unit, simulated", 0.1,
                                            true)};
}

}  // namespace raygate::stress
