#include "host/cli/engines.h"

#include <memory>
#include <utility>

#include "host/intersect/check_intersector.h"
#include "host/intersect/core/core_intersector.h"
#include "host/intersect/core/reference_core.h"
#include "host/intersect/cpu/cpu_intersector.h"
#include "host/intersect/unit/pipeline_hit_tester.h"
#include "host/intersect/unit/plane_unit.h"
#include "host/intersect/unit/record_cache.h"
#include "host/intersect/unit/reference_burst_unit.h"
#include "host/intersect/unit/serial_hit_tester.h"
#include "host/intersect/unit/unit_intersector.h"
#include "sim/rtl_burst_unit.h"
#include "sim/rtl_core.h"
#include "sim/rtl_plane_unit.h"

namespace raygate {
namespace {

/// The unit of an engine that has one, with what its host does around it: rtl's, or its model.
std::unique_ptr<HitTester> make_tester(const EngineOptions& options, const Skips& skips) {
  const bool simulated = options.engine != Engine::kModel;
  if (options.unit == "serial") {
    std::unique_ptr<PlaneUnit> unit = std::make_unique<ReferencePlaneUnit>();
    if (simulated) unit = std::make_unique<RtlPlaneUnit>(options.arith);
    return std::make_unique<SerialHitTester>(
        std::move(unit), skips.divisions ? SerialHitTester::Order::kEdgesFirst
                                         : SerialHitTester::Order::kPlanesFirst);
  }
  std::unique_ptr<BurstUnit> unit = std::make_unique<ReferenceBurstUnit>();
  if (simulated) unit = std::make_unique<RtlBurstUnit>(options.lanes, options.arith);
  return std::make_unique<PipelineHitTester>(std::move(unit));
}

/// Cores for each thread, all of one image.
IntersectorFactory make_core_factory(const EngineOptions& options, const Bvh& bvh,
                                     std::shared_ptr<const MemoryImage> image) {
  if (!image) {
    image = std::make_shared<const MemoryImage>(bvh, static_cast<int>(options.threads));
  }
  return [options, &bvh, image]() -> std::unique_ptr<Intersector> {
    std::unique_ptr<CoreUnit> core;
    if (options.engine == Engine::kModel) {
      core = std::make_unique<ReferenceCore>();
    } else {
      core = make_rtl_core(options.arith, options.memory, {}, {.cores = options.cores});
    }
    return std::make_unique<CoreIntersector>(bvh, image, std::move(core));
  };
}

/// Of the unit in `options`.
IntersectorFactory make_unit_factory(const EngineOptions& options, const Bvh& bvh,
                                     const Skips& skips, std::shared_ptr<const MemoryImage> image) {
  if (options.unit == "core") return make_core_factory(options, bvh, std::move(image));
  const auto caches = std::make_shared<RecordCaches>(bvh, skips.records);
  return [options, &bvh, skips, caches] {
    return std::make_unique<UnitIntersector>(bvh, make_tester(options, skips), caches);
  };
}

}  // namespace

void prepare_engine(const EngineOptions& options) {
  if (options.engine == Engine::kCpu || options.engine == Engine::kModel) return;
  if (options.unit == "core") {
    (void)make_rtl_core(options.arith);
  } else {
    (void)make_tester(options, {});
  }
}

IntersectorFactory make_intersector_factory(const EngineOptions& options, const Bvh& bvh,
                                            const Skips& skips,
                                            std::shared_ptr<const MemoryImage> image) {
  if (options.engine == Engine::kCpu) {
    return [&bvh] { return std::make_unique<CpuIntersector>(bvh); };
  }
  IntersectorFactory make_unit = make_unit_factory(options, bvh, skips, std::move(image));
  if (options.engine != Engine::kCheck) return make_unit;
  return [&bvh, make_unit] {
    return std::make_unique<CheckIntersector>(bvh, make_unit(),
                                              std::make_unique<CpuIntersector>(bvh));
  };
}

}  // namespace raygate
