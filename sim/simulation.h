// Whether this build has the simulated hardware.
#pragma once

namespace raygate {

/// False of programs that were built without Verilator (`make cpu`), whose simulated units throw
/// InputError where they are made.
[[nodiscard]] bool has_simulation();

}  // namespace raygate
