// In place of core_wave.cpp, where CMake's RAYGATE_WAVES is off.
#include "host/base/input_error.h"
#include "sim/core_wave.h"

namespace raygate {

std::unique_ptr<CoreUnit> make_core_wave(const std::filesystem::path& /*file*/,
                                         const MemoryTiming& /*timing*/) {
  throw InputError(
      "--trace: expected a program that was built with cmake -DRAYGATE_WAVES=ON; "
      "`make wave PIXEL=X,Y` builds and runs it");
}

}  // namespace raygate
