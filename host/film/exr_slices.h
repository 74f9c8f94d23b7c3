// Where the OpenEXR library finds a film's numbers, to write and to read.
#pragma once

#include <ImfFrameBuffer.h>

#include <cstddef>

#include "host/film/channels.h"
#include "host/film/film.h"

namespace raygate {

/// All channels of a film, which must outlive them and is changed by those who read a file into
/// them.
inline Imf::FrameBuffer exr_slices(const Film& film) {
  Imf::FrameBuffer slices;
  for (const Channel& channel : channels_of(film)) {
    const auto type = channel.type == Channel::Type::kUint ? Imf::UINT : Imf::FLOAT;
    // The library's slices start at pixel (0, 0), which may lie outside the window.
    const std::size_t row = channel.stride * static_cast<std::size_t>(film.window.width());
    char* base = static_cast<char*>(const_cast<void*>(channel.first)) -
                 static_cast<std::ptrdiff_t>(channel.stride) * film.window.x0 -
                 static_cast<std::ptrdiff_t>(row) * film.window.y0;
    slices.insert(channel.name, Imf::Slice(type, base, channel.stride, row));
  }
  return slices;
}

}  // namespace raygate
