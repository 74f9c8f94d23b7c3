// Engines by name: which intersector stands behind --engine.
#pragma once

#include <memory>

#include "host/cli/engine_options.h"
#include "host/intersect/core/memory_image.h"
#include "host/intersect/intersector.h"
#include "host/light/skips.h"

namespace raygate {

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

}  // namespace raygate
