#include "sim/wide_core.h"

#include "Vray_core_wide.h"
#include "Vray_core_wide___024root.h"
#include "sim/core_model.h"

namespace raygate {

std::unique_ptr<CoreUnit> make_wide_core(const MemoryTiming& timing, const CoreSet& set) {
  return std::make_unique<CoreModel<Vray_core_wide>>(timing, CoreStalls{}, set);
}

}  // namespace raygate
