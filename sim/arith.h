// The two kinds of arithmetic that the simulated units come with.
#pragma once

namespace raygate {

/// hw/arith/arith_pkg.sv's Arith. Both give the same bits.
enum class Arith {
  kStructural,   ///< Booth recoding, carry-save trees, carry-select adders
  kBehavioural,  ///< the language's + and *, simulated faster
};

}  // namespace raygate
