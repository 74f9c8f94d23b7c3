#include "host/find/unit/check_plane_unit.h"

#include <array>
#include <bit>
#include <cstdint>
#include <cstdio>
#include <string>
#include <utility>

namespace raygate {
namespace {

std::array<std::uint32_t, 3> words(const glm::vec3& v) {
  return std::bit_cast<std::array<std::uint32_t, 3>>(v);
}

std::string hex_words(std::initializer_list<float> words) {
  std::string text;
  for (const float word : words) {
    char buffer[16];
    std::snprintf(buffer, sizeof buffer, " %08X", std::bit_cast<std::uint32_t>(word));
    text += buffer;
  }
  return text;
}

std::string hex_words(const glm::vec3& v) { return hex_words({v.x, v.y, v.z}); }

}  // namespace

CheckPlaneUnit::CheckPlaneUnit(std::unique_ptr<PlaneUnit> unit,
                               std::unique_ptr<PlaneUnit> reference)
    : unit_(std::move(unit)), reference_(std::move(reference)) {}

void CheckPlaneUnit::intersect(std::span<const PlaneTest> tests, std::span<glm::vec3> points) {
  expected_.resize(tests.size());
  unit_->intersect(tests, points);
  reference_->intersect(tests, expected_);
  for (std::size_t i = 0; i < tests.size(); ++i) {
    if (words(points[i]) == words(expected_[i])) continue;
    throw PlaneUnitMismatch("the plane units differ: inputs (Ix Iy Iz a b c d)" +
                            hex_words(tests[i].direction) + hex_words(tests[i].normal) +
                            hex_words({tests[i].d}) + ", unit" + hex_words(points[i]) +
                            ", reference" + hex_words(expected_[i]));
  }
}

std::uint64_t CheckPlaneUnit::clocks() const { return unit_->clocks(); }

}  // namespace raygate
