#include "host/film/exr_check.h"

#include <ImfVersion.h>
#include <openexr.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <fstream>
#include <new>
#include <string>
#include <string_view>
#include <system_error>

#include "host/base/file_bytes.h"
#include "host/base/input_error.h"

namespace raygate {
namespace {

/// Types of attributes whose values have one length in bytes, which the library takes for granted.
struct Fixed {
  std::string_view type;
  std::int32_t length;
};
constexpr Fixed kFixed[] = {
    {"box2i", 16}, {"box2f", 16},      {"v2i", 8},    {"v2f", 8},       {"v3i", 12},
    {"v3f", 12},   {"m33f", 36},       {"m44f", 64},  {"float", 4},     {"double", 8},
    {"int", 4},    {"compression", 1}, {"envmap", 1}, {"lineOrder", 1}, {"chromaticities", 32}};

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

/// Throws where an attribute of the header is longer than the file, or longer or shorter than its
/// type: the library takes the memory for it before it reads. ("OpenEXR File Layout": each is a
/// name, a type, a length and a value.)
void require_lengths(const std::filesystem::path& path) {
  constexpr std::streamoff kBegin = 8;  // after the magic number and the version
  const auto most = static_cast<std::int64_t>(std::filesystem::file_size(path));
  std::ifstream in(path, std::ios::binary);
  in.seekg(kBegin);
  for (std::string name, type; std::getline(in, name, '\0') && !name.empty();) {
    std::getline(in, type, '\0');
    char bytes[sizeof(std::int32_t)] = {};
    in.read(bytes, sizeof bytes);
    const auto length = number_at<std::int32_t>(bytes);
    if (!in || length < 0 || length > most) {
      throw InputError(path.string() + ": damaged: a header that is longer than the file");
    }
    const auto* const fixed = std::ranges::find(kFixed, type, &Fixed::type);
    if (fixed != std::end(kFixed) && length != fixed->length) {
      throw InputError(path.string() + ": damaged: a " + type + " of another length in its header");
    }
    in.seekg(length, std::ios::cur);
  }
}

/// Throws for what the library's C functions find wrong in a header, as a list of channels that
/// ends elsewhere than it says: its C++ functions take what follows for something else.
void require_types(const std::filesystem::path& path) {
  exr_context_initializer_t options = EXR_DEFAULT_CONTEXT_INITIALIZER;
  options.error_handler_fn = [](exr_const_context_t, exr_result_t, const char*) {};
  exr_context_t file = nullptr;
  const exr_result_t result = exr_start_read(&file, path.c_str(), &options);
  if (result == EXR_ERR_OUT_OF_MEMORY) throw std::bad_alloc();
  if (result != EXR_ERR_SUCCESS) {
    throw InputError(path.string() + ": damaged: " + exr_get_default_error_message(result));
  }
  exr_finish(&file);
}

}  // namespace

bool is_exr(const std::filesystem::path& file) {
  char magic[4] = {};
  std::ifstream(file, std::ios::binary).read(magic, sizeof magic);
  return Imf::isImfMagic(magic);
}

void require_exr(const std::filesystem::path& file) {
  require_readable(file);
  require_lengths(file);
  require_types(file);
}

}  // namespace raygate
