#include "host/lab/pictures/decision_audit.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "host/intersect/cpu/cpu_intersector.h"
#include "host/intersect/unit/unit_intersector.h"
#include "host/lab/timing.h"
#include "host/variants/variant_hit_tester.h"

namespace raygate::lab {
namespace {

struct Counts {
  std::uint64_t tests = 0, doubts = 0, wrong_hits = 0, wrong_misses = 0;
};

/// Forwards batches to a tester, and audits each of their tests: sends each record in its own
/// burst, too, as the nearest hit alone is reported of several.
class AuditTester : public HitTester {
 public:
  AuditTester(const Bvh& bvh, const glm::vec3& origin, HitTester& tester, Counts& counts)
      : bvh_(bvh), origin_(origin), tester_(tester), counts_(counts) {}

  void finish(HitReports& reports) override {
    const std::span<const RayBundle> batch = pop_started();
    tester_.run(batch, reports);
    std::vector<RayBundle> alone;
    for (const RayBundle& bundle : batch) {
      for (std::uint32_t i = 0; i < bundle.record_count; ++i) {
        RayBundle& one = alone.emplace_back(bundle);
        one.records += i;
        one.record_count = 1;
        one.first_tag += i;
      }
    }
    HitReports audited;
    tester_.run(alone, audited);
    std::vector<LaneMask> hits(alone.size()), doubts(alone.size());
    for (const HitReport& report : audited) {
      (report.is_sure ? hits : doubts)[report.bundle] |= LaneMask{1} << report.lane;
    }
    for (std::size_t i = 0; i < alone.size(); ++i) {
      for (LaneMask lanes = alone[i].lanes; lanes != 0; lanes &= lanes - 1) {
        const int lane = std::countr_zero(lanes);
        ++counts_.tests;
        if ((doubts[i] >> lane & 1) != 0) {
          ++counts_.doubts;
          continue;
        }
        const bool hit = (hits[i] >> lane & 1) != 0;
        const bool truth = hits_triangle({origin_, alone[i].lane_direction(lane)},
                                         bvh_.corners_of(alone[i].first_tag));
        counts_.wrong_hits += hit && !truth;
        counts_.wrong_misses += !hit && truth;
      }
    }
  }

  [[nodiscard]] HitCounters counters() const override { return tester_.counters(); }

 private:
  const Bvh& bvh_;
  glm::vec3 origin_;
  HitTester& tester_;
  Counts& counts_;
};

/// Returns the error of `value` in ulps of the float next to `exact`.
double ulps(double value, double exact) {
  const int exponent = exact == 0.0 ? -126 : std::max(std::ilogb(exact), -126);
  const double error = std::abs(value - exact);
  return std::isnan(error) ? std::numeric_limits<double>::infinity()
                           : std::ldexp(error, 23 - exponent);
}

/// Returns rays through the pixel centres, in coherent blocks of eight.
std::vector<Ray> camera_rays(const Camera& camera, int width, int height) {
  constexpr int kBlockWidth = 4, kBlockHeight = kLanes / kBlockWidth;
  std::vector<Ray> rays;
  for (int y0 = 0; y0 < height; y0 += kBlockHeight) {
    for (int x0 = 0; x0 < width; x0 += kBlockWidth) {
      for (int y = y0; y < std::min(y0 + kBlockHeight, height); ++y) {
        for (int x = x0; x < std::min(x0 + kBlockWidth, width); ++x) {
          rays.push_back({camera.eye(), camera.direction((x + 0.5) / width, (y + 0.5) / height)});
        }
      }
    }
  }
  return rays;
}

Row summary_of(const std::vector<double>& errors) {
  const auto at = [&](double part) { return errors.empty() ? 0.0 : quantile(errors, part); };
  return {{"p50", at(0.5)}, {"p99", at(0.99)}, {"max", at(1.0)}};
}

}  // namespace

Row audit_decisions(const Bvh& bvh, const Camera& camera, int width, int height,
                    const Variant& variant, HitTester& tester) {
  Counts counts;
  std::uint64_t wrong_rays = 0;
  const glm::vec3 eye = camera.eye();
  const std::vector<Ray> rays = camera_rays(camera, width, height);
  std::vector<NearestHit> seen(rays.size()), exact(rays.size());
  UnitIntersector(bvh, std::make_shared<AuditTester>(bvh, eye, tester, counts))
      .nearest(rays, {.common_origin = true}, seen);
  CpuIntersector(bvh).nearest(rays, {.common_origin = true}, exact);
  std::vector<double> t_errors, point_errors;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const NearestHit &got = seen[i], &truth = exact[i];
    if (got.primitive != truth.primitive) ++wrong_rays;
    if (got.primitive != truth.primitive || truth.primitive == NearestHit::kNone) continue;
    const Interval t = hit_distance(rays[i], bvh.corners_of(got.primitive));
    const double exact_t = 0.5 * (t.low + t.high);
    const PolygonRecord record = make_record(eye, bvh.corners_of(got.primitive));
    t_errors.push_back(ulps(variant_t(variant, record, rays[i].direction), exact_t));
    double worst = 0.0;
    for (int k = 0; k < 3; ++k) {
      worst = std::max(worst, ulps(got.point[k], exact_t * rays[i].direction[k]));
    }
    point_errors.push_back(worst);
  }
  Row row{{"tests", counts.tests},
          {"doubts", counts.doubts},
          {"wrong_hits", counts.wrong_hits},
          {"wrong_misses", counts.wrong_misses},
          {"rays", rays.size()},
          {"wrong_rays", wrong_rays},
          {"hits", t_errors.size()},
          {"point_ulp", summary_of(point_errors)}};
  if (variant.brought.empty()) row["t_ulp"] = summary_of(t_errors);
  return row;
}

}  // namespace raygate::lab
