// Compares the results of two pipelined units.
#pragma once

#include <span>
#include <string>

#include "host/intersect/check_intersector.h"
#include "host/intersect/unit/burst_unit.h"

namespace raygate {
namespace detail {

inline std::string describe(const BurstResult& result) {
  const std::string record = "record " + std::to_string(result.record);
  if (result.kind == BurstResult::Kind::kDoubt) return "doubt of " + record;
  if (result.kind == BurstResult::Kind::kNearTie) return "near tie of " + record;
  const float words[] = {result.t, result.point.x, result.point.y, result.point.z};
  return "nearest is " + record + ", t and P" + hex_words(words) + ", error of t " +
         std::to_string(result.t_error);
}

inline bool earlier(const BurstResult& a, const BurstResult& b) {
  return a.bundle != b.bundle ? a.bundle < b.bundle : a.lane < b.lane;
}

}  // namespace detail

/// Throws EngineMismatch at the first burst whose `actual` bits differ from the `expected` ones.
/// The text has the burst's direction, the 16 words of each record in hexadecimal, and the results
/// of both units, so that the burst can be replayed.
inline void require_same(std::span<const RayBundle> batch, const BurstResults& actual,
                         const BurstResults& expected) {
  const auto [a, e] = std::ranges::mismatch(actual, expected);
  const bool a_left = a != actual.end(), e_left = e != expected.end();
  if (!a_left && !e_left) return;
  // If the results belong to different bursts, the earlier burst is the one that differs.
  const BurstResult& culprit = !e_left || (a_left && detail::earlier(*a, *e)) ? *a : *e;
  const auto part = [&](bool left, auto result) {
    return left && !detail::earlier(culprit, *result) ? detail::describe(*result)
                                                      : std::string("nothing more");
  };
  const RayBundle& bundle = batch[culprit.bundle];
  const glm::vec3 direction = bundle.lane_direction(static_cast<int>(culprit.lane));
  std::string text = "the pipelined units differ: unit: " + part(a_left, a) +
                     "; reference: " + part(e_left, e) + "; direction" +
                     hex_words({&direction.x, 3});
  for (std::uint32_t i = 0; i < bundle.record_count; ++i) {
    text += "; record " + std::to_string(i) + hex_words({&bundle.records[i].normal.x, 16});
  }
  throw EngineMismatch(text);
}

}  // namespace raygate
