#include "host/intersect/unit/burst_unit.h"

#include <algorithm>
#include <array>
#include <bit>
#include <string>

#include "host/intersect/check_intersector.h"

namespace raygate {
namespace {

std::string describe(const BurstHit& hit) {
  const float words[] = {hit.t, hit.point.x, hit.point.y, hit.point.z};
  return "nearest is record " + std::to_string(hit.record) + ", t and P" + hex_words(words) +
         ", error of t " + std::to_string(hit.t_error);
}

std::string describe(const TestReport& report) {
  return (report.kind == TestReport::Kind::kDoubt ? "doubt of record " : "near tie of record ") +
         std::to_string(report.record);
}

template <class Result>
bool earlier(const Result& a, const Result& b) {
  return a.bundle != b.bundle ? a.bundle < b.bundle : a.lane < b.lane;
}

template <class Result>
void require_same_list(std::span<const RayBundle> batch, std::span<const Result> actual,
                       std::span<const Result> expected) {
  const auto [a, e] = std::mismatch(actual.begin(), actual.end(), expected.begin(), expected.end());
  const bool a_left = a != actual.end(), e_left = e != expected.end();
  if (!a_left && !e_left) return;
  // The burst that differs is that of the earlier result.
  const Result& culprit = !e_left || (a_left && earlier(*a, *e)) ? *a : *e;
  const auto part = [&](bool left, auto result) {
    return left && !earlier(culprit, *result) ? describe(*result) : std::string("nothing more");
  };
  const RayBundle& bundle = batch[culprit.bundle];
  const glm::vec3 direction = bundle.lane_direction(static_cast<int>(culprit.lane));
  std::string text = "the pipelined units differ: unit: " + part(a_left, a) +
                     "; reference: " + part(e_left, e) + "; direction" +
                     hex_words({&direction.x, 3});
  for (std::uint32_t i = 0; i < bundle.record_count; ++i) {
    text += "; record " + std::to_string(i) + hex_words({&bundle.records[i].normal.x, 16});
  }
  throw BurstUnitMismatch(text);
}

}  // namespace

bool operator==(const BurstHit& a, const BurstHit& b) {
  using Words = std::array<std::uint32_t, sizeof(BurstHit) / 4>;
  return std::bit_cast<Words>(a) == std::bit_cast<Words>(b);
}

void require_same(std::span<const RayBundle> batch, const BurstResults& actual,
                  const BurstResults& expected) {
  require_same_list<BurstHit>(batch, actual.hits, expected.hits);
  require_same_list<TestReport>(batch, actual.reports, expected.reports);
}

}  // namespace raygate
