// Reading input: contents of files, binary and decimal numbers, and quoting of words in messages.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace raygate {

/// Returns a file's contents. Throws InputError for folders, devices, unreadable and empty files.
[[nodiscard]] std::string read_file(const std::filesystem::path& file);

/// Returns the number stored at `bytes`: big-endian if `highest_first`, otherwise little-endian.
template <class Number>
[[nodiscard]] Number number_at(const char* bytes, bool highest_first = false) {
  char ordered[sizeof(Number)];
  for (std::size_t i = 0; i < sizeof(Number); ++i) {
    ordered[i] = bytes[highest_first ? sizeof(Number) - 1 - i : i];
  }
  Number number;
  std::memcpy(&number, ordered, sizeof number);
  return number;
}

/// Number types selected at run time.
enum class NumberType { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat, kDouble };
[[nodiscard]] std::size_t bytes_of(NumberType type);
[[nodiscard]] double number_at(const char* bytes, NumberType type, bool highest_first = false);

/// Returns the word in single quotes for a message. Control characters are written as \xHH; bytes
/// after the first 40 are replaced by "...".
[[nodiscard]] std::string in_quotes(std::string_view word);

/// Returns the double nearest to a decimal number, in any locale; nullopt unless the whole word is
/// a number. "nan" and "inf" are numbers. Overflow gives infinity, underflow 0.
[[nodiscard]] std::optional<double> to_number(std::string_view word);

}  // namespace raygate
