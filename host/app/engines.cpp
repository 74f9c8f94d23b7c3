#include "host/app/engines.h"

#include <utility>

#include "host/app/console.h"
#include "host/base/input_error.h"
#include "host/film/atomic_file.h"
#include "host/intersect/check_intersector.h"
#include "host/intersect/core/core_intersector.h"
#include "host/intersect/core/linked_core.h"
#include "host/intersect/core/reference_core.h"
#include "host/intersect/cpu/cpu_intersector.h"
#include "host/intersect/unit/burst_unit.h"
#include "host/intersect/unit/hit_tester.h"
#include "host/variants/variant_hit_tester.h"
#include "sim/rtl_core.h"
#include "sim/rtl_units.h"

namespace raygate {
namespace {

/// Returns a tester with the hit-test unit of the options, simulated or as a reference model.
std::unique_ptr<HitTester> make_tester(const EngineOptions& options) {
  if (options.variant) return make_variant_tester(*options.variant);
  if (options.unit == "serial") {
    std::unique_ptr<PlaneUnit> unit = std::make_unique<ReferencePlaneUnit>();
    if (options.simulates()) unit = std::make_unique<RtlPlaneUnit>(options.arith);
    return std::make_unique<SerialHitTester>(std::move(unit));
  }
  std::unique_ptr<BurstUnit> unit = std::make_unique<ReferenceBurstUnit>();
  if (options.simulates()) unit = std::make_unique<RtlBurstUnit>(options.lanes, options.arith);
  return std::make_unique<PipelineHitTester>(std::move(unit));
}

/// Returns the options' ray core: reference model, simulation, or board at a serial port.
std::unique_ptr<CoreUnit> make_core(const EngineOptions& options) {
  if (options.engine == Engine::kModel) {
    return std::make_unique<ReferenceCore>(ReferenceCore::kStackDepth, true);
  }
  if (!options.board_port.empty()) {
    return std::make_unique<LinkedCore>(open_serial_link(options.board_port), kBoardRays);
  }
  if (options.unit == "board") return make_rtl_board();
  return make_rtl_core({}, {}, {.cores = options.cores, .exact = true, .arith = options.arith});
}

}  // namespace

IntersectorFactory make_intersector_factory(const EngineOptions& options, const Bvh& bvh,
                                            std::shared_ptr<const MemoryImage> image) {
  if (!image) image = make_memory_image(options, bvh);
  // Built here: if the first use built the simulated model, threads would wait for each other.
  const bool builds_model = options.simulates() && options.board_port.empty();
  if (builds_model && options.has_core()) (void)make_core(options);
  if (builds_model && !options.has_core()) (void)make_tester(options);
  return [options, &bvh, image]() -> std::unique_ptr<Intersector> {
    auto cpu = std::make_unique<CpuIntersector>(bvh);
    if (options.engine == Engine::kCpu) return cpu;
    std::unique_ptr<Intersector> made;
    if (options.has_core()) {
      made = std::make_unique<CoreIntersector>(bvh, image, make_core(options));
    } else {
      made = make_unit_intersector(bvh, make_tester(options));
    }
    if (options.engine != Engine::kCheck) return made;
    return std::make_unique<CheckIntersector>(bvh, std::move(made), std::move(cpu));
  };
}

std::shared_ptr<const MemoryImage> make_memory_image(const EngineOptions& engine, const Bvh& bvh) {
  if (!engine.has_core()) return nullptr;
  if (!bvh.is_binary32()) {
    throw InputError(
        "--unit " + engine.unit +
        ": found vertices in binary64, expected --round-vertices, as ray cores compute "
        "in binary32");
  }
  return std::make_shared<const MemoryImage>(bvh, engine.threads);
}

std::string trace_pixel(const CoreFileOptions& files, const Bvh& bvh,
                        std::shared_ptr<const MemoryImage> image, const Ray& ray) {
  AtomicFile file(files.wave);
  NearestHit hit;
  CoreCounters counters;
  {
    const std::shared_ptr<CoreUnit> core = make_core_wave(file.unnamed(), {});
    CoreIntersector(bvh, std::move(image), core).nearest({&ray, 1}, {}, {&hit, 1});
    counters = core->counters();
  }
  file.commit();
  std::string text = "the ray of pixel " + std::to_string(files.pixel.x) + "," +
                     std::to_string(files.pixel.y) + " hits ";
  text += hit.primitive == NearestHit::kNone
              ? "nothing"
              : "triangle " + std::to_string(bvh.triangle_of(hit.primitive)) + " at t " +
                    std::to_string(hit.t.low);
  return text + ": " + format_count(counters.clocks, "clock") + ", " +
         format_count(counters.nodes, "node") + ", " + format_count(counters.tests, "triangle") +
         ", " + format_count(counters.lines, "line") + " read; wrote " +
         printable(files.wave.string()) + "\n";
}

}  // namespace raygate
