#include "host/app/engines.h"

#include <algorithm>
#include <bit>
#include <memory>
#include <thread>
#include <utility>

#include "host/app/console.h"
#include "host/app/process.h"
#include "host/app/render_options.h"
#include "host/base/input_error.h"
#include "host/film/atomic_file.h"
#include "host/intersect/check_intersector.h"
#include "host/intersect/core/core_intersector.h"
#include "host/intersect/core/linked_core.h"
#include "host/intersect/core/reference_core.h"
#include "host/intersect/cpu/cpu_intersector.h"
#include "host/intersect/unit/burst_unit.h"
#include "host/intersect/unit/hit_tester.h"
#include "host/intersect/unit/reference_burst_unit.h"
#include "host/intersect/unit/unit_intersector.h"
#include "host/variants/variant_hit_tester.h"
#include "sim/rtl_burst_unit.h"
#include "sim/rtl_core.h"
#include "sim/rtl_plane_unit.h"
#include "sim/simulation.h"

namespace raygate {
namespace {

Choices<Engine> engine_choices() {
  return {{"rtl", Engine::kRtl},
          {"model", Engine::kModel},
          {"cpu", Engine::kCpu},
          {"check", Engine::kCheck}};
}
Choices<Arith> arith_choices() {
  return {{"structural", Arith::kStructural}, {"behavioural", Arith::kBehavioural}};
}

/// Parses a name of variants.json or a format such as "e8p15".
Variant parse_variant(const std::string& option, const std::string& text) {
  std::vector<std::string> names;
  for (const Variant& variant : all_variants_of_arithmetic()) {
    if (variant.name == text) return variant;
    names.push_back(variant.name);
  }
  try {
    if (const auto variant = variant_of_format(text)) return *variant;
  } catch (const InputError& error) {
    throw InputError(option + ": " + text + ": " + error.what());
  }
  fail_value(option, text, "exponent bits and digits as in e8p15 or e8p15-raw, " + listed(names));
}

/// Parses "latency=100,bytes=16,cache=1024"; each part is optional.
MemoryTiming parse_memory(const std::string& option, const std::string& text) {
  MemoryTiming timing;
  for (const std::string& word : split_at_commas(text)) {
    const auto [name, number] = split_at_equals(word);
    const auto value = parse_number<int>(number);
    const auto is_power = [&](int most) {
      return *value >= 1 && *value <= most && std::has_single_bit(static_cast<unsigned>(*value));
    };
    if (value && name == "latency" && *value >= 1 && *value <= 10'000) {
      timing.latency = *value;
    } else if (value && name == "bytes" && is_power(64)) {
      timing.bytes = *value;
    } else if (value && name == "cache" && (*value == 0 || is_power(1 << 24))) {
      timing.cache_lines = *value;
    } else {
      fail_value(option, text,
                 "latency=1 to 10000, bytes=1, 2, 4 ... 64, cache=0 or lines, a power of two");
    }
  }
  return timing;
}

/// Returns the tester for the simulated unit or its model.
std::unique_ptr<HitTester> make_tester(const EngineOptions& options, const Skips& skips) {
  if (options.variant) return make_variant_tester(*options.variant);
  if (options.unit == "serial") {
    std::unique_ptr<PlaneUnit> unit = std::make_unique<ReferencePlaneUnit>();
    if (options.simulates()) unit = std::make_unique<RtlPlaneUnit>(options.arith);
    return std::make_unique<SerialHitTester>(
        std::move(unit), skips.divisions ? SerialHitTester::Order::kEdgesFirst
                                         : SerialHitTester::Order::kPlanesFirst);
  }
  std::unique_ptr<BurstUnit> unit = std::make_unique<ReferenceBurstUnit>();
  if (options.simulates()) unit = std::make_unique<RtlBurstUnit>(options.lanes, options.arith);
  return std::make_unique<PipelineHitTester>(std::move(unit));
}

/// Returns a factory of ray cores that share one memory image.
IntersectorFactory make_core_factory(const EngineOptions& options, const Bvh& bvh,
                                     std::shared_ptr<const MemoryImage> image) {
  if (!image) {
    image = std::make_shared<const MemoryImage>(bvh, options.threads);
  }
  return [options, &bvh, image]() -> std::unique_ptr<Intersector> {
    std::unique_ptr<CoreUnit> core;
    if (options.engine == Engine::kModel) {
      core = std::make_unique<ReferenceCore>(ReferenceCore::kStackDepth, true);
    } else if (!options.board_port.empty()) {
      core = std::make_unique<LinkedCore>(std::make_unique<SerialLink>(options.board_port),
                                          kBoardRays);
    } else if (options.unit == "board") {
      core = make_rtl_board();
    } else {
      core =
          make_rtl_core(options.arith, options.memory, {}, {.cores = options.cores, .exact = true});
    }
    return std::make_unique<CoreIntersector>(bvh, image, std::move(core));
  };
}

/// Returns a factory of intersectors that use the unit in `options`.
IntersectorFactory make_unit_factory(const EngineOptions& options, const Bvh& bvh,
                                     const Skips& skips, std::shared_ptr<const MemoryImage> image) {
  if (options.has_core()) return make_core_factory(options, bvh, std::move(image));
  const auto caches = std::make_shared<RecordCaches>(bvh, skips.records);
  return [options, &bvh, skips, caches] {
    return std::make_unique<UnitIntersector>(bvh, make_tester(options, skips), caches);
  };
}

}  // namespace

void prepare_engine(const EngineOptions& options) {
  if (!options.simulates()) return;
  if (options.unit == "board") {
    if (options.board_port.empty()) (void)make_rtl_board();
  } else if (options.unit == "core") {
    (void)make_rtl_core(options.arith, {}, {}, {.exact = true});
  } else {
    (void)make_tester(options, {});
  }
}

std::string to_string(Engine engine) { return name_of(engine_choices(), engine); }
std::string to_string(Arith arith) { return name_of(arith_choices(), arith); }

void add_engine_options(OptionTable& table, EngineOptions& options) {
  if (!has_simulation()) options.engine = Engine::kCpu;
  table.choice("--engine", "NAME",
               "rtl: simulated hardware; model: its model in C++; cpu: same hits, faster; check: "
               "rtl and cpu ({})",
               options.engine, engine_choices(), kInStats | kInPage);
  table.choice<std::string>(
      "--unit", "NAME", "pipeline, serial (the paper's), core, board ({})", options.unit,
      {{"pipeline", "pipeline"}, {"serial", "serial"}, {"core", "core"}, {"board", "board"}},
      kInStats | kInPage);
  table.add(
      "--variant", "NAME", "the model's format: e8p16; e8p16-raw: without bounds",
      [&options](const std::string& option, const std::string& text) {
        options.variant = parse_variant(option, text);
      },
      [&options] { return options.variant ? options.variant->name : ""; }, kInExr | kInPage);
  table.choice("--arith", "NAME", "structural, or behavioural: + and * ({})", options.arith,
               arith_choices(), kInStats | kInPage);
  table.choice<int>("--lanes", "1|2|4|8", "pipelined units side by side, per thread ({})",
                    options.lanes, {{"1", 1}, {"2", 2}, {"4", 4}, {"8", 8}}, kInStats | kInPage);
  table.add(
      "--memory", "latency=N,bytes=N,cache=N",
      "ray core: clocks to a line (50), bytes per clock (64), cache lines (0)",
      [&options](const std::string& option, const std::string& text) {
        options.memory = parse_memory(option, text);
      },
      {}, kInPage);
  table.number("--cores", "N", "ray cores behind one memory, per thread ({})", options.cores,
               Range{1, 64, "a whole number, 1 to 64"}, kInStats | kInPage);
  table.add("--board-port", "PATH", "the serial port of a real board (--unit board)",
            [&options](const std::string& /*option*/, const std::string& text) {
              options.board_port = text;
            });
  table.number("--threads", "N", "threads (one per processor)", options.threads, kThreadRange,
               kInStats | kInPage);
  table.choice<InstanceMode>("--instances", "auto|keep|write",
                             "a repeated mesh: in memory once, or written out", options.instances,
                             {{"auto", InstanceMode::kAutomatic},
                              {"keep", InstanceMode::kKeep},
                              {"write", InstanceMode::kFlatten}});
}

void check_engine_options(const OptionTable& table, EngineOptions& options) {
  for (const char* name : {"memory", "cores"}) {
    const std::string typed = table.typed(name);
    if (!typed.empty() && !(options.unit == "core" && options.simulates())) {
      throw InputError("--" + std::string(name) +
                       ": expected with --unit core and --engine rtl or check, got " + typed);
    }
  }
  if (options.variant) {
    // The unit is the variant's.
    for (const auto& [name, expected] :
         {std::pair{"engine", "model"},
          {"unit", options.variant->unit == Variant::Unit::kSerial ? "serial" : "pipeline"}}) {
      const std::string typed = table.typed(name);
      if (!typed.empty() && typed != expected) {
        throw InputError("--" + std::string(name) + ": expected " + expected + " with --variant " +
                         options.variant->name + ", got " + typed);
      }
    }
    options.engine = Engine::kModel;
    options.unit = options.variant->unit == Variant::Unit::kSerial ? "serial" : "pipeline";
  }
  if (!options.board_port.empty() && !(options.unit == "board" && options.engine == Engine::kRtl)) {
    throw InputError("--board-port: expected with --unit board and --engine rtl, got " +
                     options.board_port);
  }
  if (options.unit != "pipeline" && options.lanes != 1) {
    throw InputError("--lanes: expected 1 with --unit " + options.unit + ", got " +
                     table.typed("lanes"));
  }
  if (table.typed("threads").empty()) {
    const unsigned processors = std::max(1u, std::thread::hardware_concurrency());
    options.threads = options.board_port.empty() ? static_cast<int>(processors) : 1;  // one board
  }
  if (!options.board_port.empty() && options.threads != 1) {
    throw InputError("--threads: expected 1 with --board-port, got " + table.typed("threads"));
  }
  if (!options.has_core()) return;
  if (options.instances == InstanceMode::kKeep) {
    throw InputError("--instances: expected auto or write with --unit " + options.unit +
                     ", got keep");
  }
  options.instances = InstanceMode::kFlatten;  // its memory holds one tree
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

std::vector<std::filesystem::path> CoreFileOptions::paths() const {
  std::vector<std::filesystem::path> paths;
  for (const auto& path : {image, wave}) {
    if (!path.empty()) paths.push_back(path);
  }
  return paths;
}

void add_core_file_options(OptionTable& table, CoreFileOptions& files) {
  table.text("--dump-image", "FILE", "dump the ray cores' memory image; render nothing",
             files.image);
  table.text("--trace", "FILE.vcd", "write a pixel's waveform; render nothing", files.wave);
  table.add("--trace-pixel", "X,Y", "the pixel of --trace",
            [&files](const std::string& option, const std::string& text) {
              const auto numbers = parse_list<int>(text);
              if (!numbers || numbers->size() != 2) fail_value(option, text, "X,Y, a pixel");
              files.pixel = {(*numbers)[0], (*numbers)[1]};
            });
}

void check_core_file_options(const CoreFileOptions& files, const EngineOptions& engine,
                             const glm::ivec2& size) {
  if (!files.image.empty() && !engine.has_core()) {
    throw InputError("--dump-image: expected with --unit core and no --engine cpu, got " +
                     files.image.string());
  }
  if (files.wave.empty() == files.pixel.has_value()) {
    throw InputError("--trace: expected with --trace-pixel X,Y, and that with --trace FILE");
  }
  if (!files.pixel) return;
  if (!engine.has_core() || !engine.simulates()) {
    throw InputError("--trace: expected with --unit core and --engine rtl or check, got " +
                     files.wave.string());
  }
  const glm::ivec2& pixel = *files.pixel;
  if (pixel.x < 0 || pixel.x >= size.x || pixel.y < 0 || pixel.y >= size.y) {
    fail_value("--trace-pixel", std::to_string(pixel.x) + "," + std::to_string(pixel.y),
               "X,Y, a pixel of " + std::to_string(size.x) + "x" + std::to_string(size.y));
  }
}

std::shared_ptr<const MemoryImage> make_memory_image(const EngineOptions& engine, const Bvh& bvh) {
  return engine.has_core() ? std::make_shared<const MemoryImage>(bvh, engine.threads) : nullptr;
}

std::string dump_image(const CoreFileOptions& files, const MemoryImage& image) {
  AtomicFile(files.image, image.bytes()).commit();
  return "wrote " + printable(files.image.string()) + ", " +
         format_count(image.lines().size(), "line") + "\n";
}

std::string trace_pixel(const EngineOptions& engine, const CoreFileOptions& files, const Bvh& bvh,
                        std::shared_ptr<const MemoryImage> image, const Ray& ray) {
  AtomicFile file(files.wave);
  NearestHit hit;
  CoreCounters counters;
  {
    const std::shared_ptr<CoreUnit> core = make_core_wave(file.unnamed(), engine.memory);
    CoreIntersector(bvh, std::move(image), core).intersect({&ray, 1}, {}, {&hit, 1});
    counters = core->counters();
  }
  file.commit();
  std::string text = "the ray of pixel " + std::to_string(files.pixel->x) + "," +
                     std::to_string(files.pixel->y) + " hits ";
  text += hit.primitive == NearestHit::kNone
              ? "nothing"
              : "triangle " + std::to_string(bvh.triangle_of(hit.primitive)) + " at t " +
                    std::to_string(hit.t.low);
  return text + ": " + format_count(counters.clocks, "clock") + ", " +
         format_count(counters.nodes, "node") + ", " +
         format_count(counters.triangles, "triangle") + ", " +
         format_count(counters.lines, "line") + " read; wrote " + printable(files.wave.string()) +
         "\n";
}

}  // namespace raygate
