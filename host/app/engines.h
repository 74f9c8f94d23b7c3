// Engines: makes the intersectors of the engine that the options choose.
#pragma once

#include <memory>
#include <string>

#include "host/app/options.h"
#include "host/bvh/bvh.h"
#include "host/intersect/core/memory_image.h"
#include "host/intersect/intersector.h"

namespace raygate {

/// Returns a factory of intersectors, which own their simulated models. `bvh` must outlive factory
/// and intersectors. `image` is the BVH's memory image for ray cores; if null, it is made when
/// needed. Builds the engine's simulated model if needed. Throws InputError if the model cannot be
/// built.
[[nodiscard]] IntersectorFactory make_intersector_factory(
    const EngineOptions& options, const Bvh& bvh,
    std::shared_ptr<const MemoryImage> image = nullptr);

/// Returns the memory image of `bvh` for the engine's ray cores; null if it uses none.
[[nodiscard]] std::shared_ptr<const MemoryImage> make_memory_image(const EngineOptions& engine,
                                                                   const Bvh& bvh);

/// Traces `ray`, the ray of `files.pixel`, with a simulated core that writes its waveform. Returns
/// a line for the console about the hit. Throws InputError as make_core_wave does.
[[nodiscard]] std::string trace_pixel(const CoreFileOptions& files, const Bvh& bvh,
                                      std::shared_ptr<const MemoryImage> image, const Ray& ray);

}  // namespace raygate
