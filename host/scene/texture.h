// Texture: an 8-bit image, decoded and sampled.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace raygate {

/// Treatment of texture coordinates outside [0, 1].
enum class Wrap : std::uint8_t { kRepeat, kClamp, kMirror };

/// Wrapping and filtering of texture lookups.
struct Sampling {
  Sampling(Wrap both = Wrap::kRepeat) : u(both), v(both) {}
  Wrap u, v;
  bool is_nearest = false;  ///< nearest texel instead of bilinear interpolation

  [[nodiscard]] bool operator==(const Sampling&) const = default;
};

/// An 8-bit sRGB image with lookup in scene-linear colours. Coordinate (0, 0) is the lower left
/// corner and (1, 1) the upper right one, as in OBJ files.
class Texture {
 public:
  using Texel = std::array<std::uint8_t, 3>;  ///< sRGB codes

  /// Channels to read from a file: its colours, or its opacity in all three channels. For images
  /// without opacity, kOpacity reads the brightness (MTL) and kAlpha 1 (glTF).
  enum class Content : std::uint8_t { kColour, kOpacity, kAlpha };

  /// `texels` has width * height elements, at least one, row by row from the top.
  Texture(int width, int height, std::vector<Texel> texels);

  /// Reads a PNG, JPEG, TGA or BMP file. Converts palettes, grey and 16 bits to 24-bit RGB. Throws
  /// InputError for an unreadable or damaged file, another format, or more than 2^26 pixels.
  [[nodiscard]] static Texture load(const std::filesystem::path& file,
                                    Content content = Content::kColour);

  /// Decodes the bytes of a file as load() does; `name` is for messages.
  [[nodiscard]] static Texture decode(std::string_view bytes, const std::string& name,
                                      Content content = Content::kColour);

  /// Returns the smallest red code of all texels, scaled to [0, 1].
  [[nodiscard]] double min_code() const;

  /// Returns the mean scene-linear colour of all texels.
  [[nodiscard]] glm::dvec3 mean_color() const;

  /// Returns the scene-linear colour at a point, with bilinear interpolation of texel centres.
  /// Coordinates that are not finite count as 0.
  [[nodiscard]] glm::vec3 at(const glm::dvec2& uv, const Sampling& sampling) const;

  /// Returns the codes at a point, from 0 to 1, interpolated as in at().
  [[nodiscard]] glm::vec3 codes_at(const glm::dvec2& uv, const Sampling& sampling) const;

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  /// Returns the texels, row by row from the top.
  [[nodiscard]] const std::vector<Texel>& texels() const { return texels_; }

 private:
  template <class TexelValue>
  [[nodiscard]] glm::vec3 between(const glm::dvec2& uv, const Sampling& sampling,
                                  const TexelValue& value) const;

  int width_, height_;
  std::vector<Texel> texels_;
};

}  // namespace raygate
