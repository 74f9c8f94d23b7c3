// Tallies as JSON: whole, to go on with later, or summed up, for readers.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "host/lab/stress/tally.h"

namespace raygate::stress {

/// Everything, bit for bit; and back. A JSON that is none of these is an
/// nlohmann::json::exception or a std::invalid_argument.
[[nodiscard]] nlohmann::ordered_json whole(const Tally& tally);
[[nodiscard]] Tally tally_from(const nlohmann::ordered_json& json);

/// Quantiles in place of bins. Infinite numbers are null.
[[nodiscard]] nlohmann::ordered_json summed_up(const Tally& tally);

}  // namespace raygate::stress
