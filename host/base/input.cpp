#include "host/base/input.h"

#include <locale.h>

#include <bit>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstdlib>
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

std::string in_quotes(std::string_view word) {
  constexpr std::size_t kLongest = 40;
  std::string result = "'";
  for (const char c : word.substr(0, kLongest)) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x20 && byte != 0x7F) {
      result += c;
    } else {
      char hex[5];
      std::snprintf(hex, sizeof hex, "\\x%02X", byte);
      result += hex;
    }
  }
  return result + (word.size() > kLongest ? "...'" : "'");
}

std::optional<double> to_number(std::string_view word) {
  if (word.starts_with('+')) {
    word.remove_prefix(1);
    if (word.starts_with('-')) return std::nullopt;
  }
  double value = 0.0;
  const char* const end = word.data() + word.size();
  const auto [rest, error] = std::from_chars(word.data(), end, value);
  if (error == std::errc::invalid_argument || rest != end) return std::nullopt;
  if (error == std::errc::result_out_of_range) {
    // from_chars does not tell overflow from underflow; strtod does.
    static const locale_t c_locale = newlocale(LC_ALL_MASK, "C", nullptr);
    value = strtod_l(std::string(word).c_str(), nullptr, c_locale);
  }
  return value;
}

}  // namespace raygate
