// Minimises failing cases.
#pragma once

#include <functional>

#include "host/lab/stress/shot.h"
#include "host/lab/stress/subjects.h"

namespace raygate::lab {

/// Returns the complexity of a case: lower for fewer triangles, then for fewer set bits and
/// exponents closer to that of 1.
[[nodiscard]] int complexity(const Case& failure);

/// Returns a failing case that cannot be simplified further by any of these steps: remove a
/// triangle, move the origin to 0, scale all by a power of two, replace a coordinate by 0, by that
/// of another vertex, or by one with fewer digits, with the same or a newly aimed ray. Directions
/// stay scaled (scaled_direction). `failure` must fail.
[[nodiscard]] Case minimise(Case failure, const std::function<bool(const Case&)>& fails);

/// Returns whether a subject's decision on a case is wrong: hit or miss, or the nearest triangle.
/// Ties count for exact subjects.
[[nodiscard]] bool decides_wrongly(const SubjectKind& kind, Subject& subject, const Case& failure);

}  // namespace raygate::lab
