// Finds files by names that may have been written on another operating system.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace raygate {

/// Returns the file that a model in `folder` refers to as `name`: the file of that name or, if
/// there is none, of the name without quotes and with '/' for '\', or without the '\' before
/// spaces; else the file whose name matches the last part of `name` in any letter case, in the
/// folder of `name` or in `folder`, with a warning that begins with `place`.
[[nodiscard]] std::optional<std::filesystem::path> find_file(const std::filesystem::path& folder,
                                                             std::string_view name,
                                                             const std::string& place,
                                                             std::vector<std::string>& warnings);

}  // namespace raygate
