#include "host/cli/core_files.h"

#include "host/base/input_error.h"
#include "host/cli/format.h"
#include "host/cli/process.h"
#include "host/film/atomic_file.h"
#include "host/intersect/core/core_intersector.h"
#include "sim/rtl_core.h"

namespace raygate {
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
