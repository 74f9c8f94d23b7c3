// Selects structural or behavioural arithmetic for simulated units.
#pragma once

namespace raygate {

/// Kind of arithmetic in a simulated unit. Both kinds compute the same bits.
enum class Arith {
  kStructural,   ///< Booth recoding, carry-save trees, carry-select adders
  kBehavioural,  ///< the language's + and *, simulated faster
};

}  // namespace raygate
