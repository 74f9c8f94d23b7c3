// MtlReader: reads the materials of an MTL file.
#pragma once

#include <optional>

#include "host/scene/io/text_lines.h"
#include "host/scene/scene.h"

namespace raygate {

/// Reads the statements that Material has members for. Clamps values out of range, with a warning.
/// Ignores other statements, with a warning if they would change a picture. Throws InputError for
/// other errors.
class MtlReader final : public StatementReader {
 public:
  /// Searches for textures in the file's folder, by find_file. `warnings` must outlive this object.
  MtlReader(const std::filesystem::path& file, std::vector<std::string>& warnings)
      : StatementReader(file, warnings), folder_(file.parent_path()) {}

  /// Returns the materials in the file's order. Of several with one name the first is kept.
  [[nodiscard]] std::vector<Material> read();

 private:
  void read_statement(std::string_view statement);
  void begin_material(std::string_view name);
  void read_colour(std::string_view keyword, std::string_view words, glm::vec3& colour);
  void read_value(std::string_view keyword, std::string_view words);
  void read_map(std::string_view keyword, std::string_view words);
  void finish_material();
  void settle_transparency();
  glm::vec2 take_texture_vector(const std::string& of_what, std::string_view& words) const;

  std::filesystem::path folder_;
  std::vector<Material> materials_;
  std::set<std::string, std::less<>> names_;
  Material material_;                          // the material that is being read
  bool in_material_ = false;                   // whether there was a newmtl
  bool is_kept_ = false;                       // whether its name is new
  bool has_emission_ = false;                  // whether there was a Ke
  bool has_diffuse_ = false;                   // whether there was a Kd or map_Kd
  bool has_opacity_ = false;                   // whether there was a d, which Tr does not change
  bool has_no_shine_ = false;                  // whether there was an Ns 0
  std::optional<float> roughness_, metallic_;  // Pr and Pm
  /// Tr of a material without d whose illumination model is not transparent.
  struct Transparency {
    std::size_t material, line;
    double tr;
  };
  std::optional<Transparency> transparency_;  // of the material that is being read
  std::vector<Transparency> transparencies_;
};

}  // namespace raygate
