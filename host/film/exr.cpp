#include "host/film/exr.h"

#include <IexBaseExc.h>
#include <ImathBox.h>
#include <ImathMatrix.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStdIO.h>
#include <ImfStringAttribute.h>
#include <ImfThreading.h>
#include <ImfVersion.h>
#include <openexr.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <exception>
#include <fstream>
#include <glm/gtc/type_ptr.hpp>
#include <new>
#include <span>
#include <system_error>
#include <utility>
#include <vector>

#include "host/base/input.h"
#include "host/base/input_error.h"
#include "host/base/threads.h"

namespace raygate {
namespace {

Imf::PixelType type_of(const Channel& channel) {
  return channel.type == Channel::Type::kUint ? Imf::UINT : Imf::FLOAT;
}

/// Describes an array with the pixels of `window`, row by row, to the library. The slice's base is
/// the address of pixel (0, 0), which may be outside of the window and the array.
Imf::Slice slice_of(Imf::PixelType type, const void* first, std::size_t stride,
                    const PixelRect& window) {
  const std::size_t row = stride * static_cast<std::size_t>(window.width());
  return {type,
          static_cast<char*>(const_cast<void*>(first)) -
              static_cast<std::ptrdiff_t>(stride) * window.x0 -
              static_cast<std::ptrdiff_t>(row) * window.y0,
          stride, row};
}

/// Returns slices of all channels of a film, for writing or reading.
Imf::FrameBuffer slices_of(const Film& film) {
  Imf::FrameBuffer slices;
  for (const Channel& channel : channels_of(film)) {
    slices.insert(channel.name,
                  slice_of(type_of(channel), channel.first, channel.stride, film.window));
  }
  return slices;
}

/// Returns the header of a file with the rows `window` of the film.
Imf::Header make_header(const Film& film, const ExrMetadata& metadata, const PixelRect& window) {
  Imf::Header header(Imath::Box2i({0, 0}, {film.width - 1, film.height - 1}),
                     Imath::Box2i({window.x0, window.y0}, {window.x1 - 1, window.y1 - 1}));
  header.screenWindowWidth() = metadata.screen_window_width;
  header.compression() = Imf::ZIP_COMPRESSION;
  header.zipCompressionLevel() = 2;  // 1 to 3 % larger than at level 4, in 3/4 of the time
  for (const auto& [name, text] : metadata.attributes) {
    header.insert(name, Imf::StringAttribute(text));
  }
  // A matrix for column vectors, stored by columns, equals one for row vectors, stored by rows.
  Imath::M44f matrix;
  std::memcpy(matrix.x, glm::value_ptr(metadata.world_to_camera), sizeof matrix.x);
  Imf::addWorldToCamera(header, matrix);
  for (const Channel& channel : channels_of(film)) {
    header.channels().insert(channel.name, Imf::Channel(type_of(channel)));
  }
  return header;
}

PixelRect window_of(const Imf::Header& header) {
  const Imath::Box2i& data = header.dataWindow();
  return {data.min.x, data.min.y, data.max.x + 1, data.max.y + 1};
}

void require_channels(const std::filesystem::path& file, const Imf::ChannelList& channels,
                      std::span<const std::string> names) {
  for (const std::string& name : names) {
    const Imf::Channel* const found = channels.findChannel(name);
    if (found == nullptr) {
      std::string text = file.string() + ": no channel " + name + "; the file has ";
      for (auto channel = channels.begin(); channel != channels.end(); ++channel) {
        text.append(channel == channels.begin() ? "" : ", ").append(channel.name());
      }
      throw InputError(text);
    }
    if (found->xSampling != 1 || found->ySampling != 1) {
      throw InputError(file.string() + ": channel " + name +
                       " is subsampled, expected a number for each pixel");
    }
  }
}

void require_readable(const std::filesystem::path& file) {
  const auto fail = [&](const std::string& why) {
    throw InputError(file.string() + ": cannot read: " + why);
  };
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (error) fail(error.message());
  if (std::filesystem::is_directory(status)) fail("it is a folder");
  if (!std::filesystem::is_regular_file(status)) fail("it is a device, a pipe or a socket");
  errno = 0;
  if (!std::ifstream(file).good()) fail(std::generic_category().message(errno));
  if (!is_exr(file)) throw InputError(file.string() + ": not an OpenEXR file");
}

/// Throws InputError for any error in the header, such as an attribute longer than the file or of a
/// wrong length for its type. Only the library's C functions check lengths before they allocate.
void require_header(const std::filesystem::path& path) {
  thread_local exr_result_t problem;  // a function may recover from an error and report success
  problem = EXR_ERR_SUCCESS;
  exr_context_initializer_t options = EXR_DEFAULT_CONTEXT_INITIALIZER;
  options.error_handler_fn = [](exr_const_context_t, exr_result_t code, const char*) {
    problem = code;
  };
  exr_context_t file = nullptr;
  const exr_result_t result = exr_start_read(&file, path.c_str(), &options);
  exr_finish(&file);
  if (result != EXR_ERR_SUCCESS) problem = result;
  if (problem == EXR_ERR_OUT_OF_MEMORY) throw std::bad_alloc();
  if (problem != EXR_ERR_SUCCESS) {
    throw InputError(path.string() + ": damaged: " + exr_get_default_error_message(problem));
  }
}

/// Calls read(file) for an OpenEXR file within the pixel limit.
template <class Read>
auto with_file(const std::filesystem::path& path, const Read& read) {
  require_readable(path);
  require_header(path);
  // Initialises the library's pool of threads (none) here, where failure is harmless.
  (void)Imf::globalThreadCount();
  try {
    Imf::InputFile file(path.c_str(), 0);
    const Imath::Box2i& data = file.header().dataWindow();
    const auto side = [](int low, int high) { return std::int64_t{high} - low + 1; };
    if (side(data.min.x, data.max.x) * side(data.min.y, data.max.y) > kMaxPixels) {
      throw InputError(path.string() + ": more than " + std::to_string(kMaxPixels) + " pixels");
    }
    return read(file);
  } catch (const InputError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    // The library's messages may have several lines and repeat the file name.
    std::string what = error.what();
    std::ranges::replace(what, '\n', ' ');
    throw InputError(path.string() + ": damaged: " + what);
  }
}

/// Returns a film with arrays for the file's channels.
Film film_like(const std::filesystem::path& path, const Imf::Header& header) {
  const Imf::ChannelList& channels = header.channels();
  const auto has = [&](const char* name) { return channels.findChannel(name) != nullptr; };
  if (!has("sums.R.0")) {
    throw InputError(path.string() +
                     ": found no sums of samples, expected a picture of `render --channels sums`");
  }
  const Imath::V2i& last = header.displayWindow().max;  // from 0,0
  Film film = make_film(last.x + 1, last.y + 1, window_of(header),
                        {.position = has("P.X"),
                         .albedo = has("Albedo.R"),
                         .object = has("objectId"),
                         .tests = has("tests"),
                         .doubts = has("doubts"),
                         .sums = true});
  add_sums(film, has("error"));
  std::vector<std::string> names;
  for (const Channel& channel : channels_of(film)) names.push_back(channel.name);
  require_channels(path, channels, names);
  return film;
}

/// Returns the metadata that encode_exr wrote.
ExrMetadata metadata_of(const Imf::Header& header) {
  ExrMetadata metadata;
  for (auto at = header.begin(); at != header.end(); ++at) {
    const auto* const text = dynamic_cast<const Imf::StringAttribute*>(&at.attribute());
    if (text != nullptr) metadata.attributes[at.name()] = text->value();
  }
  if (Imf::hasWorldToCamera(header)) {
    const Imath::M44f& m = Imf::worldToCamera(header);
    std::memcpy(glm::value_ptr(metadata.world_to_camera), m.x, sizeof m.x);
  }
  metadata.screen_window_width = header.screenWindowWidth();
  return metadata;
}

/// Returns whether the file in `bytes` contains the rows `window` of `film`, bit for bit.
bool holds_rows(const std::string& bytes, const Film& film, const PixelRect& window) {
  constexpr int kRows = 64;  // per read
  Imf::StdISStream stream;
  stream.str(bytes);
  Imf::InputFile file(stream, 0);
  const std::vector<Channel> channels = channels_of(film);
  const auto width = static_cast<std::size_t>(window.width());
  std::vector<std::uint32_t> numbers(channels.size() * width * kRows);
  PixelRect block = window;
  for (; block.y0 < window.y1; block.y0 = block.y1) {
    block.y1 = std::min(block.y0 + kRows, window.y1);
    const std::size_t count = width * static_cast<std::size_t>(block.height());
    Imf::FrameBuffer slices;
    for (std::size_t k = 0; k < channels.size(); ++k) {
      slices.insert(channels[k].name,
                    slice_of(type_of(channels[k]), &numbers[k * count], sizeof numbers[0], block));
    }
    file.setFrameBuffer(slices);
    file.readPixels(block.y0, block.y1 - 1);
    const std::size_t first = film.index_of(block.x0, block.y0);
    for (std::size_t k = 0; k < channels.size(); ++k) {
      const char* at = static_cast<const char*>(channels[k].first) + first * channels[k].stride;
      for (std::size_t i = 0; i < count; ++i, at += channels[k].stride) {
        if (std::memcmp(at, &numbers[k * count + i], sizeof numbers[0]) != 0) return false;
      }
    }
  }
  return true;
}

/// Encodes the rows `window` of the film as a file; without `has_pixels`, only what precedes them.
std::string encode_rows(const Film& film, const ExrMetadata& metadata, const PixelRect& window,
                        bool has_pixels = true) {
  try {
    (void)Imf::globalThreadCount();  // as in with_file()
    Imf::StdOSStream stream;
    {
      Imf::OutputFile file(stream, make_header(film, metadata, window), 0);
      file.setFrameBuffer(slices_of(film));
      if (has_pixels) file.writePixels(window.height());
    }  // the destructor completes the file
    std::string bytes = stream.str();
    // If memory runs out, the library and the stream may omit a block silently.
    if (!has_pixels || holds_rows(bytes, film, window)) return bytes;
  } catch (const Iex::BaseExc&) {  // NOLINT(bugprone-empty-catch): out of memory
  }
  throw std::bad_alloc();
}

constexpr int kBlockRows = 16;  // compressed together by ZIP
constexpr std::size_t kOffsetBytes = 8;

int blocks_of(const PixelRect& window) { return (window.height() + kBlockRows - 1) / kBlockRows; }

}  // namespace

// The library's threads deadlock if a block cannot be allocated, so they are not used. Instead, our
// threads encode files of several blocks each. These are then joined into one file (header, block
// offsets, blocks: "OpenEXR File Layout"). The bytes of a block do not depend on its file.
std::string encode_exr(const Film& film, const ExrMetadata& metadata, int threads) {
  constexpr int kPerThread = 4;  // for load balance
  const int blocks = blocks_of(film.window);
  const int rows = kBlockRows * std::max(1, blocks / (kPerThread * threads));
  const int count = (film.window.height() + rows - 1) / rows;
  if (threads == 1 || count == 1) return encode_rows(film, metadata, film.window);
  const auto window = [&](std::size_t part) {
    PixelRect rect = film.window;
    rect.y0 += static_cast<int>(part) * rows;
    rect.y1 = std::min(rect.y0 + rows, film.window.y1);
    return rect;
  };
  std::vector<std::string> parts(static_cast<std::size_t>(count));
  for_each_on_threads(threads, parts.size(), [&](std::size_t part) {
    parts[part] = encode_rows(film, metadata, window(part));
  });
  std::string bytes = encode_rows(film, metadata, film.window, false);
  // All headers have the same length.
  const std::size_t header = bytes.size() - kOffsetBytes * static_cast<std::size_t>(blocks);
  std::size_t entry = header;
  for (std::size_t part = 0; part < parts.size(); ++part) {
    const std::string file = std::exchange(parts[part], {});
    const auto there = static_cast<std::size_t>(blocks_of(window(part)));
    const std::size_t first = header + kOffsetBytes * there;
    for (std::size_t i = 0; i < there; ++i, entry += kOffsetBytes) {
      const std::uint64_t offset =
          number_at<std::uint64_t>(&file[header + kOffsetBytes * i]) - first + bytes.size();
      std::memcpy(&bytes[entry], &offset, sizeof offset);
    }
    bytes.append(file, first);
  }
  return bytes;
}

EnvironmentMap read_exr(const std::filesystem::path& path) {
  return with_file(path, [&](Imf::InputFile& file) {
    const std::string names[] = {"R", "G", "B"};
    require_channels(path, file.header().channels(), names);
    const PixelRect window = window_of(file.header());
    EnvironmentMap map;
    map.width = window.width();
    map.height = window.height();
    map.texels.resize(std::size_t(map.width) * std::size_t(map.height));
    Imf::FrameBuffer slices;
    for (int k = 0; k < 3; ++k) {
      slices.insert(names[k],
                    slice_of(Imf::FLOAT, &map.texels[0][k], sizeof map.texels[0], window));
    }
    file.setFrameBuffer(slices);
    file.readPixels(window.y0, window.y1 - 1);
    return map;
  });
}

FilmFile read_film(const std::filesystem::path& path) {
  return with_file(path, [&](Imf::InputFile& file) {
    const Imath::V2i& corner = file.header().displayWindow().min;
    if (corner != Imath::V2i(0, 0)) {
      throw InputError(path.string() + ": found a frame that begins at " +
                       std::to_string(corner.x) + "," + std::to_string(corner.y) +
                       ", expected a picture of `render`");
    }
    FilmFile result{film_like(path, file.header()), metadata_of(file.header())};
    file.setFrameBuffer(slices_of(result.film));
    file.readPixels(result.film.window.y0, result.film.window.y1 - 1);
    return result;
  });
}

bool is_exr(const std::filesystem::path& file) {
  char magic[4] = {};
  std::ifstream(file, std::ios::binary).read(magic, sizeof magic);
  return Imf::isImfMagic(magic);
}

}  // namespace raygate
