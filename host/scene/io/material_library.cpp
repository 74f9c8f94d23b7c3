#include "host/scene/io/material_library.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "host/base/input_error.h"
#include "host/scene/io/find_file.h"
#include "host/scene/io/text.h"

namespace raygate {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A statement of one number, and the range to which it is clamped.
struct Value {
  std::string_view keyword;
  double low, high, instead;  // `instead` replaces a number below `low`
};
constexpr std::array<Value, 7> kValues{{
    {"Ns", 0.0, kInfinity, 0.0},
    {"Ni", 0.001, kInfinity, 1.0},  // some exporters write an index of 0 for "none"
    {"d", 0.0, 1.0, 0.0},
    {"Tr", 0.0, 1.0, 0.0},
    {"illum", 0.0, 10.0, 2.0},
    {"Pr", 0.0, 1.0, 0.0},
    {"Pm", 0.0, 1.0, 0.0},
}};

/// Options of maps besides -s and -o. A word follows; two or three numbers follow -mm and -t.
constexpr std::string_view kTextureOptions[] = {"-blendu",  "-blendv", "-boost",      "-texres",
                                                "-clamp",   "-bm",     "-cc",         "-type",
                                                "-imfchan", "-mm",     "-colorspace", "-t"};

/// Statements that name textures.
constexpr std::array<std::string_view, 6> kMaps{"map_Kd", "map_Ke", "map_Pr",
                                                "map_Pm", "map_d",  "norm"};

std::string shortest(double number) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", number);
  return text;
}

/// Returns the member of the material that a colour statement sets; nullptr for another statement.
/// Ka is parsed and not used.
glm::vec3* colour_of(Material& material, glm::vec3& unused, std::string_view keyword) {
  if (keyword == "Kd") return &material.diffuse;
  if (keyword == "Ks") return &material.specular;
  if (keyword == "Ke") return &material.emission;
  if (keyword == "Tf") return &material.transmittance;
  return keyword == "Ka" ? &unused : nullptr;
}

/// Returns whether an illumination model is glass, for which an opacity of 1 is ignored.
bool is_clear(int model) { return model == 4 || model == 6 || model == 7 || model == 9; }

/// Reads the statements that Material has members for. Clamps values out of range, with a warning.
/// Ignores other statements, with a warning if they would change a picture. Throws InputError for
/// other errors.
class MtlReader final : public StatementReader {
 public:
  /// Searches for textures in the file's folder, by find_file. `warnings` must outlive this object.
  MtlReader(const std::filesystem::path& file, std::vector<std::string>& warnings)
      : StatementReader(file, warnings), folder_(file.parent_path()) {}

  /// Returns the materials in the file's order. Of several with one name the first is kept.
  std::vector<Material> read() {
    while (const auto statement = lines().next()) read_statement(*statement);
    finish_material();
    settle_transparency();
    return std::move(materials_);
  }

 private:
  void read_statement(std::string_view statement) {
    const std::string_view keyword = take_token(statement);
    if (keyword == "newmtl") return begin_material(statement);
    glm::vec3 unused;
    glm::vec3* const colour = colour_of(material_, unused, keyword);
    const bool is_value = std::any_of(kValues.begin(), kValues.end(),
                                      [&](const Value& value) { return value.keyword == keyword; });
    const bool is_map = std::ranges::find(kMaps, keyword) != kMaps.end();
    if ((colour != nullptr || is_value || is_map) && !in_material_) {
      lines().fail(in_quotes(keyword) + " before the first newmtl");
    }
    if (colour != nullptr) {
      read_colour(keyword, statement, *colour);
    } else if (is_value) {
      read_value(keyword, statement);
    } else if (is_map) {
      read_map(keyword, statement);
    } else {
      warn_once(keyword, in_quotes(keyword) + " is not supported, ignored");
    }
  }

  /// Decides whether Tr is the transparency, as specified, or the opacity, as MeshLab and others
  /// write it: if a comment names MeshLab, or the file has a Tr 1, which would make a surface
  /// invisible, and no Tr 0.
  void settle_transparency() {
    const auto any = [&](double tr) {
      return std::ranges::find(transparencies_, tr, &Transparency::tr) != transparencies_.end();
    };
    const bool is_meshlab = lines().has("MeshLab") || lines().has("Meshlab");
    if (transparencies_.empty() || !(is_meshlab || (any(1.0) && !any(0.0)))) return;
    for (const auto& [material, line, tr] : transparencies_) {
      materials_[material].opacity = static_cast<float>(tr);
    }
    lines().go_to(transparencies_.front().line);
    warn("Tr is read as the opacity, as MeshLab writes it, in all of the file");
  }

