// Looks at an OpenEXR file before the library reads it.
#pragma once

#include <filesystem>

namespace raygate {

/// Whether the file begins as OpenEXR files do.
[[nodiscard]] bool is_exr(const std::filesystem::path& file);

/// Throws InputError, one line that begins with the file's name: for what cannot be read or is no
/// OpenEXR file, and for a header for which the library would take memory that the file does not
/// fill. What passes may still be damaged.
void require_exr(const std::filesystem::path& file);

}  // namespace raygate
