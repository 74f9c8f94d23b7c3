// Are two burst units' results the same, bit for bit?
#pragma once

#include <span>
#include <stdexcept>

#include "host/intersect/unit/burst_unit.h"

namespace raygate {

/// Its text has the burst's inputs in hex, ready to replay (the direction, then the 16 words of
/// each record), and what each unit made of it.
class BurstUnitMismatch : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Throws BurstUnitMismatch at the first burst where `actual` is not `expected`, both results of
/// `batch`.
void require_same(std::span<const RayBundle> batch, const BurstResults& actual,
                  const BurstResults& expected);

}  // namespace raygate
