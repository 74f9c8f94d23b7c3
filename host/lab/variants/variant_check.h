// Variant check: compares a variant's reference model with its hardware, bit for bit.
#pragma once

#include <cstdint>
#include <string>

#include "host/variants/variant_table.h"

namespace raygate {

/// Result of a comparison.
struct VariantCheck {
  std::uint64_t tests = 0;  ///< hit tests through unit and model
  // Events of the pipelined unit, which show what the sample covers.
  std::uint64_t misses = 0, hits = 0, doubts = 0, near_ties = 0;
  std::uint64_t clocks = 0;
  std::string difference;  ///< first difference, with its inputs; empty: none
};

/// Sends about `tests` random and adversarial tests through the Verilated unit and its reference
/// model, and compares every bit of every result, and the events. Half of the records are triangles
/// as the host would send them; the others have replaced words, bounds close to |U|, distances
/// close to the margin of a near tie, and random bits. The variant must have hardware.
[[nodiscard]] VariantCheck check_variant(const Variant& variant, std::uint64_t tests,
                                         std::uint64_t seed);

}  // namespace raygate
