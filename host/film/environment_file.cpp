#include "host/film/environment_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <regex>
#include <string>
#include <string_view>
#include <system_error>

#include "host/base/elementary.h"
#include "host/base/input.h"
#include "host/base/input_error.h"
#include "host/film/exr.h"

namespace raygate {
namespace {

float usable(double x) { return x > 0.0 ? static_cast<float>(std::min(x, 1e30)) : 0.0f; }

/// Reads a Radiance file sequentially.
class Reader {
 public:
  Reader(std::string name, std::string_view bytes) : name_(std::move(name)), rest_(bytes) {}

  EnvironmentMap read() {
    EnvironmentMap picture;
    read_header(picture);
    if (std::int64_t{picture.width} * picture.height > kMaxPixels) {
      fail("more than " + std::to_string(kMaxPixels) + " pixels");
    }
    // Even with the longest runs, a row takes more than one byte.
    if (rest_.size() < static_cast<std::size_t>(picture.height)) fail("it ends too early");
    std::vector<Rgbe> row(static_cast<std::size_t>(picture.width));
    for (int y = 0; y < picture.height; ++y) {
      read_row(row);
      for (const Rgbe& pixel : row) {
        const double unit = pixel[3] == 0 ? 0.0 : std::ldexp(1.0 / exposure_, pixel[3] - 136);
        picture.texels.emplace_back(usable(unit * pixel[0]), usable(unit * pixel[1]),
                                    usable(unit * pixel[2]));
      }
    }
    return picture;
  }

 private:
  using Rgbe = std::array<std::uint8_t, 4>;

  [[noreturn]] void fail(const std::string& what) const { throw InputError(name_ + ": " + what); }

  std::string line() {
    const std::size_t end = rest_.find('\n');
    if (end == std::string_view::npos || end > 4096) fail("damaged: its header has no end");
    std::string text(rest_.substr(0, end));
    rest_.remove_prefix(end + 1);
    if (text.ends_with('\r')) text.pop_back();
    return text;
  }

  void read_header(EnvironmentMap& picture) {
    if (!rest_.starts_with("#?")) {
      fail("found a file of another kind, expected OpenEXR or Radiance HDR");
    }
    for (std::string text = line(); !text.empty(); text = line()) {
      if (text.starts_with("FORMAT=") && text != "FORMAT=32-bit_rle_rgbe") {
        fail(in_quotes(text) + ", expected FORMAT=32-bit_rle_rgbe");
      }
      if (!text.starts_with("EXPOSURE=")) continue;
      const std::size_t number = std::min(text.find_first_not_of(' ', 9), text.size());
      double factor = 0.0;
      std::from_chars(&text[number], &text[text.size()], factor);
      exposure_ *= factor;
      if (!(exposure_ > 1e-30 && exposure_ < 1e30)) fail("EXPOSURE: expected a positive number");
    }
    const std::string size = line();
    std::smatch sides;
    if (!std::regex_match(size, sides, std::regex(R"(-Y +(\d{1,9}) +\+X +(\d{1,9}))"))) {
      fail(in_quotes(size) + ", expected -Y HEIGHT +X WIDTH");
    }
    picture.height = std::stoi(sides[1]);
    picture.width = std::stoi(sides[2]);
    if (picture.width < 1 || picture.height < 1) {
      fail(in_quotes(size) + ", expected at least one pixel");
    }
  }

  std::uint8_t byte() {
    if (rest_.empty()) fail("it ends too early");
    const auto found = static_cast<std::uint8_t>(rest_.front());
    rest_.remove_prefix(1);
    return found;
  }

  /// Reads a row: run-length encoded by component if its first bytes say so, otherwise flat.
  void read_row(std::vector<Rgbe>& row) {
    const std::size_t width = row.size();
    if (width < 8 || width >= 0x8000 || !rest_.starts_with("\2\2")) {
      for (Rgbe& pixel : row) {
        for (std::uint8_t& component : pixel) component = byte();
      }
      return;
    }
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

  std::string name_;
  std::string_view rest_;
  double exposure_ = 1.0;
};

}  // namespace

EnvironmentMap read_hdr(const std::filesystem::path& file) {
  const std::string bytes = read_file(file);
  return Reader(file.string(), bytes).read();
}

void load_environment(const EnvironmentSetting& setting, const glm::dvec3& up, Scene& scene) {
  std::error_code ignored;  // reading reports the error
  // A pipe can be read only once, so it is read as a Radiance file.
  const bool has_exr =
      std::filesystem::is_regular_file(setting.file, ignored) && is_exr(setting.file);
  EnvironmentMap map = has_exr ? read_exr(setting.file) : read_hdr(setting.file);
  for (glm::vec3& texel : map.texels) texel = {usable(texel.x), usable(texel.y), usable(texel.z)};
  map.strength = static_cast<float>(setting.strength);
  map.up = glm::normalize(up);
  // Perpendicular to `up`, close to -z or +y.
  const glm::dvec3 across = glm::cross(map.up, glm::dvec3(1.0, 0.0, 0.0));
  const glm::dvec3 ahead =
      glm::length(across) > 1e-6 ? glm::normalize(across) : glm::dvec3(0.0, 0.0, -1.0);
  const auto turn = sine_cosine(setting.rotation / 360.0);
  map.ahead = turn.cosine * ahead + turn.sine * glm::cross(map.up, ahead);
  scene.files.push_back(setting.file);
  scene.environment = std::move(map);
}

}  // namespace raygate
