// The hit-test unit with cheaper arithmetic, and with or without its doubt output.
#include <cmath>

#include "host/find/unit/polygon_record.h"
#include "host/lab/stress/variants.h"
#include "host/lab/variants/arithmetic.h"

namespace raygate::stress {
namespace {

/// The bound of an edge test in a format of p digits, in units of 2^-p |E|_1: as polygon_record.cpp
/// derives it for 24, two for the record and six for the sums, and two for the direction, which
/// narrower formats round as well; the rest is for the terms of second order, at 12 digits or more.
constexpr double kNarrowBound = 10.0 + 0x1p-4;

class UnitVariant : public Variant {
 public:
  UnitVariant(const Arithmetic& arithmetic, bool doubts) : math_(arithmetic), doubts_(doubts) {}

  void run(std::span<const Shot> shots, Answers& answers) override {
    answers.tests.clear();
    for (const Shot& shot : shots) {
      records_.clear();
      for (const Corners& t : shot.mesh->triangles) records_.push_back(record(shot.origin, t));
      for (const glm::vec3& direction : shot.directions) {
        for (std::size_t i = 0; i < records_.size(); ++i) {
          answers.tests.push_back(
              decide({shot.origin, direction}, records_[i], shot.mesh->triangles[i]));
        }
      }
    }
    nearest_by_t(shots, answers);
  }

 private:
  [[nodiscard]] PolygonRecord record(const glm::vec3& origin, const Corners& t) const {
    PolygonRecord record = make_record(origin, t);
    record.normal = math_.read(record.normal);
    record.d = math_.read(record.d);
    for (int k = 0; k < 3; ++k) {
      record.edges[k] = math_.read(record.edges[k]);
      if (math_.digits == 24 || std::isinf(record.bounds[k])) continue;
      const glm::dvec3 e = glm::abs(glm::dvec3(record.edges[k]));
      record.bounds[k] =
          static_cast<float>(std::ldexp(kNarrowBound * (e.x + e.y + e.z), -math_.digits));
    }
    return record;
  }

  [[nodiscard]] Answer decide(const Ray& ray, const PolygonRecord& record, const Corners& t) const {
    Answer answer;
    // The host sends no other directions to the unit.
    if (record.d == 0.0f || !is_usable(ray.direction)) return answer;
    const float side = record.d > 0.0f ? 1.0f : -1.0f;
    const glm::vec3 direction = math_.read(ray.direction);
    bool miss = false, sure = true;
    for (int k = 0; k < 3; ++k) {
      const float u = side * math_.dot(record.edges[k], direction);
      const float bound = doubts_ ? record.bounds[k] : 0.0f;
      miss = miss || u < -bound;
      sure = sure && u > bound;
    }
    answer.doubt = doubts_ && !miss && !sure;
    answer.hit = answer.doubt ? hits_triangle(ray, t) : !miss;
    if (!answer.hit) return answer;
    const float slope = math_.dot(record.normal, direction);
    answer.t = math_.divide(record.d, slope);
    for (int k = 0; k < 3; ++k) {
      answer.point[k] = math_.divide(math_.multiply(record.d, direction[k]), slope);
    }
    if (!doubts_ && !(answer.t > 0.0f)) answer.hit = false;
    return answer;
  }

  Arithmetic math_;
  bool doubts_;
  std::vector<PolygonRecord> records_;
};

VariantKind unit(const char* name, const char* what, const char* significand,
                 const Arithmetic& arithmetic, bool doubts = false) {
  return {name, what,        false,
          0.1,  significand, [=] { return std::make_unique<UnitVariant>(arithmetic, doubts); }};
}

}  // namespace

std::vector<VariantKind> unit_variants() {
  return {unit("no doubts", "the unit without its doubt output: signs as they come", "24", {}),
          unit("21-bit quotients", "doubts resolved; the paper's divider cuts off after 21 bits",
               "24", {.quotient_digits = 21}, true),
          unit("flush", "no doubts; subnormals are zeros", "24", {.flush = true}),
          unit("truncate", "no doubts; rounding towards zero", "24",
               {.rounding = Rounding::kTowardZero}),
          unit("16 bits", "no doubts; significands of 16 bits", "16", {.digits = 16}),
          unit("12 bits", "no doubts; significands of 12 bits", "12", {.digits = 12}),
          unit("16 bits + doubts", "significands of 16 bits, doubts resolved", "16", {.digits = 16},
               true),
          unit("12 bits + doubts", "significands of 12 bits, doubts resolved", "12", {.digits = 12},
               true)};
}

}  // namespace raygate::stress
