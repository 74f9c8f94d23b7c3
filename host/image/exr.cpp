#include "host/image/exr.h"

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

/// Adds channels to a header and a frame buffer together.
class Channels {
 public:
  Channels(Imf::Header& header, const PixelRect& window) : header_(header), window_(window) {}

  /// One channel: its value at the window's first pixel is at `first`, the next pixel's is
  /// `stride` bytes on, rows without a gap.
  void add(const char* name, Imf::PixelType type, const void* first, std::size_t stride) {
    header_.channels().insert(name, Imf::Channel(type));
    // The library's slices start at pixel (0, 0), which may lie outside the window.
    const std::size_t row = stride * static_cast<std::size_t>(window_.width());
    char* base = static_cast<char*>(const_cast<void*>(first)) -
                 static_cast<std::ptrdiff_t>(stride) * window_.x0 -
                 static_cast<std::ptrdiff_t>(row) * window_.y0;
    buffer_.insert(name, Imf::Slice(type, base, stride, row));
  }
  [[nodiscard]] const Imf::FrameBuffer& buffer() const { return buffer_; }

 private:
  Imf::Header& header_;
  const PixelRect& window_;
  Imf::FrameBuffer buffer_;
};

Imf::Header make_header(const Film& film, const ExrMetadata& metadata) {
  const PixelRect& window = film.window;
  Imf::Header header(Imath::Box2i({0, 0}, {film.width - 1, film.height - 1}),
                     Imath::Box2i({window.x0, window.y0}, {window.x1 - 1, window.y1 - 1}));
  header.screenWindowWidth() = metadata.screen_window_width;
  header.compression() = Imf::ZIP_COMPRESSION;
  header.insert("software", Imf::StringAttribute(metadata.software));
  header.insert("scene", Imf::StringAttribute(metadata.scene));
  header.insert("seed", Imf::StringAttribute(std::to_string(metadata.seed)));
  Imf::addWorldToCamera(header, to_imath(metadata.world_to_camera));
  return header;
}

}  // namespace

std::string encode_exr(const Film& film, const ExrMetadata& metadata) {
  Imf::Header header = make_header(film, metadata);
  Channels channels(header, film.window);
  const glm::vec4* color = film.color.data();
  channels.add("R", Imf::FLOAT, &color->r, sizeof *color);
  channels.add("G", Imf::FLOAT, &color->g, sizeof *color);
  channels.add("B", Imf::FLOAT, &color->b, sizeof *color);
  channels.add("A", Imf::FLOAT, &color->a, sizeof *color);
  channels.add("Z", Imf::FLOAT, film.depth.data(), sizeof(float));
  const glm::vec3* normal = film.normal.data();
  channels.add("N.X", Imf::FLOAT, &normal->x, sizeof *normal);
  channels.add("N.Y", Imf::FLOAT, &normal->y, sizeof *normal);
  channels.add("N.Z", Imf::FLOAT, &normal->z, sizeof *normal);
  channels.add("id", Imf::UINT, film.primitive.data(), sizeof(std::uint32_t));

  Imf::StdOSStream stream;
  {
    // No threads: they would change no byte, and the destructor completes the file.
    Imf::OutputFile file(stream, header, 0);
    file.setFrameBuffer(channels.buffer());
    file.writePixels(film.window.height());
  }
  return stream.str();
}

}  // namespace raygate
