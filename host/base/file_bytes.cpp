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

std::size_t bytes_of(NumberType type) {
  constexpr std::size_t kBytes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return kBytes[static_cast<std::size_t>(type)];
}

double number_at(const char* bytes, NumberType type, bool highest_first) {
  switch (type) {
    case NumberType::kInt8:
      return number_at<std::int8_t>(bytes);
    case NumberType::kUint8:
      return number_at<std::uint8_t>(bytes);
    case NumberType::kInt16:
      return number_at<std::int16_t>(bytes, highest_first);
    case NumberType::kUint16:
      return number_at<std::uint16_t>(bytes, highest_first);
    case NumberType::kInt32:
      return number_at<std::int32_t>(bytes, highest_first);
    case NumberType::kUint32:
      return number_at<std::uint32_t>(bytes, highest_first);
    case NumberType::kFloat:
      return number_at<float>(bytes, highest_first);
    case NumberType::kDouble:
      return number_at<double>(bytes, highest_first);
  }
  return 0.0;
}

}  // namespace raygate
