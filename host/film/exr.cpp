#include "host/film/exr.h"

#include <ImathBox.h>
#include <ImathMatrix.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStdIO.h>
#include <ImfStringAttribute.h>

#include <cstddef>

#include "host/film/channels.h"

namespace raygate {
namespace {

/// glm multiplies column vectors, Imath row vectors: glm's columns are Imath's rows.
Imath::M44f to_imath(const glm::mat4& m) {
  Imath::M44f result;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) result[i][j] = m[i][j];
  }
  return result;
}

Imf::Header make_header(const Film& film, const ExrMetadata& metadata) {
  const PixelRect& window = film.window;
  Imf::Header header(Imath::Box2i({0, 0}, {film.width - 1, film.height - 1}),
                     Imath::Box2i({window.x0, window.y0}, {window.x1 - 1, window.y1 - 1}));
  header.screenWindowWidth() = metadata.screen_window_width;
  header.compression() = Imf::ZIP_COMPRESSION;
  header.insert("software", Imf::StringAttribute(metadata.software));
  header.insert("scene", Imf::StringAttribute(metadata.scene));
  header.insert("seed", Imf::StringAttribute(std::to_string(metadata.seed)));
  if (metadata.partial) header.insert("partial", Imf::StringAttribute(kPartial));
  Imf::addWorldToCamera(header, to_imath(metadata.world_to_camera));
  return header;
}

}  // namespace

std::string encode_exr(const Film& film, const ExrMetadata& metadata) {
  Imf::Header header = make_header(film, metadata);
  Imf::FrameBuffer buffer;
  const PixelRect& window = film.window;
  for (const Channel& channel : channels_of(film)) {
    const auto type = channel.type == Channel::Type::kUint ? Imf::UINT : Imf::FLOAT;
    header.channels().insert(channel.name, Imf::Channel(type));
    // The library's slices start at pixel (0, 0), which may lie outside the window.
    const std::size_t row = channel.stride * static_cast<std::size_t>(window.width());
    char* base = static_cast<char*>(const_cast<void*>(channel.first)) -
                 static_cast<std::ptrdiff_t>(channel.stride) * window.x0 -
                 static_cast<std::ptrdiff_t>(row) * window.y0;
    buffer.insert(channel.name, Imf::Slice(type, base, channel.stride, row));
  }

  Imf::StdOSStream stream;
  {
    // No threads: they would change no byte, and the destructor completes the file.
    Imf::OutputFile file(stream, header, 0);
    file.setFrameBuffer(buffer);
    file.writePixels(window.height());
  }
  return stream.str();
}

}  // namespace raygate