  /// Completes a material. Any PBR statement selects the metallic-roughness model. Defaults are
  /// those of the exporters that write such statements: no metal, and Ns = 1000 (1 - roughness)^2.
  void finish_material() {
    if (!is_kept_) return;
    if (transparency_ && !has_opacity_ && !is_clear(material_.illumination_model)) {
      transparencies_.push_back(*transparency_);
    }
    // Exporters write Ns 0 for "no highlight".
    if (material_.illumination_model == 2 && has_no_shine_) material_.specular = glm::vec3(0.0f);
    const bool has_maps = material_.metallic_roughness.has_value();  // begun by map_Pr or map_Pm
    if (has_maps || roughness_ || metallic_) {
      if (!has_maps) material_.metallic_roughness.emplace();
      MetallicRoughness& shares = *material_.metallic_roughness;
      const float root = std::sqrt(std::min(material_.shininess / 1000.0f, 1.0f));
      const bool has_rough_map = !shares.map.file.empty(),
                 has_metal_map = !shares.metallic_file.empty();
      shares.roughness = roughness_.value_or(has_rough_map ? 1.0f : 1.0f - root);
      shares.metallic = metallic_.value_or(has_metal_map ? 1.0f : 0.0f);
      const int model = material_.illumination_model;
      if (model == 6 || model == 7) {
        shares.transmission = 1.0f;
        material_.opacity = 1.0f;
      }
    }
    materials_.push_back(std::move(material_));
  }

  void begin_material(std::string_view name) {
    finish_material();
    material_ = {};
    roughness_ = metallic_ = std::nullopt;
    transparency_ = std::nullopt;
    material_.name = name;
    in_material_ = true;
    has_diffuse_ = has_emission_ = has_opacity_ = has_no_shine_ = false;
    is_kept_ = !name.empty() && names_.emplace(name).second;
    if (name.empty()) {
      warn("newmtl without a name: nothing can use this material, ignored");
    } else if (!is_kept_) {
      warn("material " + in_quotes(name) + " was defined before, which stands");
    }
  }

  void read_colour(std::string_view keyword, std::string_view words, glm::vec3& colour) {
    std::string_view peeked = words;
    const std::string_view first = take_token_before_comment(peeked);
    if (first == "spectral" || first == "xyz") {
      return warn(std::string(keyword) + " " + std::string(first) + " is not supported, ignored");
    }
    std::array<double, 3> rgb{};
    std::size_t count = 0;
    for (std::string_view word = take_token_before_comment(words); !word.empty();
         word = take_token_before_comment(words)) {
      if (count == 3) lines().fail(std::string(keyword) + " with more than 3 numbers");
      rgb[count] = lines().number(word, keyword);
      if (rgb[count] < 0.0) {
        warn(std::string(keyword) + " " + in_quotes(word) + " is negative, taken as 0");
        rgb[count] = 0.0;
      }
      ++count;
    }
    if (count == 1) {
      rgb[1] = rgb[2] = rgb[0];
    } else if (count != 3) {
      lines().fail(std::string(keyword) + " with " + std::to_string(count) +
                   " numbers, expected red, green and blue, or one for all three");
    }
    has_diffuse_ = has_diffuse_ || keyword == "Kd";
    has_emission_ = has_emission_ || keyword == "Ke";
    colour = {rgb[0], rgb[1], rgb[2]};
  }

  void read_value(std::string_view keyword, std::string_view words) {
    std::string_view word = take_token_before_comment(words);
    if (keyword == "d" && word == "-halo") {
      warn("d -halo is not supported, taken as d");
      word = take_token_before_comment(words);
    }
    const std::string_view more = take_token_before_comment(words);
    if (word.empty() || !more.empty()) {
      // Old exporters write three numbers at Tr in place of Tf, with an unknown meaning.
      lines().fail(std::string(keyword) + ": expected one number");
    }
    double number = lines().number(word, keyword);
    const Value& value = *std::find_if(kValues.begin(), kValues.end(),
                                       [&](const Value& v) { return v.keyword == keyword; });
    if (number < value.low || number > value.high) {
      number = number < value.low ? value.instead : value.high;
      warn(std::string(keyword) + " " + in_quotes(word) + " is out of range, taken as " +
           shortest(number));
    }
    if (keyword == "illum") {
      if (number != std::floor(number)) {
        lines().fail("illum: " + in_quotes(word) + ", expected a whole number from 0 to 10");
      }
      material_.illumination_model = static_cast<int>(number);
    } else if (keyword == "Ns") {
      material_.shininess = static_cast<float>(number);
      has_no_shine_ = number == 0.0;
    } else if (keyword == "Pr") {
      roughness_ = static_cast<float>(number);
    } else if (keyword == "Pm") {
      metallic_ = static_cast<float>(number);
    } else if (keyword == "Ni") {
      material_.refraction_index = static_cast<float>(number);
    } else if (keyword == "d") {
      material_.opacity = static_cast<float>(number);
      has_opacity_ = true;
    } else if (!has_opacity_) {  // Tr
      material_.opacity = static_cast<float>(1.0 - number);
      transparency_ = {materials_.size(), lines().line(), number};
    }
  }

