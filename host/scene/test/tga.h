// Small picture files for tests.
#pragma once

#include <string>
#include <vector>

#include "host/scene/texture.h"

namespace raygate::test {

/// Returns the bytes of an uncompressed 24-bit TGA file, rows from the top.
inline std::string tga(int width, int height, const std::vector<Texture::Texel>& texels) {
  const auto byte = [](int value) { return static_cast<char>(value); };
  std::string bytes(18, '\0');
  bytes[2] = 2;  // true colour
  bytes[12] = byte(width & 255), bytes[13] = byte(width >> 8);
  bytes[14] = byte(height & 255), bytes[15] = byte(height >> 8);
  bytes[16] = 24;    // bits per pixel
  bytes[17] = 0x20;  // the first row is the top one
  for (const Texture::Texel& texel : texels) {
    for (const std::size_t k : {2, 1, 0}) bytes += byte(texel[k]);
  }
  return bytes;
}

}  // namespace raygate::test
