// The options that say what finds the hits.
#pragma once

#include <string>

#include "host/scene/instances.h"
#include "sim/arith.h"
#include "sim/memory_timing.h"

namespace CLI {
class App;
}

namespace raygate {

/// Who tests rays against polygons.
enum class Engine {
  kRtl,    ///< the simulated hardware
  kModel,  ///< its reference model in C++, in the hardware's place
  kCpu,    ///< no unit: tests in place
  kCheck,  ///< rtl and cpu, compared ray by ray
};

/// Every value is possible.
struct EngineOptions {
  Engine engine = Engine::kRtl;
  std::string unit = "pipeline";  ///< or "serial", "core"
  Arith arith = Arith::kStructural;
  int lanes = 1;          ///< of the pipelined unit: 1, 2, 4 or 8; 1 for others
  MemoryTiming memory{};  ///< of a simulated core
  int cores = 1;          ///< behind one memory, for each thread; 1 for other units
  unsigned threads = 1;
  unsigned processors = 0;  ///< for a thread each where --threads is not given; 0: the machine's
  InstanceMode instances = InstanceMode::kAutomatic;  ///< what is in the tree

  /// Whether rays go to ray cores, simulated or not.
  [[nodiscard]] bool has_core() const { return unit == "core" && engine != Engine::kCpu; }
};

/// As they were typed; empty where they were not given.
struct RawEngineOptions {
  std::string engine, unit, arith, lanes, memory, cores, threads, instances;
};

void declare_engine_options(CLI::App& app, RawEngineOptions& raw);

/// What is not given is as in `defaults`; threads one per processor.
/// Throws InputError, one line.
[[nodiscard]] EngineOptions parse_engine_options(const RawEngineOptions& raw,
                                                 EngineOptions defaults = {});

/// "rtl", "model", "cpu" or "check".
[[nodiscard]] std::string to_string(Engine engine);

/// "structural" or "behavioural".
[[nodiscard]] std::string to_string(Arith arith);

}  // namespace raygate
