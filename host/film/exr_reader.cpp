#include "host/film/exr_reader.h"

#include <ImathBox.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfTestFile.h>

#include <cstdint>
#include <exception>
#include <fstream>
#include <system_error>

#include "host/scene/io/input_error.h"

namespace raygate {
namespace {

constexpr std::int64_t kMaxPixels = std::int64_t{1} << 26;

void require_exr(const std::filesystem::path& file) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (error) throw InputError(file.string() + ": cannot read: " + error.message());
  if (std::filesystem::is_directory(status)) {
    throw InputError(file.string() + ": cannot read: it is a folder");
  }
  if (!std::ifstream(file).good()) {
    throw InputError(file.string() + ": cannot read: Permission denied");
  }
  if (!Imf::isOpenExrFile(file.c_str())) {
    throw InputError(file.string() + ": not an OpenEXR file");
  }
}

/// "R, G, B, Z".
std::string names_in(const Imf::ChannelList& channels) {
  std::string names;
  for (auto channel = channels.begin(); channel != channels.end(); ++channel) {
    names += (names.empty() ? "" : ", ") + std::string(channel.name());
  }
  return names;
}

void require_channels(const std::filesystem::path& file, const Imf::ChannelList& channels,
                      std::span<const std::string> names) {
  for (const std::string& name : names) {
    const Imf::Channel* const found = channels.findChannel(name);
    if (found == nullptr) {
      throw InputError(file.string() + ": no channel " + name + "; the file has " +
                       names_in(channels));
    }
    if (found->xSampling != 1 || found->ySampling != 1) {
      throw InputError(file.string() + ": channel " + name +
                       " is subsampled, expected a number for each pixel");
    }
  }
}

template <typename T>
std::vector<double> read_channel(Imf::InputFile& file, const std::string& name, Imf::PixelType type,
                                 const PixelRect& window) {
  const auto width = static_cast<std::size_t>(window.width());
  std::vector<T> values(width * static_cast<std::size_t>(window.height()));
  Imf::FrameBuffer buffer;
  // The library's slices start at pixel (0, 0), which may lie outside the window.
  const auto offset = static_cast<std::ptrdiff_t>(width) * window.y0 + window.x0;
  buffer.insert(name, Imf::Slice(type,
                                 reinterpret_cast<char*>(values.data()) -
                                     offset * static_cast<std::ptrdiff_t>(sizeof(T)),
                                 sizeof(T), sizeof(T) * width));
  file.setFrameBuffer(buffer);
  file.readPixels(window.y0, window.y1 - 1);
  return {values.begin(), values.end()};
}

}  // namespace

ChannelPicture read_exr(const std::filesystem::path& path, std::span<const std::string> names) {
  require_exr(path);
  try {
    Imf::InputFile file(path.c_str(), 0);
    const Imf::Header& header = file.header();
    const Imath::Box2i& data = header.dataWindow();
    const Imath::Box2i& frame = header.displayWindow();
    const auto side = [](int low, int high) { return std::int64_t{high} - low + 1; };
    if (side(data.min.x, data.max.x) * side(data.min.y, data.max.y) > kMaxPixels) {
      throw InputError(path.string() + ": more than " + std::to_string(kMaxPixels) + " pixels");
    }
    ChannelPicture picture;
    picture.width = static_cast<int>(side(frame.min.x, frame.max.x));
    picture.height = static_cast<int>(side(frame.min.y, frame.max.y));
    require_channels(path, header.channels(), names);
    const PixelRect window{data.min.x, data.min.y, data.max.x + 1, data.max.y + 1};
    for (const std::string& name : names) {
      picture.names.push_back(name);
      const bool is_uint = header.channels().findChannel(name)->type == Imf::UINT;
      picture.channels.push_back(is_uint
                                     ? read_channel<std::uint32_t>(file, name, Imf::UINT, window)
                                     : read_channel<float>(file, name, Imf::FLOAT, window));
    }
    picture.window = {window.x0 - frame.min.x, window.y0 - frame.min.y, window.x1 - frame.min.x,
                      window.y1 - frame.min.y};
    return picture;
  } catch (const InputError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    // The library's messages may run over several lines and repeat the file's name.
    std::string what = error.what();
    for (char& c : what) {
      if (c == '\n') c = ' ';
    }
    throw InputError(path.string() + ": damaged: " + what);
  }
}

}  // namespace raygate
