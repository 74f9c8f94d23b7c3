// Which single faults of hit_test_array the bursts of rtl_burst_unit_test catch.
#pragma once

#include <cstdint>
#include <vector>

namespace raygate {

/// Of these faults of the netlist (sim/mutate/netlist.py) those that give every burst's results and
/// counts, at one million / `one_in` tests. Throws std::logic_error where the sound netlist
/// doesn't.
std::vector<std::uint32_t> array_survivors(const std::vector<std::uint32_t>& faults,
                                           std::uint64_t one_in);

}  // namespace raygate
