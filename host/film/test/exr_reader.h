// Reads attributes and channels of OpenEXR files in tests. This reader does not use
// host/film/exr.h, so that no fault there can hide a fault of the writer.
#pragma once

#include <ImathBox.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfStdIO.h>
#include <ImfStringAttribute.h>

#include <cstddef>
#include <string>
#include <vector>

namespace raygate {

/// An encoded file, open for reading.
class ExrReader {
 public:
  explicit ExrReader(const std::string& bytes) : file_(fill(bytes)) {}

  [[nodiscard]] const Imf::Header& header() const { return file_.header(); }

  /// Returns the pixels of one channel, row-major; none if it is missing or of another type.
  template <typename T>
  std::vector<T> read(const char* channel, Imf::PixelType type) {
    const Imf::Channel* found = header().channels().findChannel(channel);
    if (found == nullptr || found->type != type) return {};
    const Imath::Box2i window = header().dataWindow();
    const auto width = static_cast<std::size_t>(window.max.x - window.min.x + 1);
    const auto height = static_cast<std::size_t>(window.max.y - window.min.y + 1);
    std::vector<T> values(width * height);
    Imf::FrameBuffer buffer;
    const auto offset = static_cast<std::ptrdiff_t>(width) * window.min.y + window.min.x;
    buffer.insert(channel, Imf::Slice(type, reinterpret_cast<char*>(values.data() - offset),
                                      sizeof(T), sizeof(T) * width));
    file_.setFrameBuffer(buffer);
    file_.readPixels(window.min.y, window.max.y);
    return values;
  }

  [[nodiscard]] std::string text(const char* name) const {
    const auto* attribute = header().findTypedAttribute<Imf::StringAttribute>(name);
    return attribute != nullptr ? attribute->value() : "(none)";
  }

 private:
  Imf::IStream& fill(const std::string& bytes) {
    stream_.str(bytes);
    return stream_;
  }

  Imf::StdISStream stream_;
  Imf::InputFile file_;
};

}  // namespace raygate
