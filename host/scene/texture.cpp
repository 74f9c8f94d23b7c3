#include "host/scene/texture.h"

#include <stb_image.h>

#include <algorithm>
#include <cassert>
#include <climits>
#include <cmath>
#include <cstring>
#include <memory>

#include "host/base/elementary.h"
#include "host/base/input.h"
#include "host/base/input_error.h"

namespace raygate {
namespace {

constexpr std::int64_t kMaxTexels = std::int64_t{1} << 26;

[[noreturn]] void fail(const std::string& name, const std::string& what) {
  throw InputError(name + ": " + what);
}

const std::array<float, 256>& linear_of_code() {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> values{};
    for (std::size_t code = 0; code < values.size(); ++code) {
      values[code] = static_cast<float>(srgb_to_linear(static_cast<double>(code)));
    }
    return values;
  }();
  return table;
}

/// Two adjacent texels of a row or column, and the weight of the second one.
struct Neighbours {
  int first, second;
  double weight;
};

Neighbours neighbours(double coordinate, int size, Wrap wrap, bool is_nearest) {
  if (!std::isfinite(coordinate)) coordinate = 0.0;
  if (wrap == Wrap::kClamp) coordinate = std::clamp(coordinate, 0.0, 1.0);
  if (wrap == Wrap::kRepeat) coordinate -= std::floor(coordinate);
  if (wrap == Wrap::kMirror) {
    coordinate -= 2.0 * std::floor(0.5 * coordinate);
    if (coordinate > 1.0) coordinate = 2.0 - coordinate;
  }
  // Position in texels from the centre of texel 0, in [-0.5, size - 0.5].
  const double place = coordinate * size - 0.5, below = std::floor(place), weight = place - below;
  const int first = static_cast<int>(below) + (is_nearest && weight >= 0.5 ? 1 : 0);
  const auto wrapped = [&](int i) {  // i is in [-size, 2 size)
    if (wrap == Wrap::kClamp) return std::clamp(i, 0, size - 1);
    if (wrap == Wrap::kMirror) return i < 0 ? -1 - i : i >= size ? 2 * size - 1 - i : i;
    return i < 0 ? i + size : i >= size ? i - size : i;
  };
  return {wrapped(first), wrapped(first + 1), is_nearest ? 0.0 : weight};
}

/// Returns whether the bytes begin like a format that Texture::load() supports. stb_image reads
/// more formats, but hangs on some Radiance headers. TGA is detected by valid header fields.
bool is_known_format(std::string_view bytes) {
  using namespace std::string_view_literals;
  if (bytes.starts_with("\x89PNG\r\n\x1a\n") || bytes.starts_with("\xff\xd8\xff") ||
      bytes.starts_with("BM")) {
    return true;
  }
  constexpr std::size_t kTgaHeader = 18;
  if (bytes.size() < kTgaHeader) return false;
  const auto one_of = [&](std::size_t place, std::string_view values) {
    return values.find(bytes[place]) != std::string_view::npos;
  };
  return one_of(1, "\0\1"sv) && one_of(2, "\1\2\3\x09\x0a\x0b") &&
         one_of(16, "\x08\x0f\x10\x18\x20");
}

}  // namespace

Texture::Texture(int width, int height, std::vector<Texel> texels)
    : width_(width), height_(height), texels_(std::move(texels)) {
  assert(width > 0 && height > 0);
  assert(texels_.size() == static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
}

Texture Texture::load(const std::filesystem::path& file, Content content) {
  return decode(read_file(file), file.string(), content);
}

Texture Texture::decode(std::string_view bytes, const std::string& file, Content content) {
  const std::string unreadable = "not a PNG, JPEG, TGA or BMP picture that can be read: ";
  if (!is_known_format(bytes)) {
    fail(file, unreadable + "it begins as none of them");
  }
  if (bytes.size() > INT_MAX) fail(file, unreadable + "too large");
  const int size = static_cast<int>(bytes.size());
  const auto* const first = reinterpret_cast<const stbi_uc*>(bytes.data());
  int width = 0, height = 0, channels = 0;
  if (stbi_info_from_memory(first, size, &width, &height, &channels) == 0) {
    fail(file, unreadable + stbi_failure_reason());
  }
  if (std::int64_t{width} * height > kMaxTexels) {
    fail(file, "a texture of more than " + std::to_string(kMaxTexels) + " pixels");
  }
  const bool is_opacity = content != Content::kColour;
  // The library's error message is missing or stale when a file is truncated.
  const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
      stbi_load_from_memory(first, size, &width, &height, &channels, is_opacity ? 2 : 3),
      stbi_image_free);
  if (!pixels) fail(file, unreadable + "its pixels are damaged or end too soon");
  std::vector<Texel> texels(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  if (is_opacity) {
    // Each pixel is a grey code and an opacity code, which is 255 if the image has no opacity.
    const bool has_opacity = channels == 2 || channels == 4 || content == Content::kAlpha;
    const stbi_uc* code = pixels.get() + (has_opacity ? 1 : 0);
    for (Texel& texel : texels) {
      texel.fill(*code);
      code += 2;
    }
  } else {
    std::memcpy(texels.data(), pixels.get(), sizeof(Texel) * texels.size());
  }
  return {width, height, std::move(texels)};
}

double Texture::min_code() const {
  std::uint8_t least = 255;
  for (const Texel& codes : texels_) least = std::min(least, codes[0]);
  return least / 255.0;
}

glm::dvec3 Texture::mean_color() const {
  const auto& linear = linear_of_code();
  glm::dvec3 sum(0.0);
  for (const auto& [red, green, blue] : texels_) {
    sum += glm::dvec3(linear[red], linear[green], linear[blue]);
  }
  return sum / static_cast<double>(texels_.size());
}

/// Interpolates value(code) of the texels' codes bilinearly, channel by channel.
template <class TexelValue>
glm::vec3 Texture::between(const glm::dvec2& uv, const Sampling& sampling,
                           const TexelValue& value) const {
  const Neighbours x = neighbours(uv.x, width_, sampling.u, sampling.is_nearest);
  const Neighbours y = neighbours(1.0 - uv.y, height_, sampling.v, sampling.is_nearest);
  const auto texel = [&](int column, int row) {
    const Texel& codes = texels_[static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) +
                                 static_cast<std::size_t>(column)];
    return glm::dvec3(value(codes[0]), value(codes[1]), value(codes[2]));
  };
  const glm::dvec3 upper = glm::mix(texel(x.first, y.first), texel(x.second, y.first), x.weight);
  const glm::dvec3 lower = glm::mix(texel(x.first, y.second), texel(x.second, y.second), x.weight);
  return glm::vec3(glm::mix(upper, lower, y.weight));
}

glm::vec3 Texture::at(const glm::dvec2& uv, const Sampling& sampling) const {
  const auto& linear = linear_of_code();
  return between(uv, sampling, [&](std::uint8_t code) { return linear[code]; });
}

glm::vec3 Texture::codes_at(const glm::dvec2& uv, const Sampling& sampling) const {
  return between(uv, sampling, [](std::uint8_t code) { return code / 255.0; });
}

}  // namespace raygate
