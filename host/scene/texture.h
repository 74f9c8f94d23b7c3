// Texture: an 8-bit picture, decoded and sampled.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace raygate {

/// What a texture shows where a coordinate leaves [0, 1].
enum class Wrap : std::uint8_t { kRepeat, kClamp, kMirror };

/// How a texture is sampled.
struct Sampling {
  Sampling(Wrap both = Wrap::kRepeat) : u(both), v(both) {}
  Wrap u, v;
  bool is_nearest = false;  ///< the nearest texel alone counts

  [[nodiscard]] bool operator==(const Sampling&) const = default;
};

/// An 8-bit sRGB picture that gives scene-linear colours. Coordinate (0, 0) is its lower left
/// corner and (1, 1) its upper right one, as OBJ files have it.
class Texture {
 public:
  using Texel = std::array<std::uint8_t, 3>;  ///< sRGB codes

  /// What is read of a file: its colours; or its opacity, as all three codes. Where it has none:
  /// what is bright (MTL), or 1 (kAlpha, glTF).
  enum class Content : std::uint8_t { kColour, kOpacity, kAlpha };

  /// `texels`, row by row from the top; width * height of them, at least one.
  Texture(int width, int height, std::vector<Texel> texels);

  /// Reads a PNG, JPEG, TGA or BMP file; a palette, grey and 16 bits become 24-bit RGB. Throws
  /// InputError: what cannot be read or is none of these, is damaged, or has more than 2^26 pixels.
  [[nodiscard]] static Texture load(const std::filesystem::path& file,
                                    Content content = Content::kColour);

  /// The same of a file's bytes; `name` is for messages.
  [[nodiscard]] static Texture decode(std::string_view bytes, const std::string& name,
                                      Content content = Content::kColour);

  /// The red codes of two textures as green and blue codes of one, as large as the larger one; 255
  /// for one that is not given. One of them is.
  [[nodiscard]] static Texture combine_channels(const Texture* green, const Texture* blue);

  /// The least of the red codes, from 0 to 1.
  [[nodiscard]] double min_code() const;

  /// The least of the red codes that codes_at reads within `reach` of a point, on both axes; 0
  /// where these are many texels.
  [[nodiscard]] double min_code_near(const glm::dvec2& uv, const glm::dvec2& reach,
                                     const Sampling& sampling) const;

  /// The mean of all texels' scene-linear colours.
  [[nodiscard]] glm::dvec3 mean_color() const;

  /// Scene-linear colour, between the four nearest texels' middles in proportion (bilinear). Not
  /// finite coordinates count as 0.
  [[nodiscard]] glm::vec3 at(const glm::dvec2& uv, const Sampling& sampling) const;

  /// The codes themselves, from 0 to 1, likewise between texels.
  [[nodiscard]] glm::vec3 codes_at(const glm::dvec2& uv, const Sampling& sampling) const;

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] const std::vector<Texel>& texels() const { return texels_; }  ///< row by row

 private:
  template <class TexelValue>
  [[nodiscard]] glm::vec3 between(const glm::dvec2& uv, const Sampling& sampling,
                                  const TexelValue& value) const;

  int width_, height_;
  std::vector<Texel> texels_;
};

}  // namespace raygate
