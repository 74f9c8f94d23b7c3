#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "host/base/input_error.h"
#include "host/scene/io/scene_loader.h"
#include "host/scene/io/text.h"

namespace raygate {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Statements with one number. kValues has the range to which each number is clamped.
enum Value : std::size_t { kNs, kNi, kD, kTr, kIllum, kPr, kPm, kValueCount };
struct ValueRange {
  std::string_view keyword;
  double low, high, instead;  // `instead` replaces a number below `low`
};
// Some exporters write Ni 0 for "none".
constexpr ValueRange kValues[kValueCount] = {
    {"Ns", 0.0, kInfinity, 0.0}, {"Ni", 0.001, kInfinity, 1.0}, {"d", 0.0, 1.0, 0.0},
    {"Tr", 0.0, 1.0, 0.0},       {"illum", 0.0, 10.0, 2.0},     {"Pr", 0.0, 1.0, 0.0},
    {"Pm", 0.0, 1.0, 0.0}};

/// Unsupported options of maps. Each is followed by numbers or one word.
constexpr std::string_view kOtherOptions[] = {"-blendu", "-blendv", "-boost",     "-texres",
                                              "-bm",     "-cc",     "-type",      "-imfchan",
                                              "-mm",     "-t",      "-colorspace"};

/// A material that is being read, with values of statements that finish_material() combines.
struct Draft {
  Material material;
  bool has_diffuse = false, has_emission = false;
  std::array<std::optional<double>, kValueCount> values;
  MaterialMap roughness_map, metallic_map;
  std::string transparency_place;  // "file:line: " of the last Tr
  glm::vec3 ambient{};             // Ka, which has no use

  /// Returns the member that a colour statement sets, or nullptr for other keywords.
  glm::vec3* colour(std::string_view keyword) {
    return keyword == "Kd"   ? &material.diffuse
           : keyword == "Ks" ? &material.specular
           : keyword == "Ke" ? &material.emission
           : keyword == "Tf" ? &material.transmittance
           : keyword == "Ka" ? &ambient
                             : nullptr;
  }

  /// Returns the member that a map statement sets, or nullptr for other keywords.
  MaterialMap* map(std::string_view keyword) {
    return keyword == "map_Kd"   ? &material.diffuse_map
           : keyword == "map_Ke" ? &material.emission_map
           : keyword == "map_Pr" ? &roughness_map
           : keyword == "map_Pm" ? &metallic_map
           : keyword == "map_d"  ? &material.opacity_map
           : keyword == "norm"   ? &material.normal_map
                                 : nullptr;
  }
};

/// Reads the statements that Material has members for. Clamps values out of range and ignores other
/// statements, with a warning. Throws InputError for other errors.
class MtlReader {
 public:
  /// Searches for textures in the file's folder, by find_file. `warnings` must outlive this object.
  MtlReader(const std::filesystem::path& file, std::vector<std::string>& warnings)
      : lines_(file), folder_(file.parent_path()), warnings_(warnings) {}

  /// Returns the materials in the file's order. Of several with one name, keeps only the first.
  std::vector<Material> read() {
    while (auto statement = lines_.next()) read_statement(*statement);
    finish_material();
    return std::move(materials_);
  }

 private:
  void warn(const Words& words, const std::string& what) {
    warnings_.push_back(words.place() + what);
  }
  /// Warns at the first call for this key.
  void warn_once(const std::string& key, const Words& words, const std::string& what) {
    if (warned_of_.insert(key).second) warn(words, what);
  }

