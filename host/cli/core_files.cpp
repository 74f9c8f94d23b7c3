#include "host/cli/core_files.h"

#include <CLI/CLI.hpp>
#include <system_error>

#include "host/base/input_error.h"
#include "host/cli/format.h"
#include "host/cli/option_text.h"
#include "host/film/atomic_file.h"
#include "host/intersect/core/core_intersector.h"
#include "sim/rtl_core.h"

namespace raygate {
namespace {

/// A pixel of the frame, "X,Y".
glm::ivec2 parse_pixel(const std::string& text, const glm::ivec2& size) {
  const std::vector<std::string> words = split_at_commas(text);
  if (words.size() == 2) {
    const auto x = parse_number<int>(words[0]), y = parse_number<int>(words[1]);
    if (x && y && *x >= 0 && *x < size.x && *y >= 0 && *y < size.y) return {*x, *y};
  }
  fail_value("--trace-pixel", text,
             "X,Y, a pixel of " + std::to_string(size.x) + "x" + std::to_string(size.y));
}

/// A file that gets its name only when it is whole, for others to write; removed before that.
class UnnamedFile {
 public:
  explicit UnnamedFile(const std::filesystem::path& path)
      : path_(path), unnamed_(path.string() + ".unfinished") {}
  UnnamedFile(const UnnamedFile&) = delete;
  UnnamedFile& operator=(const UnnamedFile&) = delete;
  ~UnnamedFile() {
    std::error_code ignored;
    std::filesystem::remove(unnamed_, ignored);
  }

  [[nodiscard]] const std::filesystem::path& unnamed() const { return unnamed_; }
  void name() const {
    std::error_code error;
    std::filesystem::rename(unnamed_, path_, error);
    if (error) throw InputError(path_.string() + ": cannot write: " + error.message());
  }

 private:
  std::filesystem::path path_, unnamed_;
};

}  // namespace

std::vector<std::filesystem::path> CoreFileOptions::paths() const {
  std::vector<std::filesystem::path> paths;
  for (const auto& path : {image, wave}) {
    if (!path.empty()) paths.push_back(path);
  }
  return paths;
}

void declare_core_file_options(CLI::App& app, RawCoreFileOptions& raw) {
  app.add_option("--dump-image", raw.image)->take_last();
  app.add_option("--trace", raw.wave)->take_last();
  app.add_option("--trace-pixel", raw.pixel)->take_last();
}

CoreFileOptions parse_core_file_options(const RawCoreFileOptions& raw, const EngineOptions& engine,
                                        const glm::ivec2& size) {
  if (!raw.image.empty() && !engine.has_core()) {
    throw InputError("--dump-image: expected with --unit core and no --engine cpu, got " +
                     raw.image);
  }
  if (raw.wave.empty() != raw.pixel.empty()) {
    throw InputError("--trace: expected with --trace-pixel X,Y, and that with --trace FILE");
  }
  CoreFileOptions files{.image = raw.image, .wave = raw.wave, .pixel = {}};
  if (raw.pixel.empty()) return files;
  if (!engine.has_core() || engine.engine == Engine::kModel) {
    throw InputError("--trace: expected with --unit core and --engine rtl or check, got " +
                     raw.wave);
  }
  files.pixel = parse_pixel(raw.pixel, size);
  return files;
}

std::shared_ptr<const MemoryImage> make_memory_image(const EngineOptions& engine,
                                                     const CoreFileOptions& files, const Bvh& bvh) {
  if (!engine.has_core()) return nullptr;
  auto image = std::make_shared<const MemoryImage>(bvh, static_cast<int>(engine.threads));
  if (!files.image.empty()) AtomicFile(files.image, image->bytes()).commit();
  return image;
}

std::string trace_pixel(const EngineOptions& engine, const CoreFileOptions& files, const Bvh& bvh,
                        std::shared_ptr<const MemoryImage> image, const Ray& ray) {
  const UnnamedFile file(files.wave);
  NearestHit hit;
  CoreCounters counters;
  {
    const std::shared_ptr<CoreUnit> core = make_core_wave(file.unnamed(), engine.memory);
    CoreIntersector(bvh, std::move(image), core).intersect({&ray, 1}, {}, {&hit, 1});
    counters = core->counters();
  }
  file.name();
  std::string text = "the ray of pixel " + std::to_string(files.pixel->x) + "," +
                     std::to_string(files.pixel->y) + " hits ";
  text += hit.primitive == NearestHit::kNone
              ? "nothing"
              : "triangle " + std::to_string(bvh.triangle_of(hit.primitive)) + " at t " +
                    std::to_string(hit.t.low);
  return text + ": " + format_count(counters.clocks, "clock") + ", " +
         format_count(counters.nodes, "node") + ", " +
         format_count(counters.triangles, "triangle") + ", " +
         format_count(counters.lines, "line") + " read; wrote " + files.wave.string() + "\n";
}

}  // namespace raygate
