#include "host/cli/engines.h"

#include <memory>

#include "host/find/unit/check_burst_unit.h"
#include "host/find/unit/check_plane_unit.h"
#include "host/find/unit/cpu_burst_unit.h"
#include "host/find/unit/cpu_hit_tester.h"
#include "host/find/unit/cpu_plane_unit.h"
#include "host/find/unit/pipeline_hit_tester.h"
#include "host/find/unit/serial_hit_tester.h"
#include "sim/rtl_burst_unit.h"
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

std::unique_ptr<BurstUnit> make_burst_unit(Engine engine, int lanes) {
  if (engine == Engine::kRtl) return std::make_unique<RtlBurstUnit>(lanes);
  return std::make_unique<CheckBurstUnit>(std::make_unique<RtlBurstUnit>(lanes),
                                          std::make_unique<CpuBurstUnit>());
}

}  // namespace

HitTesterFactory make_tester_factory(const Options& options) {
  const Engine engine = options.engine;
  if (options.unit == "serial") {
    const auto order = options.light.skips.divisions ? SerialHitTester::Order::kEdgesFirst
                                                     : SerialHitTester::Order::kPlanesFirst;
    return [engine, order] {
      return std::make_unique<SerialHitTester>(make_plane_unit(engine), order);
    };
  }
  if (engine == Engine::kCpu) return [] { return std::make_unique<CpuHitTester>(); };
  return [engine, lanes = options.lanes] {
    return std::make_unique<PipelineHitTester>(make_burst_unit(engine, lanes));
  };
}

}  // namespace raygate