  void read_statement(Words& words) {
    const std::string keyword(words.take());
    if (keyword == "newmtl") return begin_material(words);
    glm::vec3* const colour = draft_.colour(keyword);
    MaterialMap* const map = draft_.map(keyword);
    const auto* const value = std::ranges::find(kValues, keyword, &ValueRange::keyword);
    const bool is_value = value != std::end(kValues);
    if ((colour || map || is_value) && !in_material_) {
      words.fail(in_quotes(keyword) + " before the first newmtl");
    }
    if (map) return read_map(keyword, words, *map);
    if (!colour && !is_value) {
      return warn_once(keyword, words, in_quotes(keyword) + " is not supported, ignored");
    }
    words.drop_comment();
    if (colour) return read_colour(keyword, words, *colour);
    read_value(static_cast<Value>(value - std::begin(kValues)), words);
  }

  /// Completes a material. Any PBR statement selects the metallic-roughness model. Defaults are
  /// those of the exporters that write such statements: no metal, and Ns = 1000 (1 - roughness)^2.
  void finish_material() {
    if (!is_kept_) return;
    Material& material = draft_.material;
    const auto value = [&](Value key, double missing) {
      return static_cast<float>(draft_.values[key].value_or(missing));
    };
    const int model = static_cast<int>(value(kIllum, material.illumination_model));
    material.illumination_model = model;
    material.shininess = value(kNs, material.shininess);
    material.refraction_index = value(kNi, material.refraction_index);
    material.opacity = value(kD, 1.0 - draft_.values[kTr].value_or(0.0));
    const bool is_glass = model == 4 || model == 6 || model == 7 || model == 9;
    if (draft_.values[kTr] == 1.0 && !draft_.values[kD] && !is_glass) {
      material.opacity = 1.0f;
      warnings_.push_back(draft_.transparency_place +
                          "found Tr 1, which hides the material, expected less; taken as 0");
    }
    // Exporters write Ns 0 for "no highlight".
    if (model == 2 && draft_.values[kNs] == 0.0) material.specular = glm::vec3(0.0f);
    const bool has_rough_map = !draft_.roughness_map.file.empty(),
               has_metal_map = !draft_.metallic_map.file.empty();
    if (draft_.values[kPr] || draft_.values[kPm] || has_rough_map || has_metal_map) {
      MetallicRoughness& pbr = material.metallic_roughness.emplace();
      const float root = std::sqrt(std::min(material.shininess / 1000.0f, 1.0f));
      pbr.roughness = value(kPr, has_rough_map ? 1.0f : 1.0f - root);
      pbr.metallic = value(kPm, has_metal_map ? 1.0f : 0.0f);
      pbr.roughness_map = draft_.roughness_map;
      pbr.metallic_map = draft_.metallic_map;
      if (model == 6 || model == 7) {
        pbr.transmission = 1.0f;
        material.opacity = 1.0f;
      }
    }
    materials_.push_back(std::move(material));
  }

  void begin_material(const Words& words) {
    finish_material();
    draft_ = {};
    const std::string name(words.rest());
    draft_.material.name = name;
    in_material_ = true;
    is_kept_ = !name.empty() && names_.insert(name).second;
    if (name.empty()) {
      warn(words, "newmtl without a name: nothing can use this material, ignored");
    } else if (!is_kept_) {
      warn(words, "material " + in_quotes(name) + " was defined before, which stands");
    }
  }

  void read_colour(const std::string& keyword, Words& words, glm::vec3& colour) {
    if (words.peek() == "spectral" || words.peek() == "xyz") {
      return warn(words, keyword + " " + std::string(words.peek()) + " is not supported, ignored");
    }
    int count = 0;
    glm::vec3 rgb;
    for (; !words.at_end(); ++count) {
      if (count == 3) words.fail(keyword + " with more than 3 numbers");
      const std::string_view word = words.peek();
      const double number = words.number(keyword);
      if (number < 0.0) warn(words, keyword + " " + in_quotes(word) + " is negative, taken as 0");
      rgb[count] = static_cast<float>(std::max(number, 0.0));
    }
    if (count != 1 && count != 3) {
      words.fail(keyword + " with " + std::to_string(count) +
                 " numbers, expected red, green and blue, or one for all three");
    }
    draft_.has_diffuse = draft_.has_diffuse || keyword == "Kd";
    draft_.has_emission = draft_.has_emission || keyword == "Ke";
    colour = count == 1 ? glm::vec3(rgb.r) : rgb;
  }

