#include "host/cli/engine_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <bit>
#include <thread>
#include <utility>

#include "host/base/input_error.h"
#include "host/cli/option_text.h"

namespace raygate {
namespace {

Engine parse_engine(const std::string& text) {
  return choose<Engine>("--engine", text,
                        {{"rtl", Engine::kRtl},
                         {"model", Engine::kModel},
                         {"cpu", Engine::kCpu},
                         {"check", Engine::kCheck}});
}

std::string parse_unit(const std::string& text) {
  return choose<std::string>("--unit", text,
                             {{"pipeline", "pipeline"}, {"serial", "serial"}, {"core", "core"}});
}

Arith parse_arith(const std::string& text) {
  return choose<Arith>("--arith", text,
                       {{"structural", Arith::kStructural}, {"behavioural", Arith::kBehavioural}});
}

int parse_lanes(const std::string& text) {
  const auto lanes = parse_number<int>(text);
  if (!lanes || (*lanes != 1 && *lanes != 2 && *lanes != 4 && *lanes != 8)) {
    fail_value("--lanes", text, "1, 2, 4 or 8");
  }
  return *lanes;
}

InstanceMode parse_instances(const std::string& text) {
  return choose<InstanceMode>("--instances", text,
                              {{"auto", InstanceMode::kAutomatic},
                               {"keep", InstanceMode::kKeep},
                               {"write", InstanceMode::kFlatten}});
}

/// "latency=100,bytes=16,cache=1024", each of them or not.
MemoryTiming parse_memory(const std::string& text) {
  MemoryTiming timing;
  for (const std::string& word : split_at_commas(text)) {
    const std::size_t equals = std::min(word.find('='), word.size());
    const std::string name = word.substr(0, equals);
    const auto value =
        parse_number<int>(std::string_view(word).substr(std::min(equals + 1, word.size())));
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
      fail_value("--memory", text,
                 "latency=1 to 10000, bytes=1, 2, 4 ... 64, cache=0 or lines, a power of two");
    }
  }
  return timing;
}

int parse_cores(const std::string& text) {
  const auto cores = parse_number<int>(text);
  if (!cores || *cores < 1 || *cores > 64) fail_value("--cores", text, "a whole number, 1 to 64");
  return *cores;
}

/// --memory and --cores, which a simulated ray core alone has.
void parse_core_options(const RawEngineOptions& raw, EngineOptions& options) {
  const bool simulated = options.has_core() && options.engine != Engine::kModel;
  for (const auto& [name, text] : {std::pair{"--memory", raw.memory}, {"--cores", raw.cores}}) {
    if (!simulated && !text.empty()) {
      throw InputError(std::string(name) +
                       ": expected with --unit core and --engine rtl or check, got " + text);
    }
  }
  if (!raw.memory.empty()) options.memory = parse_memory(raw.memory);
  if (!raw.cores.empty()) options.cores = parse_cores(raw.cores);
}

unsigned parse_threads(const std::string& text) {
  const auto threads = parse_number<unsigned>(text);
  if (!threads || *threads < 1 || *threads > 1024) {
    fail_value("--threads", text, "a whole number from 1 to 1024");
  }
  return *threads;
}

}  // namespace

void declare_engine_options(CLI::App& app, RawEngineOptions& raw) {
  app.add_option("--engine", raw.engine)->take_last();
  app.add_option("--unit", raw.unit)->take_last();
  app.add_option("--arith", raw.arith)->take_last();
  app.add_option("--lanes", raw.lanes)->take_last();
  app.add_option("--memory", raw.memory)->take_last();
  app.add_option("--cores", raw.cores)->take_last();
  app.add_option("--threads", raw.threads)->take_last();
  app.add_option("--instances", raw.instances)->take_last();
}

EngineOptions parse_engine_options(const RawEngineOptions& raw, EngineOptions defaults) {
  EngineOptions options = std::move(defaults);
  if (!raw.engine.empty()) options.engine = parse_engine(raw.engine);
  if (!raw.unit.empty()) options.unit = parse_unit(raw.unit);
  if (!raw.arith.empty()) options.arith = parse_arith(raw.arith);
  if (!raw.lanes.empty()) options.lanes = parse_lanes(raw.lanes);
  parse_core_options(raw, options);
  if (options.unit != "pipeline" && options.lanes != 1) {
    throw InputError("--lanes: expected 1 with --unit " + options.unit + ", got " + raw.lanes);
  }
  if (!raw.threads.empty()) {
    options.threads = parse_threads(raw.threads);
  } else if (options.processors > 0) {
    options.threads = options.processors;
  } else {
    options.threads = std::max(1u, std::thread::hardware_concurrency());
  }
  if (!raw.instances.empty()) options.instances = parse_instances(raw.instances);
  if (options.has_core()) {
    if (options.instances == InstanceMode::kKeep) {
      throw InputError("--instances: expected auto or write with --unit core, got keep");
    }
    options.instances = InstanceMode::kFlatten;  // its memory holds one tree
  }
  return options;
}

std::string to_string(Engine engine) {
  switch (engine) {
    case Engine::kRtl:
      return "rtl";
    case Engine::kModel:
      return "model";
    case Engine::kCpu:
      return "cpu";
    case Engine::kCheck:
      return "check";
  }
  return "";
}

std::string to_string(Arith arith) {
  return arith == Arith::kStructural ? "structural" : "behavioural";
}

}  // namespace raygate
