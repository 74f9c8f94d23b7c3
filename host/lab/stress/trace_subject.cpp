// `./trace` and the Python module as a subject: all hits of each ray, from their tables.
#include <cmath>
#include <cstring>

#include "host/bvh/bvh.h"
#include "host/exact/exact.h"
#include "host/exact/test/meshes.h"
#include "host/intersect/cpu/cpu_intersector.h"
#include "host/lab/stress/subjects.h"
#include "host/trace/tracer.h"

namespace raygate::lab {
namespace {

class TraceSubject : public Subject {
 public:
  void run(std::span<const Shot> shots, Answers& answers) override {
    answers.tests.clear();
    answers.nearest.clear();
    answers.orders.clear();
    for_each_mesh(shots, false, [&](std::span<const Shot> mine) { ask(mine, answers); });
  }

 private:
  struct RowOfTable {
    std::int64_t ray, triangle;
    double t;
    std::int64_t doubts;
  };

  /// A mesh prepared for tracing.
  struct Target {
    explicit Target(const Mesh& mesh)
        : scene(test::scene_of(mesh)),
          bvh(scene),
          table(scene, bvh,
                {raygate::HitColumn::kRay, raygate::HitColumn::kTriangle, raygate::HitColumn::kT,
                 raygate::HitColumn::kDoubts},
                TableFormat::kBinary) {}
    Target(const Target&) = delete;
    Target& operator=(const Target&) = delete;

    Scene scene;
    Bvh bvh;
    raygate::HitTable table;
  };

  /// Returns the exponent of the power of two by which a direction is scaled, from 2^-20 to 2^20.
  static int exponent(std::size_t ray) { return static_cast<int>(ray % 41) - 20; }

  std::vector<RowOfTable> rows(std::span<const Shot> shots, Hits hits) const {
    const auto read = [&, done = false](std::size_t, RayTable& block) mutable {
      if (std::exchange(done, true)) return false;
      block.clear(0);
      for (const Shot& shot : shots) {
        for (const glm::dvec3& direction : shot.directions) {
          const double scale = std::ldexp(1.0, exponent(block.rays.size()));
          const char* const wrong =
              block.add(shot.origin, is_usable(direction) ? scale * direction : glm::dvec3(0.0),
                        std::numeric_limits<double>::infinity(), glm::dvec3(0.0));
          if (wrong != nullptr) throw std::logic_error(wrong);
        }
      }
      return true;
    };
    std::string bytes;
    (void)trace(
        read, hits, target_->bvh, target_->table,
        [this] { return std::make_unique<CpuIntersector>(target_->bvh); }, 1,
        [&](std::string_view more) { bytes += more; });
    std::vector<RowOfTable> rows(bytes.size() / sizeof(RowOfTable));
    std::memcpy(rows.data(), bytes.data(), bytes.size());
    return rows;
  }

  /// Adds the answers for shots at one mesh.
  void ask(std::span<const Shot> shots, Answers& answers) {
    if (shots[0].mesh != mesh_) {
      mesh_ = shots[0].mesh;
      target_ = std::make_unique<Target>(*mesh_);
    }
    const std::size_t triangles = mesh_->size(), first_ray = answers.orders.size(),
                      first_test = answers.tests.size();
    const std::vector<RowOfTable> nearest = rows(shots, Hits::kNearest),
                                  any = rows(shots, Hits::kAny);
    answers.orders.resize(first_ray + nearest.size());
    answers.tests.resize(first_test + nearest.size() * triangles);
    for (const RowOfTable& row : rows(shots, Hits::kAll)) {
      const auto ray = static_cast<std::size_t>(row.ray);
      const auto triangle = static_cast<std::uint32_t>(row.triangle);
      answers.orders[first_ray + ray].push_back(triangle);
      Answer& answer = answers.tests[first_test + ray * triangles + triangle];
      answer.hit = true;
      answer.doubt = row.doubts != 0;
      answer.bounds = bounds(row, ray);
    }
    for (std::size_t ray = 0; ray < nearest.size(); ++ray) {
      const RowOfTable& row = nearest[ray];
      const bool is_hit = row.triangle >= 0;
      const auto triangle = static_cast<std::uint32_t>(row.triangle);
      // Contradictory results get an invalid triangle index.
      const bool agree = is_hit == (any[ray].triangle >= 0) &&
                         (!is_hit || holds_same(answers, first_test + ray * triangles + triangle,
                                                bounds(row, ray)));
      answers.nearest.push_back(!agree   ? std::optional(static_cast<std::uint32_t>(triangles))
                                : is_hit ? std::optional(triangle)
                                         : std::nullopt);
    }
  }

  /// Returns the guaranteed bounds of the table's t, scaled to the direction of the shot.
  static Interval bounds(const RowOfTable& row, std::size_t ray) {
    const double t = std::ldexp(row.t, exponent(ray));
    return {t * (1.0 - 0x1p-33), t * (1.0 + 0x1p-33)};
  }
  static bool holds_same(const Answers& answers, std::size_t test, const Interval& bounds) {
    const Interval& all = answers.tests[test].bounds;
    return answers.tests[test].hit && all.low == bounds.low && all.high == bounds.high;
  }

  MeshPointer mesh_;  // mesh of the current target
  std::unique_ptr<Target> target_;
};

}  // namespace

std::vector<SubjectKind> trace_subjects() {
  return {
      {.name = "trace",
       .what = "./trace: all hits of a ray in their order, the nearest, and whether there is any",
       .exact = true,
       .binary64 = true,
       .share = 0.5,
       .make = [] { return std::make_unique<TraceSubject>(); }}};
}

}  // namespace raygate::lab
