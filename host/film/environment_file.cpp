#include "host/film/environment_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <system_error>

#include "host/base/elementary.h"
#include "host/base/file_bytes.h"
#include "host/base/input_error.h"
#include "host/film/exr.h"

namespace raygate {
namespace {

using Rgbe = std::array<std::uint8_t, 4>;

/// Reads a Radiance file sequentially.
class Reader {
 public:
  Reader(std::string name, std::string_view bytes) : name_(std::move(name)), rest_(bytes) {}

  HdrImage read() {
    read_header();
    HdrImage picture;
    read_size(picture);
    if (std::int64_t{picture.width} * picture.height > kMaxPixels) {
      fail("more than " + std::to_string(kMaxPixels) + " pixels");
    }
    // With the longest runs, a pixel takes 1/8 byte.
    if (rest_.size() < static_cast<std::size_t>(picture.height)) fail("it ends too early");
    std::vector<Rgbe> row(static_cast<std::size_t>(picture.width));
    for (int y = 0; y < picture.height; ++y) {
      read_row(row);
      for (const Rgbe& pixel : row) {
        const double unit = pixel[3] == 0 ? 0.0 : std::ldexp(1.0 / exposure_, pixel[3] - 136);
        picture.pixels.emplace_back(
            glm::min(unit * glm::dvec3(pixel[0], pixel[1], pixel[2]), glm::dvec3(kMost)));
      }
    }
    return picture;
  }

 private:
  static constexpr double kMost = 1e30;

  [[noreturn]] void fail(const std::string& what) const { throw InputError(name_ + ": " + what); }

  std::string_view line() {
    const std::size_t end = rest_.find('\n');
    if (end == std::string_view::npos || end > 4096) fail("damaged: its header has no end");
    std::string_view found = rest_.substr(0, end);
    rest_.remove_prefix(end + 1);
    if (found.ends_with('\r')) found.remove_suffix(1);
    return found;
  }

  static std::string quoted(std::string_view text) {
    return std::string("'").append(text).append("'");
  }

  void read_header() {
    if (!rest_.starts_with("#?"))
      fail("found a file of another kind, expected OpenEXR or Radiance HDR");
    for (std::string_view text = line(); !text.empty(); text = line()) {
      if (text.starts_with("FORMAT=") && text != "FORMAT=32-bit_rle_rgbe") {
        fail(quoted(text) + ", expected FORMAT=32-bit_rle_rgbe");
      }
      if (!text.starts_with("EXPOSURE=")) continue;
      text.remove_prefix(text.find('=') + 1);
      while (text.starts_with(' ')) text.remove_prefix(1);
      double factor = 0.0;
      std::from_chars(text.data(), text.data() + text.size(), factor);
      if (!(factor > 1e-30 && factor < 1e30)) fail("EXPOSURE: expected a positive number");
      exposure_ *= factor;
    }
    if (!(exposure_ > 1e-30 && exposure_ < 1e30)) fail("EXPOSURE: expected a positive number");
  }

  void read_size(HdrImage& picture) {
    const std::string_view text = line();
    const auto number = [&](std::string_view before, std::size_t& at) {
      if (at > text.size() || text.substr(at, before.size()) != before) {
        at = std::string_view::npos;
        return 0;
      }
      int value = 0;
      const char* const end = text.data() + text.size();
      const auto found = std::from_chars(text.data() + at + before.size(), end, value);
      at = static_cast<std::size_t>(found.ptr - text.data());
      return value;
    };
    std::size_t at = 0;
    picture.height = number("-Y ", at);
    picture.width = number(" +X ", at);
    if (at != text.size() || picture.width < 1 || picture.height < 1) {
      fail(quoted(text.substr(0, 40)) + ", expected -Y HEIGHT +X WIDTH");
    }
  }

  std::uint8_t byte() {
    if (rest_.empty()) fail("it ends too early");
    const auto found = static_cast<std::uint8_t>(rest_.front());
    rest_.remove_prefix(1);
    return found;
  }

