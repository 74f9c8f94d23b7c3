// Pictures on surfaces: MTL's map_Kd.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace raygate {

struct Scene;
struct Triangle;

/// What a texture shows where its coordinates leave [0, 1].
enum class Wrap { kRepeat, kClamp };

/// An 8-bit sRGB picture that gives scene-linear colours. Coordinate (0, 0) is its lower left
/// corner and (1, 1) its upper right one, as OBJ files have it.
class Texture {
 public:
  using Texel = std::array<std::uint8_t, 3>;  ///< sRGB codes

  /// `texels`, row by row from the top; width * height of them, at least one.
  Texture(int width, int height, std::vector<Texel> texels);

  /// Reads a PNG, JPEG, TGA or BMP file; a palette, grey and 16 bits become 24-bit RGB, opacity is
  /// left out. Throws InputError: what cannot be read or is none of these, is damaged, or has more
  /// than 2^26 pixels.
  [[nodiscard]] static Texture load(const std::filesystem::path& file);

  /// The same of a file's bytes; `name` is for messages.
  [[nodiscard]] static Texture decode(std::string_view bytes, const std::string& name);

  /// The mean of all texels' codes, from 0 to 1: for pictures whose codes are numbers, not colours.
  [[nodiscard]] glm::dvec3 mean_codes() const;

  /// Scene-linear colour, between the four nearest texels' middles in proportion (bilinear). Not
  /// finite coordinates count as 0.
  [[nodiscard]] glm::vec3 at(const glm::dvec2& uv, Wrap wrap) const;

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }

 private:
  int width_, height_;
  std::vector<Texel> texels_;
};

/// The diffuse colour of `triangle`, one of the scene's, at the point with these weights of its
/// vertices (they sum to 1): the material's Kd times its texture. Where the face has no texture
/// coordinates the texture counts as white.
[[nodiscard]] glm::vec3 diffuse_at(const Scene& scene, const Triangle& triangle,
                                   const glm::dvec3& weights);

/// Loads the textures that materials of triangles name, each file once; fills Scene::textures and
/// the materials' indices. Warns of a file that is missing; throws InputError as Texture::load.
void load_textures(Scene& scene);

}  // namespace raygate
