// Whether this build has the simulated hardware.
#pragma once

namespace raygate {

/// False in programs that were built without Verilator (`make cpu`): there, making a simulated unit
/// throws InputError.
[[nodiscard]] bool has_simulation();

}  // namespace raygate
