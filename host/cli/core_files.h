// Files of a ray core: the memory image that it reads, and the waveform of a pixel's ray.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "host/bvh/bvh.h"
#include "host/cli/engines.h"
#include "host/intersect/core/memory_image.h"

namespace raygate {

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
