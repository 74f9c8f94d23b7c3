// The values of options, from text.
#pragma once

#include <charconv>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/cli/options.h"

namespace raygate {

/// Largest side of a frame in pixels, and largest number of pixels rendered in one run: the film
/// and its encodings then stay below about 5 GB.
inline constexpr int kMaxSide = 65536;
inline constexpr std::int64_t kMaxPixels = std::int64_t{1} << 26;

/// All of `text` as a number of type T ("12", "-1.5e3"); nothing if it is not one or out of T's
/// range. Floating-point numbers may come out infinite or NaN only where the text says so.
template <typename T>
[[nodiscard]] std::optional<T> parse_number(std::string_view text) {
  T value{};
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end) return std::nullopt;
  return value;
}

/// "0,0,10,20" as four numbers; nothing if any of them is not one.
template <typename T>
[[nodiscard]] std::optional<std::vector<T>> parse_list(std::string_view text) {
  std::vector<T> values;
  while (true) {
    const std::size_t comma = text.find(',');
    const std::optional<T> value = parse_number<T>(text.substr(0, comma));
    if (!value) return std::nullopt;
    values.push_back(*value);
    if (comma == std::string_view::npos) return values;
    text.remove_prefix(comma + 1);
  }
}

// Each of these reads the value of one option and throws InputError if it is impossible.

struct Size {
  int width, height;
};
[[nodiscard]] Size parse_size(const std::string& text);                  ///< "640x480"
[[nodiscard]] Engine parse_engine(const std::string& text);              ///< "rtl", "cpu", "check"
[[nodiscard]] std::string parse_unit(const std::string& text);           ///< "pipeline", "serial"
[[nodiscard]] int parse_lanes(const std::string& text);                  ///< "1", "2", "4", "8"
[[nodiscard]] unsigned parse_threads(const std::string& text);           ///< "1" to "1024"
[[nodiscard]] CameraPlacement parse_camera(const std::string& text);     ///< "1,2,3,0,0,0,40"
[[nodiscard]] PixelRect parse_crop(const std::string& text, Size size);  ///< "10,10,20,20"
[[nodiscard]] std::uint64_t parse_seed(const std::string& text);         ///< "7"

/// The pictures to write.
struct Outputs {
  std::optional<std::filesystem::path> exr, png;
};

/// "a.exr" and "a.png" ask for that picture alone, "a" for both; "" for both named after the scene
/// in the current folder, and a folder for both named after the scene in it.
[[nodiscard]] Outputs parse_output(const std::string& text, const std::filesystem::path& scene);

}  // namespace raygate
