// Variant check: compares a variant's reference model with its hardware, bit by bit.
#pragma once

#include <cstdint>
#include <string>

#include "host/variants/variant_table.h"

namespace raygate {

/// What a comparison found.
struct VariantCheck {
  std::uint64_t tests = 0;  ///< hit tests through both
  // Of the pipelined unit, by its own events: the sample has something of everything.
  std::uint64_t misses = 0, hits = 0, doubts = 0, near_ties = 0;
  std::uint64_t clocks = 0;
  std::string difference;  ///< the first one, with its inputs; empty: there is none
};

/// Sends about `tests` random and adversarial tests through the Verilated unit and the twin and
/// compares every bit of every result, and the events. Of the records half are triangles as the
/// host would send them, the others have replaced words, bounds next to |U|, distances next to the
/// margin of a near tie, and random bits. The variant must have hardware.
[[nodiscard]] VariantCheck check_variant(const Variant& variant, std::uint64_t tests,
                                         std::uint64_t seed);

}  // namespace raygate
