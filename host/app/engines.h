// Engines: the options that say what finds the hits, and the intersectors behind them.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "host/app/option_table.h"
#include "host/bvh/bvh.h"
#include "host/intersect/core/memory_image.h"
#include "host/intersect/intersector.h"
#include "host/light/integrator_settings.h"
#include "host/scene/instances.h"
#include "host/variants/variant_table.h"
#include "sim/arith.h"
#include "sim/memory_timing.h"

namespace raygate {

/// Who tests rays against polygons.
enum class Engine {
  kRtl,    ///< the simulated hardware
  kModel,  ///< its reference model in C++, in the hardware's place
  kCpu,    ///< no unit: tests in place
  kCheck,  ///< rtl and cpu, compared ray by ray
};

struct EngineOptions {
  Engine engine = Engine::kRtl;
  std::string unit = "pipeline";     ///< or "serial", "core", "board"
  std::optional<Variant> variant{};  ///< of the reference model; none: binary32, as the hardware
  Arith arith = Arith::kStructural;
  int lanes = 1;             ///< of the pipelined unit: 1, 2, 4 or 8; 1 for others
  MemoryTiming memory{};     ///< of a simulated core
  std::string board_port{};  ///< of a board, for "board"; empty: it is simulated
  int cores = 1;             ///< behind one memory, for each thread; 1 for other units
  int threads = 1;
  InstanceMode instances = InstanceMode::kAutomatic;  ///< what is in the tree

  /// Whether rays go to ray cores, simulated or not.
  [[nodiscard]] bool has_core() const {
    return (unit == "core" || unit == "board") && engine != Engine::kCpu;
  }
  [[nodiscard]] bool simulates() const {
    return engine == Engine::kRtl || engine == Engine::kCheck;
  }
};

/// Adds to a table what sets `options`.
void add_engine_options(OptionTable& table, EngineOptions& options);

/// Refuses what does not go together and settles what was left open; there are so many
/// `processors`, 0: the machine's. Throws InputError, one line.
void check_engine_options(const OptionTable& table, EngineOptions& options,
                          unsigned processors = 0);

/// "rtl", "model", "cpu" or "check".
[[nodiscard]] std::string to_string(Engine engine);
/// "structural" or "behavioural".
[[nodiscard]] std::string to_string(Arith arith);

/// Builds the simulated model that `options` ask for, if it isn't built: before threads wait for
/// it. Throws InputError where it can't be built.
void prepare_engine(const EngineOptions& options);

/// Makes intersectors of the engine, unit and number of lanes in `options`. Each one owns its
/// simulated model; polygon records of common origins they share. Of `skips`, records and divisions
/// count. The tree must outlive factory and intersectors. `image`: what cores read of that tree;
/// null: it is made where it is needed.
[[nodiscard]] IntersectorFactory make_intersector_factory(
    const EngineOptions& options, const Bvh& bvh, const Skips& skips = {},
    std::shared_ptr<const MemoryImage> image = nullptr);

struct CoreFileOptions {
  std::filesystem::path image;  ///< where the memory image goes; empty: nowhere
  std::filesystem::path wave;   ///< where the waveform of `pixel`'s ray goes, in place of a picture
  std::optional<glm::ivec2> pixel;  ///< there exactly with `wave`

  /// The files that are written.
  [[nodiscard]] std::vector<std::filesystem::path> paths() const;
};

/// Adds to a table what sets `files`.
void add_core_file_options(OptionTable& table, CoreFileOptions& files);

/// Throws InputError, one line, where `engine` has no ray core, or the pixel is none of a frame of
/// `size`.
void check_core_file_options(const CoreFileOptions& files, const EngineOptions& engine,
                             const glm::ivec2& size);

/// Returns the image of `bvh` that the engine's cores read; null for an engine without cores.
[[nodiscard]] std::shared_ptr<const MemoryImage> make_memory_image(const EngineOptions& engine,
                                                                   const Bvh& bvh);

/// Writes the image to its file. Returns a line that says so. Throws InputError.
[[nodiscard]] std::string dump_image(const CoreFileOptions& files, const MemoryImage& image);

/// Sends the ray through the middle of `files.pixel` into a core that writes its wave. What it
/// found, one line. Throws InputError as make_core_wave does.
[[nodiscard]] std::string trace_pixel(const EngineOptions& engine, const CoreFileOptions& files,
                                      const Bvh& bvh, std::shared_ptr<const MemoryImage> image,
                                      const Ray& ray);

}  // namespace raygate
