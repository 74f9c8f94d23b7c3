#include "host/cli/engines.h"

#include <memory>

#include "host/hit/check_plane_unit.h"
#include "host/hit/cpu_plane_unit.h"
#include "host/hit/serial_hit_tester.h"
#include "sim/rtl_plane_unit.h"

namespace raygate {
namespace {

std::unique_ptr<PlaneUnit> make_plane_unit(Engine engine) {
  switch (engine) {
    case Engine::kRtl:
      return std::make_unique<RtlPlaneUnit>();
    case Engine::kCpu:
      return std::make_unique<CpuPlaneUnit>();
    case Engine::kCheck:
      break;
  }
  return std::make_unique<CheckPlaneUnit>(std::make_unique<RtlPlaneUnit>(),
                                          std::make_unique<CpuPlaneUnit>());
}

}  // namespace

HitTesterFactory make_tester_factory(Engine engine) {
  return [engine] { return std::make_unique<SerialHitTester>(make_plane_unit(engine)); };
}

}  // namespace raygate
