// Reader of an MTL file: its materials.
#pragma once

#include <optional>

#include "host/scene/io/text_lines.h"
#include "host/scene/scene.h"

namespace raygate {

/// Reads what Material holds. Values out of range are clamped with a warning; what Material does
/// not hold is left out, with a warning where that shows in a picture. All else that is wrong is an
/// InputError.
class MtlReader final : public StatementReader {
 public:
  /// Textures are looked for in the file's folder, as find_file does.
  MtlReader(const std::filesystem::path& file, std::vector<std::string>& warnings)
      : StatementReader(file, warnings), folder_(file.parent_path()) {}

  /// The materials in the file's order, each name once: the first of a name stands.
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
  Material material_;          // the one that is being read
  bool in_material_ = false;   // there is one
  bool is_kept_ = false;       // it has a name that is new
  bool has_emission_ = false;  // Ke was there
  bool has_diffuse_ = false;   // Kd was there, or stands in for it
  bool has_opacity_ = false;   // d was there, which Tr does not change
  bool has_no_shine_ = false;  // Ns 0 was there
  // Of the PBR statements.
  std::optional<float> roughness_, metallic_;
  /// What Tr says of a material whose model is not clear and that has no d.
  struct Transparency {
    std::size_t material, line;
    double tr;
  };
  std::optional<Transparency> transparency_;  // of the material that is being read
  std::vector<Transparency> transparencies_;
};

}  // namespace raygate
