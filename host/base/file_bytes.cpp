#include "host/base/file_bytes.h"

#include <bit>
#include <cerrno>
#include <fstream>
#include <system_error>

#include "host/base/input_error.h"

namespace raygate {

static_assert(std::endian::native == std::endian::little);

std::string read_file(const std::filesystem::path& file) {
  const std::string name = file.string();
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(file, ignored);
  if (std::filesystem::is_directory(status)) {
    throw InputError(name + ": is a folder, expected a file");
  }
  if (std::filesystem::is_character_file(status) || std::filesystem::is_block_file(status)) {
    throw InputError(name + ": is a device, expected a file");  // reading it might never end
  }
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw InputError(name + ": cannot read: " + std::strerror(errno));
  std::string text;
  const std::uintmax_t size = std::filesystem::file_size(file, ignored);
  if (!ignored) text.reserve(size);
  char block[1 << 16];
  while (stream.read(block, sizeof block) || stream.gcount() > 0) {
    text.append(block, static_cast<std::size_t>(stream.gcount()));
  }
  if (stream.bad()) throw InputError(name + ": cannot read: " + std::strerror(errno));
  if (text.empty()) throw InputError(name + ": the file is empty");
  return text;
}

namespace {

template <class Number>
double read(const char* bytes, bool highest_first) {
  return number_at<Number>(bytes, highest_first);
}

struct Reader {
  std::size_t bytes;
  double (*read)(const char* bytes, bool highest_first);
};
constexpr Reader kReaders[] = {{1, read<std::int8_t>},  {1, read<std::uint8_t>},
                               {2, read<std::int16_t>}, {2, read<std::uint16_t>},
                               {4, read<std::int32_t>}, {4, read<std::uint32_t>},
                               {4, read<float>},        {8, read<double>}};  // by NumberType

}  // namespace

std::size_t bytes_of(NumberType type) { return kReaders[static_cast<std::size_t>(type)].bytes; }

double number_at(const char* bytes, NumberType type, bool highest_first) {
  return kReaders[static_cast<std::size_t>(type)].read(bytes, highest_first);
}

}  // namespace raygate
