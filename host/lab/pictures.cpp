// Pictures in every variant of arithmetic, and wrong decisions of its hit tests on camera rays.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <bit>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>

#include "host/bvh/bvh.h"
#include "host/film/atomic_file.h"
#include "host/film/display.h"
#include "host/intersect/cpu/cpu_intersector.h"
#include "host/intersect/unit/hit_tester.h"
#include "host/lab/lab.h"
#include "host/light/lights.h"
#include "host/render/renderer.h"
#include "host/scene/camera.h"
#include "host/scene/io/scene_loader.h"
#include "host/scene/view.h"
#include "host/variants/variant_hit_tester.h"

namespace raygate::lab {
namespace {

struct Counts {
  std::uint64_t tests = 0, doubts = 0, wrong_hits = 0, wrong_misses = 0;
};

/// Forwards batches to a tester, and audits each of their tests. A burst reports only its nearest
/// hit, so each record is also sent in a separate burst.
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

/// Returns the error of `value` in ulps of binary32 at `exact`.
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

/// Compares the hits of rays through all pixel centres, found by `tester`, which uses the
/// arithmetic of `variant`, with exact arithmetic on the same triangles. Columns:
///
///   tests                     (ray, triangle) pairs tested by the traversal
///   doubts                    tests resolved by exact arithmetic: never wrong
///   wrong_hits, wrong_misses  decisions that differ from exact arithmetic
///   rays, wrong_rays          all rays, and those whose nearest triangle is wrong
///   hits                      hits of rays that are not wrong; errors are computed over these
///   t_ulp, point_ulp          errors of t and of P's worst coordinate in float32 ulps: median
///                             (p50), 99th percentile, largest; 0 without hits. No t_ulp for
///                             user-supplied modules, whose t is the reference model's
Row audit_decisions(const Bvh& bvh, const Camera& camera, int width, int height,
                    const Variant& variant, HitTester& tester) {
  Counts counts;
  std::uint64_t wrong_rays = 0;
  const glm::vec3 eye = camera.eye();
  const std::vector<Ray> rays = camera_rays(camera, width, height);
  std::vector<NearestHit> seen(rays.size()), exact(rays.size());
  make_unit_intersector(bvh, std::make_shared<AuditTester>(bvh, eye, tester, counts))
      ->nearest(rays, {.common_origin = true}, seen);
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

struct PictureOptions {
  std::string scene, stem, integrator = "primary";
  int width = 320, height = 240, samples = 1;
  bool clocks = false;
};

constexpr std::pair<const char*, IntegratorKind> kIntegrators[] = {
    {"primary", IntegratorKind::kPrimary},
    {"whitted", IntegratorKind::kWhitted},
    {"path", IntegratorKind::kPath}};

/// Renders one scene, as seen by a camera that shows all of it, with the default lights.
class Pictures {
 public:
  explicit Pictures(const PictureOptions& asked)
      : asked_(asked),
        scene_(load_obj(asked.scene, {.vertices = Vertices::kBinary32})),
        bvh_(scene_),
        lights_(default_lights(scene_, front_camera(scene_, 4.0 / 3.0))) {}

  /// Renders by a variant's reference model, or by its hardware if it has user-supplied modules,
  /// which have no model. Audits all tests of camera rays, writes STEM-VARIANT.png and compares it
  /// with the first variant's picture.
  Row picture(const Variant& variant) {
    const bool by_hardware = !variant.brought.empty();
    Film film;
    Row row = render_by(variant, by_hardware, asked_, film);
    const auto tester = tester_of(variant, by_hardware);
    row["decisions"] = audit_decisions(bvh_, camera(asked_.width, asked_.height), asked_.width,
                                       asked_.height, variant, *tester);
    row["picture"] = asked_.stem + "-" + variant.name;
    AtomicFile(row["picture"].get<std::string>() + ".png", encode_png(to_display(film))).commit();
    if (!first_) {
      first_ = film;
      against_ = row["picture"].get<std::string>();
    }
    double squares = 0.0;
    std::uint64_t differing = 0;
    for (std::size_t i = 0; i < film.color.size(); ++i) {
      const glm::dvec3 d = glm::dvec3(film.color[i]) - glm::dvec3(first_->color[i]);
      differing += d != glm::dvec3(0.0);
      squares += glm::dot(d, d);
    }
    row.update(Row{{"against", against_},
                   {"differing_pixels", differing},
                   {"rmse", std::sqrt(squares / static_cast<double>(3 * film.color.size()))}});
    return row;
  }

  /// Renders at a quarter of the width and height by the variant's hardware, to count its clocks.
  Row clocks(const Variant& variant) {
    PictureOptions small{.scene = asked_.scene, .stem = ""};
    small.width = asked_.width / 4;
    small.height = asked_.height / 4;
    Film film;
    return render_by(variant, true, small, film);
  }

 private:
  [[nodiscard]] Camera camera(int width, int height) const {
    return front_camera(scene_, static_cast<double>(width) / height);
  }

  static std::unique_ptr<HitTester> tester_of(const Variant& variant, bool by_hardware) {
    return by_hardware ? make_rtl_variant_tester(variant) : make_variant_tester(variant);
  }

  Row render_by(const Variant& variant, bool by_hardware, const PictureOptions& asked, Film& film) {
    RenderSettings options;
    options.width = asked.width;
    options.height = asked.height;
    options.threads = 1;
    options.samples = asked.samples;
    options.integrator = std::ranges::find(kIntegrators, asked.integrator, [](const auto& kind) {
                           return std::string(kind.first);
                         })->second;
    RenderStats stats;
    const PreparedScene prepared(scene_, bvh_);
    film = render(
        {prepared, camera(asked.width, asked.height), options, lights_},
        [&] { return make_unit_intersector(bvh_, tester_of(variant, by_hardware)); }, stats);
    return {{"table", "pictures"},
            {"scene", asked.scene},
            {"width", asked.width},
            {"height", asked.height},
            {"integrator", asked.integrator},
            {"samples", asked.samples},
            {"variant", variant.name},
            {"engine", by_hardware ? "unit" : "model"},
            {"unit_tests", stats.intersect.hit.unit_tests},
            {"clocks", stats.intersect.hit.clocks}};
  }

  const PictureOptions& asked_;
  Scene scene_;
  Bvh bvh_;
  std::optional<CameraLights> lights_;
  std::optional<Film> first_;  // the first variant's picture
  std::string against_;        // name of that picture
};

}  // namespace

void add_variants(CLI::App& lab) {
  lab.add_subcommand("variants", "the variants of arithmetic that there are")->callback([] {
    for (const Variant& variant : all_variants_of_arithmetic()) {
      Row row = {{"table", "variants"}};
      row.update(variant.row());
      print(row);
    }
  });
}

void add_pictures(CLI::App& lab) {
  auto* app = lab.add_subcommand(
      "pictures", "a scene in every variant, audited, and compared with the first one's picture");
  const auto asked = std::make_shared<PictureOptions>();
  app->add_option("scene", asked->scene, "an OBJ file")->required();
  app->add_option("stem", asked->stem, "pictures are STEM-VARIANT.png")->required();
  app->add_option("--width", asked->width, "pixels (320)")->check(CLI::Range(4, 65536));
  app->add_option("--height", asked->height, "pixels (240)")->check(CLI::Range(4, 65536));
  app->add_option("--samples", asked->samples, "of each pixel (1)")->check(CLI::Range(1, 1 << 20));
  app->add_option("--integrator", asked->integrator, "primary, whitted or path (primary)")
      ->check(CLI::IsMember({"primary", "whitted", "path"}));
  app->add_flag("--clocks", asked->clocks, "smaller pictures by the hardware, too, for its clocks");
  app->callback([asked] {
    std::filesystem::create_directories(std::filesystem::path(asked->stem).parent_path());
    Pictures pictures(*asked);
    for (const Variant& variant : all_variants_of_arithmetic()) {
      print(pictures.picture(variant));
      if (asked->clocks && variant.has_hardware()) print(pictures.clocks(variant));
    }
  });
}

}  // namespace raygate::lab
