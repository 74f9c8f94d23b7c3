// Engines: the options that choose what finds the hits, and the intersectors for them.
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

/// The engine that tests rays against triangles.
enum class Engine {
  kRtl,    ///< the simulated hardware
  kModel,  ///< the hardware's reference model in C++
  kCpu,    ///< the host's own tests
  kCheck,  ///< rtl and cpu, compared ray by ray
};

struct EngineOptions {
  Engine engine = Engine::kRtl;
  std::string unit = "pipeline";     ///< "pipeline", "serial", "core" or "board"
  std::optional<Variant> variant{};  ///< number format of the model; none: binary32
  Arith arith = Arith::kStructural;
  int lanes = 1;             ///< lanes of the pipelined unit: 1, 2, 4 or 8; 1 for other units
  MemoryTiming memory{};     ///< memory of a simulated core
  std::string board_port{};  ///< serial port of unit "board"; "": the board is simulated
  int cores = 1;             ///< ray cores behind one memory, per thread; 1 for other units
  int threads = 1;
  InstanceMode instances = InstanceMode::kAutomatic;

  /// Whether rays go to ray cores, simulated or modelled.
  [[nodiscard]] bool has_core() const {
    return (unit == "core" || unit == "board") && engine != Engine::kCpu;
  }
  [[nodiscard]] bool simulates() const {
    return engine == Engine::kRtl || engine == Engine::kCheck;
  }
};

/// Adds the engine's options to a table.
void add_engine_options(OptionTable& table, EngineOptions& options);

/// Throws InputError for options that exclude each other, and sets defaults that depend on others.
void check_engine_options(const OptionTable& table, EngineOptions& options);

/// "rtl", "model", "cpu" or "check".
[[nodiscard]] std::string to_string(Engine engine);
/// "structural" or "behavioural".
[[nodiscard]] std::string to_string(Arith arith);

/// Builds the simulated model of the engine unless it is built already, so that threads do not wait
/// for it later. Throws InputError if it cannot be built.
void prepare_engine(const EngineOptions& options);

/// Returns a factory of intersectors of the engine. Each intersector owns its simulated model; all
/// share the records of common origins. Only `skips.records` and `skips.divisions` are used. The
/// tree must outlive factory and intersectors. `image`: the tree's memory image for ray cores;
/// null: made if needed.
[[nodiscard]] IntersectorFactory make_intersector_factory(
    const EngineOptions& options, const Bvh& bvh, const Skips& skips = {},
    std::shared_ptr<const MemoryImage> image = nullptr);

/// Files about a ray core that are written instead of a picture.
struct CoreFileOptions {
  std::filesystem::path image;      ///< memory image; "": none
  std::filesystem::path wave;       ///< waveform of `pixel`'s ray; "": none
  std::optional<glm::ivec2> pixel;  ///< set if and only if `wave` is

  /// The files that will be written.
  [[nodiscard]] std::vector<std::filesystem::path> paths() const;
};

/// Adds the options of these files to a table.
void add_core_file_options(OptionTable& table, CoreFileOptions& files);

/// Throws InputError if the engine has no ray core or the pixel is outside a frame of `size`.
void check_core_file_options(const CoreFileOptions& files, const EngineOptions& engine,
                             const glm::ivec2& size);

/// Returns the image of `bvh` that the engine's cores read; null for an engine without cores.
[[nodiscard]] std::shared_ptr<const MemoryImage> make_memory_image(const EngineOptions& engine,
                                                                   const Bvh& bvh);

/// Writes the memory image to its file and returns a line for the console. Throws InputError.
[[nodiscard]] std::string dump_image(const CoreFileOptions& files, const MemoryImage& image);

/// Traces `ray`, of `files.pixel`, with a simulated core that writes its waveform. Returns a line
/// for the console about the hit. Throws InputError as make_core_wave does.
[[nodiscard]] std::string trace_pixel(const EngineOptions& engine, const CoreFileOptions& files,
                                      const Bvh& bvh, std::shared_ptr<const MemoryImage> image,
                                      const Ray& ray);

}  // namespace raygate
