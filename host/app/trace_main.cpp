// The program `trace`: reads a table of rays, writes a table of their exact hits.
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/app/console.h"
#include "host/app/engines.h"
#include "host/app/load.h"
#include "host/base/input_error.h"
#include "host/base/measure.h"
#include "host/bvh/bvh.h"
#include "host/film/atomic_file.h"
#include "host/trace/hit_table.h"
#include "host/trace/ray_table.h"
#include "host/trace/tracer.h"

namespace raygate {
namespace {

constexpr const char* kAbout = R"(Usage: ./trace SCENE RAYS [options]

Prints the exact hits of rays in a scene (OBJ, glTF, PLY, STL): the triangle,
the position, and how often binary32 left a test undecided. RAYS is a CSV table
of any length, or - for standard input. Its columns, separated by commas,
semicolons or spaces, are the origin, the direction and, optionally, a limit. A
first line of names is skipped, or refused if it has these in another order:

  OX,OY,OZ,DX,DY,DZ[,LIMIT]        hits P = O + t D have 0 < t < LIMIT

  ./trace scenes/cornell.obj rays.csv
  ./trace scenes/teapot.obj rays.csv -o hits.csv --hits all
  echo 0,1,5,0,0,-1 | ./trace scenes/cornell.obj - --columns triangle,t
)";

constexpr const char* kFooter =
    R"(Numbers count from 0. A ray without a hit, as with a direction of 0, has
triangle -1, t inf, and nan elsewhere. Answers are exact for binary64 numbers,
or for rounded ones, which the summary counts: in binary32 by --engine rtl and
model, and in meshes with instances; ray origins in binary64, relative to the
scene's middle, unless all vertices are binary32 numbers around 0.

Exit status: 0 done; 1 the engines differ, or an internal error; 2 the command
line, the scene, the rays or the output cannot be used; 130 interrupted.)";

struct TraceOptions {
  std::filesystem::path scene, rays, output = "-";
  Hits hits = Hits::kNearest;
  std::vector<HitColumn> columns;
  EngineOptions engine{.engine = Engine::kCpu};
  bool quiet = false;
};

std::atomic<const char*> unfinished_file = nullptr;  // to be removed after a signal
static_assert(std::atomic<const char*>::is_always_lock_free,
              "signal handlers may use nothing else");

/// Ends the program at once, without waiting for threads.
[[noreturn]] void end(int signal) {
  std::string_view line = "error: interrupted; the table is not whole\n";
  if (const char* const file = unfinished_file) {
    (void)::unlink(file);
    line = "error: interrupted; no file was changed\n";
  }
  (void)!::write(STDERR_FILENO, line.data(), line.size());
  ::_exit(kSignalBase + signal);
}

std::string summary(const TraceOptions& options, const CornerRounding& rounding,
                    const TraceCounts& counts, double seconds) {
  std::string text = format_count(counts.rays, "ray") + ", " + format_count(counts.hits, "hit") +
                     ", " + format_duration(seconds);
  const double rate = static_cast<double>(counts.rays) / seconds;
  if (seconds > 0.0) text += ", " + format_count(static_cast<std::uint64_t>(rate)) + " rays/s";
  text += ", engine " + to_string(options.engine.engine) + "\n";
  if (counts.rounded > 0) text += format_count(counts.rounded, "ray") + " rounded\n";
  if (rounding.corners > 0) {
    text += format_count(rounding.corners, "corner") + " rounded, by up to " +
            format_number(rounding.most) + "\n";
  }
  return text;
}

void trace_rays(const TraceOptions& options) {
  const bool has_file = options.output != "-";
  if (has_file) require_writable(options.output);
  Scene scene = load(
      read_scene_file(options.scene),
      {.textures = false,
       .vertices = options.engine.rounds_vertices ? Vertices::kBinary32 : Vertices::kBinary64});
  resolve_instances(scene, options.engine.instances, options.scene);
  print_warnings(scene.warnings, false);
  const Bvh bvh(scene, options.engine.threads);
  const IntersectorFactory make_intersector = make_intersector_factory(options.engine, bvh);
  if (has_file) {
    std::vector<std::filesystem::path> inputs = scene.files;
    inputs.insert(inputs.end(), {options.scene, options.rays});
    const std::filesystem::path outputs[] = {options.output};
    require_distinct(outputs, inputs);
  }
  RayTableReader rays(options.rays, scene.origin);
  const HitTable answers(scene, bvh, options.columns, TableFormat::kCsv);
  std::optional<AtomicFile> file;
  if (has_file) {
    file.emplace(options.output);
    static const std::string name = file->unnamed().string();  // outlives the file
    if (!file->is_stream()) unfinished_file = name.c_str();
  } else {
    std::signal(SIGPIPE, SIG_DFL);  // `| head` ends the program silently
  }
  handle_interruptions(end);
  const auto write = [&](std::string_view bytes) {
    if (file) return file->append(bytes);
    std::fwrite(bytes.data(), 1, bytes.size(), stdout);
    flush_standard_output();
  };
  write(answers.header());
  Stopwatch stopwatch;
  const TraceCounts counts =
      trace([&](std::size_t most, RayTable& block) { return rays.read(most, block); }, options.hits,
            bvh, answers, make_intersector, options.engine.threads, write);
  handle_interruptions(SIG_IGN);
  if (file) file->commit();
  const double seconds = stopwatch.lap();
  if (!options.quiet) print(summary(options, scene.rounding, counts, seconds), stderr);
}

int run(const std::vector<std::string>& words) {
  TraceOptions options;
  std::string columns;
  OptionTable table(kAbout, kFooter);
  table.group("Options");
  table.text("-o,--output", "FILE", "CSV; - is standard output (default)", options.output);
  table.choice<Hits>("--hits", "nearest|any|all",
                     "nearest: a row for each ray; any: whether there is a hit, sooner; all: a row "
                     "for each hit of each ray, near before far ({})",
                     options.hits,
                     {{"nearest", Hits::kNearest}, {"any", Hits::kAny}, {"all", Hits::kAll}});
  table.text(
      "--columns", "NAMES",
      "ray,hit,triangle,object,material,t,point,uv,normal,side,doubts (all but material and side; "
      "of any: ray,hit)",
      columns);
  add_engine_options(table, options.engine);
  table.flag("-q,--quiet", "print no summary (on standard error)", options.quiet);
  const CommandLine line = table.parse(words);
  if (line.plain.size() != 2) {
    throw InputError("found '" + listed(line.plain, ", ") +
                     "', expected SCENE and RAYS (see --help)");
  }
  options.scene = line.plain[0];
  options.rays = line.plain[1];
  if (options.output != "-" && options.output.extension() != ".csv") {
    table.fail_value("output", "FILE.csv or -");
  }
  check_engine_options(table, options.engine);
  for (const char* name : {"unit", "arith", "lanes"}) {
    if (options.engine.engine == Engine::kCpu && !table.given(name).empty()) {
      table.fail_value(name, "with --engine rtl, model or check");
    }
  }
  const auto names = columns.empty() ? std::vector<std::string>() : split_at(',', columns);
  options.columns = columns_of(names, options.hits, "--");
  if (options.hits == Hits::kAll && options.engine.engine != Engine::kCpu) {
    table.fail_value("engine", "cpu with --hits all");  // units return nearest hits only
  }
  trace_rays(options);
  return 0;
}

}  // namespace
}  // namespace raygate

int main(int argc, char** argv) { return raygate::run_main(argc, argv, raygate::run); }
