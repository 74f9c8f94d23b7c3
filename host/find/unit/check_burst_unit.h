// Two burst units side by side: the first bit in which they differ stops the run.
#pragma once

#include <memory>
#include <stdexcept>

#include "host/find/unit/burst_unit.h"

namespace raygate {

/// What CheckBurstUnit throws. Its text has the burst's inputs in hex, ready to replay (the
/// direction, then the 16 words of each record), and what each unit made of it.
class BurstUnitMismatch : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Runs every batch on both units, gives the first one's results, and throws BurstUnitMismatch at
/// the first result in which they differ.
class CheckBurstUnit : public BurstUnit {
 public:
  CheckBurstUnit(std::unique_ptr<BurstUnit> unit, std::unique_ptr<BurstUnit> reference);

  void run(std::span<const RayBundle> batch, BurstResults& results) override;
  void start(std::span<const RayBundle> batch) override;
  void finish(BurstResults& results) override;
  [[nodiscard]] BurstCounters counters() const override;  ///< the first unit's

 private:
  std::unique_ptr<BurstUnit> unit_;
  std::unique_ptr<BurstUnit> reference_;
  BurstResults actual_, expected_;
};

/// Throws BurstUnitMismatch where `actual` is not `expected`, both results of `batch`.
void require_same(std::span<const RayBundle> batch, const BurstResults& actual,
                  const BurstResults& expected);

}  // namespace raygate
