// Engines by name: which finder stands behind --engine.
#pragma once

#include "host/cli/options.h"
#include "host/find/finder.h"
#include "host/find/unit/hit_tester.h"

namespace raygate {

/// Makes finders of the engine, unit and number of lanes in `options`. Each one owns its simulated
/// model; polygon records of common origins they share. The tree must outlive factory and finders.
[[nodiscard]] FinderFactory make_finder_factory(const Options& options, const Bvh& bvh);

/// The unit of an engine that has one, with what its host does around it: rtl's, or its model.
[[nodiscard]] std::unique_ptr<HitTester> make_tester(const Options& options);

}  // namespace raygate
