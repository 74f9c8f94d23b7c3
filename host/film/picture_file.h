// Picture files to compare: OpenEXR, or PNG as the light that a display shows.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "host/film/exr.h"

namespace raygate {

/// Reads the channels `names`: of OpenEXR those of that name (see read_exr); of a PNG file, whose
/// name ends in .png, R, G and B, scene-linear from 0 to 1. Throws InputError for other channels of
/// a PNG, and for files that cannot be read or are damaged.
[[nodiscard]] ChannelPicture read_picture(const std::filesystem::path& file,
                                          std::span<const std::string> names);

}  // namespace raygate
