// make_rtl_core for a program that links the models. One of the models is a netlist with faults.
#include <utility>

#include "Vray_core_behavioural.h"
#include "Vray_core_behavioural___024root.h"
#include "Vray_core_exact.h"
#include "Vray_core_exact___024root.h"
#include "Vray_core_exact_behavioural.h"
#include "Vray_core_exact_behavioural___024root.h"
#include "sim/core_model.h"
#include "sim/rtl_core.h"

namespace raygate {

std::unique_ptr<CoreUnit> make_rtl_core(const MemoryTiming& timing, const CoreStalls& stalls,
                                        const CoreSet& set) {
  if (set.exact && set.arith == Arith::kStructural) {
    return std::make_unique<CoreModel<Vray_core_exact>>(timing, stalls, set);
  }
  if (set.exact)
    return std::make_unique<CoreModel<Vray_core_exact_behavioural>>(timing, stalls, set);
  return std::make_unique<CoreModel<Vray_core_behavioural>>(timing, stalls, set);
}

}  // namespace raygate
