// The program `trace`: a table of rays in, a table of their exact hits out.
#include <chrono>
#include <condition_variable>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "host/app/console.h"
#include "host/app/engines.h"
#include "host/app/load.h"
#include "host/app/process.h"
#include "host/base/input_error.h"
#include "host/bvh/bvh.h"
#include "host/exact/ieee_floats.h"
#include "host/film/atomic_file.h"
#include "host/trace/hit_table.h"
#include "host/trace/ray_table.h"
#include "host/trace/tracer.h"

namespace raygate {
namespace {

constexpr const char* kAbout = R"(Usage: ./trace SCENE RAYS [options]

Says what rays hit in a scene (OBJ, glTF, PLY, STL), exactly: which triangle,
where, and whether binary32 had left it open. RAYS is a CSV table of any length,
or - for standard input. Its columns, between commas, semicolons or spaces, are
the origin, the direction and, where wanted, a limit:

  OX,OY,OZ,DX,DY,DZ[,LIMIT]        hits P = O + t D have 0 < t < LIMIT

  ./trace scenes/cornell.obj rays.csv
  ./trace scenes/teapot.obj rays.csv -o hits.csv --hits all
  echo 0,1,5,0,0,-1 | ./trace scenes/cornell.obj - --columns triangle,t
)";

constexpr const char* kFooter =
    R"(Numbers count from 0. A ray that hits nothing has triangle -1, t inf, the rest
nan. Positions become binary32 relative to the scene's middle; the summary says
how many rays and corners that changed.

Exit status: 0 done; 1 the engines differ, or an internal error; 2 the command
line, the scene, the rays or the output cannot be used; 130 interrupted.)";

struct TraceOptions {
  std::string information;
  std::filesystem::path scene, rays, output = "-";
  Hits hits = Hits::kNearest;
  std::vector<HitColumn> columns;
  EngineOptions engine{.engine = Engine::kCpu};
  bool strict = false, quiet = false;

  [[nodiscard]] bool is_to_standard_output() const { return output == "-"; }
};

TraceOptions parse(const std::vector<std::string>& words) {
  TraceOptions options;
  std::string scene, rays, columns;
  OptionTable table(kAbout, kFooter);
  table.positional(scene);
  table.positional(rays);
  table.group("Options");
  table.text("-o,--output", "FILE", "CSV; - is standard output (default)", options.output);
  table.choice<Hits>("--hits", "nearest|any|all",
                     "nearest: a row for each ray; any: whether there is a hit, sooner; all: a row "
                     "for each hit of each ray, near before far ({})",
                     options.hits,
                     {{"nearest", Hits::kNearest}, {"any", Hits::kAny}, {"all", Hits::kAll}});
  table.text(
      "--columns", "NAMES",
      "ray,hit,triangle,object,material,t,point,uv,normal,side,doubts, unit-point,unit-error (all "
      "but material, side and the last two; of any: ray,hit)",
      columns);
  add_engine_options(table, options.engine);
  table.flag("--strict", "refuse faces without area (they are left out)", options.strict);
  table.flag("-q,--quiet", "print no summary (on standard error)", options.quiet);
  options.information = table.parse(words, "a third file; expected SCENE and RAYS");
  if (!options.information.empty()) return options;
  if (rays.empty()) throw InputError("expected SCENE and RAYS (see --help)");
  options.scene = scene;
  options.rays = rays;
  if (!options.is_to_standard_output() && options.output.extension() != ".csv") {
    fail_value("--output", options.output.string(), "FILE.csv or -");
  }
  check_engine_options(table, options.engine);
  for (const char* name : {"unit", "arith", "lanes"}) {
    const std::string typed = table.typed(name);
    if (options.engine.engine == Engine::kCpu && !typed.empty()) {
      fail_value("--" + std::string(name), typed, "--engine rtl, model or check beside it");
    }
  }
  const auto names = columns.empty() ? std::vector<std::string>() : split_at_commas(columns);
  options.columns = columns_of(names, options.hits, options.engine.engine == Engine::kCpu, "--");
  return options;
}