  void read_value(Value key, Words& words) {
    const auto& [name, low, high, instead] = kValues[key];
    const std::string keyword(name);
    if (key == kD && words.take_if("-halo")) warn(words, "d -halo is not supported, taken as d");
    const std::string word(words.peek());
    double number = words.number(keyword);
    if (!words.at_end()) words.fail(keyword + ": found several numbers, expected one");
    if (number < low || number > high) {
      number = number < low ? instead : high;
      std::ostringstream text;
      text << keyword << " " << in_quotes(word) << " is out of range, taken as " << number;
      warn(words, text.str());
    }
    if (key == kIllum && number != std::floor(number)) {
      words.fail("illum: found " + in_quotes(word) + ", expected a whole number from 0 to 10");
    }
    if (key == kTr) draft_.transparency_place = words.place();
    draft_.values[key] = number;
  }

  void read_map(const std::string& keyword, Words& words, MaterialMap& map) {
    MaterialMap read;
    float normal_scale = 1.0f;
    while (words.peek().starts_with('-')) {
      const std::string name(words.peek());
      const bool is_known = name == "-s" || name == "-o" || name == "-clamp" ||
                            std::ranges::find(kOtherOptions, name) != std::end(kOtherOptions);
      if (!is_known) break;  // a file whose name begins with '-'
      (void)words.take();
      if (name == "-clamp") {
        if (words.take() == "on") read.mapping.sampling = Wrap::kClamp;
      } else if (name == "-s") {
        read.mapping.scale = take_vector(keyword + " -s", words, 1.0f);
      } else if (name == "-o") {
        read.mapping.offset = take_vector(keyword + " -o", words, 0.0f);
      } else if (name == "-bm" && keyword == "norm") {
        normal_scale = static_cast<float>(words.number("norm -bm"));
      } else {
        std::string option = keyword;
        option.append(" ").append(name).append(" is not supported, ignored");
        warn_once(keyword + " option", words, option);
        (void)words.take();
        while (to_number(words.peek())) (void)words.take();
      }
    }
    if (words.at_end()) return warn(words, keyword + " without a file, ignored");
    read.file = find_file(folder_, words.rest(), words.place(), warnings_)
                    .value_or(folder_ / words.rest())
                    .string();
    map = std::move(read);
    if (keyword == "norm") draft_.material.normal_scale = normal_scale;
    // A map without a Kd or Ke before it is not tinted. A later Kd or Ke still tints it.
    if (keyword == "map_Ke" && !draft_.has_emission) draft_.material.emission = glm::vec3(1.0f);
    if (keyword == "map_Kd" && !draft_.has_diffuse) draft_.material.diffuse = glm::vec3(1.0f);
  }

  /// Takes one to three numbers and returns the first two; the third is for solid textures.
  static glm::vec2 take_vector(const std::string& what, Words& words, float missing) {
    glm::vec3 uvw(missing);
    for (int i = 0; i == 0 || (i < 3 && to_number(words.peek())); ++i) {
      uvw[i] = static_cast<float>(words.number(what));
    }
    return {uvw.x, uvw.y};
  }

  TextLines lines_;
  std::filesystem::path folder_;
  std::vector<std::string>& warnings_;
  std::set<std::string> warned_of_;
  std::vector<Material> materials_;
  std::set<std::string> names_;
  Draft draft_;               // the material that is being read
  bool in_material_ = false;  // whether there was a newmtl
  bool is_kept_ = false;      // whether the draft's name is new
};

}  // namespace

std::vector<Material> read_mtl(const std::filesystem::path& file,
                               std::vector<std::string>& warnings) {
  return MtlReader(file, warnings).read();
}

}  // namespace raygate
