#include "host/cli/engine_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <thread>

#include "host/cli/option_text.h"
#include "host/scene/io/input_error.h"

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

InstanceUse parse_instances(const std::string& text) {
  return choose<InstanceUse>("--instances", text,
                             {{"auto", InstanceUse::kAutomatic},
                              {"keep", InstanceUse::kKept},
                              {"write", InstanceUse::kWritten}});
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
  app.add_option("--threads", raw.threads)->take_last();
  app.add_option("--instances", raw.instances)->take_last();
}

EngineOptions parse_engine_options(const RawEngineOptions& raw, EngineOptions defaults) {
  EngineOptions options = std::move(defaults);
  if (!raw.engine.empty()) options.engine = parse_engine(raw.engine);
  if (!raw.unit.empty()) options.unit = parse_unit(raw.unit);
  if (!raw.arith.empty()) options.arith = parse_arith(raw.arith);
  if (!raw.lanes.empty()) options.lanes = parse_lanes(raw.lanes);
  if (options.unit != "pipeline" && options.lanes != 1) {
    throw InputError("--lanes: expected 1 with --unit " + options.unit + ", got " + raw.lanes);
  }
  options.threads = raw.threads.empty() ? std::max(1u, std::thread::hardware_concurrency())
                                        : parse_threads(raw.threads);
  if (!raw.instances.empty()) options.instances = parse_instances(raw.instances);
  if (options.unit == "core" && options.engine != Engine::kCpu) {
    if (options.instances == InstanceUse::kKept) {
      throw InputError("--instances: expected auto or write with --unit core, got keep");
    }
    options.instances = InstanceUse::kWritten;  // its memory holds one tree
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
