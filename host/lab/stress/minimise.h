// Failures made as simple as they can be while they still fail.
#pragma once

#include <functional>

#include "host/lab/stress/shot.h"
#include "host/lab/stress/subjects.h"

namespace raygate::lab {

/// How much there is to a case: fewer triangles, then fewer bits set and exponents nearer to that
/// of 1 are less.
[[nodiscard]] int complexity(const Case& failure);

/// A case for which `fails` holds and which none of these makes simpler: leave a triangle out, move
/// the origin to 0, scale all by a power of two, replace a coordinate by 0, by that of another
/// vertex, or by one of fewer digits, with the ray as it is or aimed anew. Directions stay scaled
/// (scaled_direction). `failure` itself must fail.
[[nodiscard]] Case minimise(Case failure, const std::function<bool(const Case&)>& fails);

/// Whether a subject decides a case otherwise than the truth: hit or miss, or which triangle is
/// nearest. Ties count for those that promise to be exact.
[[nodiscard]] bool decides_wrongly(const SubjectKind& kind, Subject& subject, const Case& failure);

}  // namespace raygate::lab