  /// Reads a row: run-length encoded by component if its first bytes say so, otherwise pixel by
  /// pixel, where (1, 1, 1, n) repeats the previous pixel.
  void read_row(std::vector<Rgbe>& row) {
    const std::size_t width = row.size();
    const bool is_new = width >= 8 && width < 0x8000 && rest_.size() >= 4 && rest_[0] == 2 &&
                        rest_[1] == 2 && (static_cast<std::uint8_t>(rest_[2]) & 0x80) == 0;
    if (!is_new) return read_old_row(row);
    rest_.remove_prefix(2);
    const std::size_t said = std::size_t{byte()} << 8 | byte();
    if (said != width) fail("damaged: a row of " + std::to_string(said) + " pixels");
    for (std::size_t component = 0; component < 4; ++component) {
      for (std::size_t x = 0; x < width;) {
        std::size_t count = byte();
        const bool is_run = count > 128;
        if (is_run) count -= 128;
        if (count == 0 || count > width - x) fail("damaged: a run that is too long");
        std::uint8_t value = is_run ? byte() : std::uint8_t{0};
        for (; count > 0; --count) {
          if (!is_run) value = byte();
          row[x++][component] = value;
        }
      }
    }
  }

  void read_old_row(std::vector<Rgbe>& row) {
    int shift = 0;
    for (std::size_t x = 0; x < row.size();) {
      Rgbe pixel;
      for (std::uint8_t& component : pixel) component = byte();
      if (pixel[0] != 1 || pixel[1] != 1 || pixel[2] != 1) {
        row[x++] = pixel;
        shift = 0;
        continue;
      }
      const std::size_t count = shift > 16 ? row.size() : std::size_t{pixel[3]} << shift;
      if (x == 0 || count > row.size() - x) fail("damaged: a run that is too long");
      for (std::size_t k = 0; k < count; ++k, ++x) row[x] = row[x - 1];
      shift += 8;
    }
  }

  std::string name_;
  std::string_view rest_;
  double exposure_ = 1.0;
};

float usable(double x) { return x > 0.0 ? static_cast<float>(std::min(x, 1e30)) : 0.0f; }

/// Returns the direction ahead for this up direction: perpendicular to `up`, close to -z or +y.
glm::dvec3 ahead_of(const glm::dvec3& up) {
  const glm::dvec3 across = glm::cross(up, glm::dvec3(1.0, 0.0, 0.0));
  return glm::length(across) > 1e-6 ? glm::normalize(across) : glm::dvec3(0.0, 0.0, -1.0);
}

}  // namespace

HdrImage read_hdr(const std::filesystem::path& file) {
  const std::string bytes = read_file(file);
  return Reader(file.string(), bytes).read();
}

void load_environment(const EnvironmentSetting& setting, const glm::dvec3& up, Scene& scene) {
  EnvironmentMap map;
  std::error_code ignored;  // reading reports the error
  if (std::filesystem::is_regular_file(setting.file, ignored) && is_exr(setting.file)) {
    const std::string names[] = {"R", "G", "B"};
    const ChannelPicture picture = read_exr(setting.file, names);
    map.width = picture.window.width();
    map.height = picture.window.height();
    const auto& channels = picture.channels;
    for (std::size_t i = 0; i < channels[0].size(); ++i) {
      map.texels.emplace_back(usable(channels[0][i]), usable(channels[1][i]),
                              usable(channels[2][i]));
    }
  } else {  // a pipe can be read only once
    HdrImage picture = read_hdr(setting.file);
    map.width = picture.width;
    map.height = picture.height;
    map.texels = std::move(picture.pixels);
  }
  map.strength = static_cast<float>(setting.strength);
  map.up = glm::normalize(up);
  const glm::dvec3 ahead = ahead_of(map.up);
  const auto turn = sine_cosine(setting.rotation / 360.0);
  map.ahead = turn.cosine * ahead + turn.sine * glm::cross(map.up, ahead);
  scene.files.push_back(setting.file);
  scene.environment = std::move(map);
}

}  // namespace raygate
