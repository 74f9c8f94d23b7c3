// Engines: the intersectors of the engines that options choose.
#pragma once

#include <memory>
#include <string>

#include "host/app/options.h"
#include "host/bvh/bvh.h"
#include "host/intersect/core/memory_image.h"
#include "host/intersect/intersector.h"

namespace raygate {

/// Returns a factory of intersectors, which own their simulated models. The tree must outlive both.
/// `image`: the tree's memory image for ray cores; null: made if needed. Builds the simulated model
/// of the engine unless it is built already. Throws InputError if it cannot be built.
[[nodiscard]] IntersectorFactory make_intersector_factory(
    const EngineOptions& options, const Bvh& bvh,
    std::shared_ptr<const MemoryImage> image = nullptr);

/// Returns the image of `bvh` that the engine's cores read; null for an engine without cores.
[[nodiscard]] std::shared_ptr<const MemoryImage> make_memory_image(const EngineOptions& engine,
                                                                   const Bvh& bvh);

/// Traces `ray`, of `files.pixel`, with a simulated core that writes its waveform. Returns a line
/// for the console about the hit. Throws InputError as make_core_wave does.
[[nodiscard]] std::string trace_pixel(const CoreFileOptions& files, const Bvh& bvh,
                                      std::shared_ptr<const MemoryImage> image, const Ray& ray);

}  // namespace raygate
