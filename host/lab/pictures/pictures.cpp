// Pictures in every variant of arithmetic, with audited decisions, and checks of the variants'
// reference models against hardware.
#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <optional>

#include "host/bvh/bvh.h"
#include "host/film/atomic_file.h"
#include "host/film/display.h"
#include "host/intersect/unit/unit_intersector.h"
#include "host/lab/commands.h"
#include "host/lab/pictures/compare.h"
#include "host/lab/pictures/decision_audit.h"
#include "host/lab/variants/rtl_variant_units.h"
#include "host/light/lights.h"
#include "host/render/renderer.h"
#include "host/scene/camera.h"
#include "host/scene/io/scene_loader.h"
#include "host/scene/view.h"
#include "host/variants/variant_hit_tester.h"

namespace raygate::lab {
namespace {

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
        scene_(load_obj(asked.scene)),
        bvh_(scene_),
        lights_(default_lights(scene_, front_camera(scene_, 4.0 / 3.0))) {}

  /// Renders by a variant's reference model, or by its hardware if it has user-supplied modules,
  /// which have no model. Audits all tests of camera rays, writes STEM-VARIANT.png and compares it
  /// with the first variant's.
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
    const Comparison comparison = compare(film, *first_);
    row.update(Row{{"against", against_},
                   {"differing_pixels", comparison.differing},
                   {"rmse", comparison.rmse},
                   {"psnr_db", comparison.psnr},
                   {"ssim", comparison.ssim ? Row(*comparison.ssim) : Row()}});
    return row;
  }

  /// Renders a quarter of the width and the height by the variant's hardware, for its clocks.
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
        [&] { return std::make_unique<UnitIntersector>(bvh_, tester_of(variant, by_hardware)); },
        stats);
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
  std::string against_;        // and its name
};

}  // namespace

void add_variants(CLI::App& lab, Outcome& outcome) {
  lab.add_subcommand("variants", "the variants of arithmetic that there are")->callback([&outcome] {
    for (const Variant& variant : all_variants_of_arithmetic()) {
      Row row = {{"table", "variants"}};
      row.update(variant.row());
      outcome.results.add(std::move(row));
    }
  });
}

void add_check(CLI::App& lab, Outcome& outcome) {
  auto* app = lab.add_subcommand(
      "check", "is each variant's reference model its hardware? exit status 1: no");
  struct Options {
    std::uint64_t tests = 1'000'000, seed = 1;
  };
  const auto options = std::make_shared<Options>();
  app->add_option("--tests", options->tests, "of each variant");
  app->add_option("--seed", options->seed, "of everything random");
  app->callback([options, &outcome] {
    for (const Variant& variant : all_variants_of_arithmetic()) {
      if (!variant.has_hardware()) continue;
      const VariantCheck check = check_variant(variant, options->tests, options->seed);
      if (!check.difference.empty()) outcome.status = 1;
      outcome.results.add({{"table", "checks"},
                           {"variant", variant.name},
                           {"tests", check.tests},
                           {"misses", check.misses},
                           {"hits", check.hits},
                           {"doubts", check.doubts},
                           {"near_ties", check.near_ties},
                           {"clocks", check.clocks},
                           {"seed", options->seed},
                           {"difference", check.difference.empty() ? "none" : check.difference}});
    }
  });
}

void add_pictures(CLI::App& lab, Outcome& outcome) {
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
  app->callback([asked, &outcome] {
    std::filesystem::create_directories(std::filesystem::path(asked->stem).parent_path());
    Pictures pictures(*asked);
    for (const Variant& variant : all_variants_of_arithmetic()) {
      outcome.results.add(pictures.picture(variant));
      if (asked->clocks && variant.has_hardware()) outcome.results.add(pictures.clocks(variant));
    }
  });
}

}  // namespace raygate::lab