/// The output file or standard output.
class Table {
 public:
  Table(const TraceOptions& options, const HitTable& answers) {
    if (options.is_to_standard_output()) {
      std::signal(SIGPIPE, SIG_DFL);  // `| head` ends it without a word
    } else {
      file_.emplace(options.output);
    }
    write(answers.header());
  }
  void write(std::string_view bytes) {
    const std::lock_guard lock(mutex_);
    if (file_) {
      file_->append(bytes);
    } else {
      std::fwrite(bytes.data(), 1, bytes.size(), stdout);
      flush_standard_output();
    }
  }
  void finish() {
    if (file_) file_->commit();
  }
  /// Removes the unfinished file before the program ends; later writes block. Streams are left
  /// alone, because a write to them may never end.
  void abandon() {
    if (!file_ || file_->is_stream()) return;
    mutex_.lock();
    file_.reset();
  }

 private:
  std::mutex mutex_;
  std::optional<AtomicFile> file_;
};

[[noreturn]] void end_interrupted(const TraceOptions& options) {
  throw Interrupted(interruption(), options.is_to_standard_output() ? "the table is not whole"
                                                                    : "no file was changed");
}

/// Ends the program if the threads have not stopped half a second after a signal.
void watch(const std::stop_token& is_over, const TraceOptions& options, Table& table) {
  std::mutex mutex;
  std::unique_lock lock(mutex);
  std::condition_variable_any never;
  const auto is_over_after = [&](std::chrono::milliseconds time) {
    never.wait_for(lock, is_over, time, [] { return false; });
    return is_over.stop_requested();
  };
  while (interruption() == 0) {
    if (is_over_after(std::chrono::milliseconds(50))) return;
  }
  if (is_over_after(std::chrono::milliseconds(500))) return;
  table.abandon();
  std::_Exit(run_guarded([&]() -> int { end_interrupted(options); }, 1));
}

std::string summary(const TraceOptions& options, const CornerRounding& rounding,
                    const TraceCounts& counts, double seconds) {
  std::string text = format_count(counts.rays, "ray") + ", " + format_count(counts.hits, "hit") +
                     ", " + format_duration(seconds);
  if (seconds > 0.0) {
    text += ", " +
            format_count(static_cast<std::uint64_t>(static_cast<double>(counts.rays) / seconds)) +
            " rays/s";
  }
  text += ", engine " + to_string(options.engine.engine) + "\n";
  if (counts.rounded > 0) {
    text += format_count(counts.rounded, "ray") + " rounded to binary32\n";
  }
  if (rounding.corners > 0) {
    text += format_count(rounding.corners, "corner") + " rounded to binary32, by up to " +
            format_number(rounding.most) + "\n";
  }
  return text;
}

int run(const TraceOptions& options) {
  if (!options.is_to_standard_output()) require_writable(options.output);
  Scene scene = load(read_scene_file(options.scene),
                     {.strict = options.strict, .keep_instances = true, .textures = false});
  resolve_instances(scene, options.engine.instances, options.scene);
  for (const std::string& warning : scene.warnings) print_warning(warning);
  prepare_engine(options.engine);
  const Bvh bvh(scene, options.engine.threads);
  if (!options.is_to_standard_output()) {
    std::vector<std::filesystem::path> inputs = scene.files;
    inputs.push_back(options.scene);
    inputs.push_back(options.rays);
    const std::filesystem::path outputs[] = {options.output};
    require_distinct(outputs, inputs);
  }
  RayTableReader rays(options.rays, scene.origin);
  const HitTable answers(scene, bvh, options.columns, TableFormat::kCsv);
  Table table(options, answers);
  note_interruptions();
  std::jthread watcher;
  try {
    watcher = std::jthread(watch, std::cref(options), std::ref(table));
  } catch (const std::system_error&) {
    print_warning("no thread could be started that ends the program soon after a signal");
  }
  const auto start = std::chrono::steady_clock::now();
  const TraceCounts counts =
      trace([&](std::size_t most, RayTable& block) { return rays.read(most, block); }, options.hits,
            bvh, answers, make_intersector_factory(options.engine, bvh), options.engine.threads,
            [&](std::string_view rows) { table.write(rows); }, [] { return interruption() == 0; });
  watcher = {};
  if (interruption() != 0) end_interrupted(options);
  table.finish();
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  if (!options.quiet) print(summary(options, scene.rounding, counts, took.count()), stderr);
  return 0;
}

}  // namespace
}  // namespace raygate

int main(int argc, char** argv) {
  return raygate::run_guarded(
      [&] {
        raygate::require_ieee_floats();
        raygate::choose_vectors();
        const raygate::TraceOptions options = raygate::parse({argv + 1, argv + argc});
        if (options.information.empty()) return raygate::run(options);
        raygate::print(options.information);
        return 0;
      },
      1);
}
