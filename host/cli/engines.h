// Engines by name: which hit tester stands behind --engine.
#pragma once

#include "host/cli/options.h"
#include "host/picture/renderer.h"

namespace raygate {

/// Makes testers of the engine, unit and number of lanes in `options`. Each tester owns its
/// simulated model, so that threads share nothing.
[[nodiscard]] HitTesterFactory make_tester_factory(const Options& options);

}  // namespace raygate