  void read_map(std::string_view keyword, std::string_view words) {
    const std::string map(keyword);
    TextureMapping mapping;
    float normal_scale = 1.0f;
    while (words.starts_with('-')) {
      std::string_view rest = words;
      const std::string_view name = take_token(rest);
      const bool is_vector = name == "-s" || name == "-o";
      if (!is_vector && std::ranges::find(kTextureOptions, name) == std::end(kTextureOptions)) {
        break;  // a file whose name begins with '-'
      }
      words = rest;
      if (name == "-clamp") {
        if (take_token(rest) == "on") mapping.sampling = Wrap::kClamp;
        words = rest;
      } else if (name == "-s") {
        mapping.scale = take_texture_vector(map + " -s", words);
      } else if (name == "-o") {
        mapping.offset = take_texture_vector(map + " -o", words);
      } else if (name == "-bm" && keyword == "norm") {
        normal_scale = static_cast<float>(lines().number(take_token(rest), "norm -bm"));
        words = rest;
      } else {
        warn_once(map + " option", map + " " + std::string(name) + " is not supported, ignored");
        const int most = name == "-mm" ? 2 : name == "-t" ? 3 : 1;
        for (int i = 0; i < most; ++i) {
          const std::string_view word = take_token(rest);
          if (i > 0 && !to_number(word)) break;
          words = rest;
        }
      }
    }
    if (words.empty()) return warn(map + " without a file, ignored");
    const std::string file =
        find_file(folder_, words, lines().place(), warnings()).value_or(folder_ / words).string();
    if (keyword == "norm") {
      material_.normal_map = {file, mapping};
      material_.normal_scale = normal_scale;
    } else if (keyword == "map_Ke") {
      if (!has_emission_) material_.emission = glm::vec3(1.0f);  // as map_Kd without Kd
      material_.emission_map = {file, mapping};
    } else if (keyword == "map_d") {
      material_.opacity_map = {file, mapping};
    } else if (keyword == "map_Kd") {
      // Without a Kd the texture is not tinted. (A later Kd still counts.)
      if (!has_diffuse_) material_.diffuse = glm::vec3(1.0f);
      has_diffuse_ = true;
      material_.diffuse_map = file;
      material_.diffuse_mapping = mapping;
    } else {
      if (!material_.metallic_roughness) material_.metallic_roughness.emplace();
      MetallicRoughness& shares = *material_.metallic_roughness;
      (keyword == "map_Pr" ? shares.map.file : shares.metallic_file) = file;
      shares.map.mapping = mapping;
    }
  }

  glm::vec2 take_texture_vector(const std::string& of_what, std::string_view& words) const {
    // There are one to three numbers; the third is for solid textures.
    std::array<double, 3> uvw{};
    uvw.fill(of_what.ends_with("-s") ? 1.0 : 0.0);
    for (std::size_t i = 0; i < 3; ++i) {
      std::string_view rest = words;
      const std::string_view word = take_token(rest);
      if (i > 0 && !to_number(word)) break;
      uvw[i] = lines().number(word, of_what);
      words = rest;
    }
    return {uvw[0], uvw[1]};
  }

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

}  // namespace

void MaterialLibrary::load_library(std::string_view names) {
  if (names.empty()) {
    warnings_.push_back(obj_.place() + "mtllib without a file");
    return;
  }
  std::vector<std::string_view> words;
  std::string_view rest = names;
  while (!rest.empty()) {
    const std::size_t end = rest.starts_with('"') ? rest.find('"', 1) : rest.npos;
    words.push_back(rest.substr(0, end == rest.npos ? rest.find_first_of(" \t") : end + 1));
    rest.remove_prefix(words.back().size());
    rest.remove_prefix(std::min(rest.find_first_not_of(" \t"), rest.size()));
  }
  // One name may have several words, also if its file has another spelling here.
  const bool are_several = std::ranges::all_of(
      words, [&](std::string_view name) { return find_exact_file(folder_, name).has_value(); });
  if (!are_several || find_exact_file(folder_, names)) {
    if (const auto file = find_file(folder_, names, obj_.place(), warnings_)) return load(*file);
  }
  for (const std::string_view name : words) {
    if (const auto file = find_file(folder_, name, obj_.place(), warnings_)) {
      load(*file);
    } else {
      std::error_code error;
      const bool is_known =
          std::filesystem::status(folder_ / name, error).type() != std::filesystem::file_type::none;
      warnings_.push_back(obj_.place() + "material file " + in_quotes(name) +
                          (is_known ? " is missing" : " cannot be read: " + error.message()) +
                          ", default materials instead");
    }
  }
}

void MaterialLibrary::load(const std::filesystem::path& file) {
  if (!loaded_.insert(file.lexically_normal()).second) return;
  std::vector<Material> read = MtlReader(file, warnings_).read();
  if (read.empty()) warnings_.push_back(file.string() + ": defines no material");
  for (Material& material : read) {
    index_of_name_.emplace(material.name, static_cast<std::uint32_t>(materials_.size()));
    materials_.push_back(std::move(material));
  }
}

std::optional<std::uint32_t> MaterialLibrary::find(const std::string& name) const {
  const auto found = index_of_name_.find(name);
  if (found == index_of_name_.end()) return std::nullopt;
  return found->second;
}

}  // namespace raygate
