#include "host/scene/io/mtl_reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "host/scene/io/words.h"

namespace raygate {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Statements of one number and the range it is clamped to.
struct Value {
  std::string_view keyword;
  double low, high, instead;  // what stands in for a number below `low`
};
constexpr std::array<Value, 5> kValues{{
    {"Ns", 0.0, kInfinity, 0.0},
    {"Ni", 0.001, kInfinity, 1.0},  // an index of 0 is what some exporters write for "none"
    {"d", 0.0, 1.0, 0.0},
    {"Tr", 0.0, 1.0, 0.0},
    {"illum", 0.0, 10.0, 2.0},
}};

/// map_Kd options and how many words may follow each; all but the first must be numbers.
struct TextureOption {
  std::string_view name;
  int words;
};
constexpr std::array<TextureOption, 14> kTextureOptions{{{"-blendu", 1},
                                                         {"-blendv", 1},
                                                         {"-boost", 1},
                                                         {"-mm", 2},
                                                         {"-o", 3},
                                                         {"-s", 3},
                                                         {"-t", 3},
                                                         {"-texres", 1},
                                                         {"-clamp", 1},
                                                         {"-bm", 1},
                                                         {"-imfchan", 1},
                                                         {"-type", 1},
                                                         {"-cc", 1},
                                                         {"-colorspace", 1}}};

std::string shortest(double number) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", number);
  return text;
}

/// The material's member of a colour statement; Ka is read and not used.
glm::vec3* colour_of(Material& material, glm::vec3& unused, std::string_view keyword) {
  if (keyword == "Kd") return &material.diffuse;
  if (keyword == "Ks") return &material.specular;
  if (keyword == "Ke") return &material.emission;
  if (keyword == "Tf") return &material.transmittance;
  return keyword == "Ka" ? &unused : nullptr;
}

}  // namespace

std::optional<std::filesystem::path> find_file(const std::filesystem::path& folder,
                                               std::string_view name) {
  std::string slashed(name);
  std::replace(slashed.begin(), slashed.end(), '\\', '/');
  for (const std::string& spelling : {std::string(name), slashed}) {
    std::error_code ignored;
    std::filesystem::path file = folder / spelling;
    if (std::filesystem::is_regular_file(file, ignored)) return file;
  }
  return std::nullopt;
}

std::vector<Material> MtlReader::read() {
  while (const auto statement = lines().next()) read_statement(*statement);
  if (is_kept_) materials_.push_back(std::move(material_));
  return std::move(materials_);
}

void MtlReader::read_statement(std::string_view statement) {
  const std::string_view keyword = take_word(statement);
  if (keyword == "newmtl") return begin_material(statement);
  glm::vec3 unused;
  glm::vec3* const colour = colour_of(material_, unused, keyword);
  const bool is_value = std::any_of(kValues.begin(), kValues.end(),
                                    [&](const Value& value) { return value.keyword == keyword; });
  if ((colour != nullptr || is_value || keyword == "map_Kd") && !in_material_) {
    lines().fail(in_quotes(keyword) + " before the first newmtl");
  }
  if (colour != nullptr) {
    read_colour(keyword, statement, *colour);
  } else if (is_value) {
    read_value(keyword, statement);
  } else if (keyword == "map_Kd") {
    read_diffuse_map(statement);
  } else {
    warn_once(keyword, in_quotes(keyword) + " is not supported, ignored");
  }
}

void MtlReader::begin_material(std::string_view name) {
  if (is_kept_) materials_.push_back(std::move(material_));
  material_ = {};
  material_.name = name;
  in_material_ = true;
  has_diffuse_ = has_opacity_ = false;
  is_kept_ = !name.empty() && names_.emplace(name).second;
  if (name.empty()) {
    warn("newmtl without a name: nothing can use this material, ignored");
  } else if (!is_kept_) {
    warn("material " + in_quotes(name) + " was defined before, which stands");
  }
}

void MtlReader::read_colour(std::string_view keyword, std::string_view words, glm::vec3& colour) {
  std::string_view peeked = words;
  const std::string_view first = take_word_before_comment(peeked);
  if (first == "spectral" || first == "xyz") {
    return warn(std::string(keyword) + " " + std::string(first) + " is not supported, ignored");
  }
  std::array<double, 3> rgb{};
  std::size_t count = 0;
  for (std::string_view word = take_word_before_comment(words); !word.empty();
       word = take_word_before_comment(words)) {
    if (count == 3) lines().fail(std::string(keyword) + " with more than 3 numbers");
    rgb[count] = expect_number(lines(), word, keyword);
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
  colour = {rgb[0], rgb[1], rgb[2]};
}

void MtlReader::read_value(std::string_view keyword, std::string_view words) {
  std::string_view word = take_word_before_comment(words);
  if (keyword == "d" && word == "-halo") {
    warn("d -halo is not supported, taken as d");
    word = take_word_before_comment(words);
  }
  const std::string_view more = take_word_before_comment(words);
  if (word.empty() || !more.empty()) {
    // Tr of three numbers is what old exporters write for Tf; its meaning is anyone's guess.
    lines().fail(std::string(keyword) + ": expected one number");
  }
  double number = expect_number(lines(), word, keyword);
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
  } else if (keyword == "Ni") {
    material_.refraction_index = static_cast<float>(number);
  } else if (keyword == "d") {
    material_.opacity = static_cast<float>(number);
    has_opacity_ = true;
  } else if (!has_opacity_) {  // Tr
    material_.opacity = static_cast<float>(1.0 - number);
  }
}

void MtlReader::read_diffuse_map(std::string_view words) {
  TextureMapping mapping;
  while (words.starts_with('-')) {
    std::string_view rest = words;
    const std::string_view name = take_word(rest);
    const auto* const option =
        std::find_if(kTextureOptions.begin(), kTextureOptions.end(),
                     [&](const TextureOption& known) { return known.name == name; });
    if (option == kTextureOptions.end()) break;  // a file whose name begins with '-'
    words = rest;
    if (name == "-clamp") {
      mapping.clamp = take_word(rest) == "on" || mapping.clamp;
      words = rest;
    } else if (name == "-s") {
      mapping.scale = take_texture_vector(name, words);
    } else if (name == "-o") {
      mapping.offset = take_texture_vector(name, words);
    } else {
      warn_once("map_Kd option", "map_Kd " + std::string(name) + " is not supported, ignored");
      for (int i = 0; i < option->words; ++i) {
        const std::string_view word = take_word(rest);
        if (i > 0 && !to_number(word)) break;
        words = rest;
      }
    }
  }
  if (words.empty()) return warn("map_Kd without a file, ignored");
  // Without a Kd of its own the texture's colours stand as they are. (A later Kd still counts.)
  if (!has_diffuse_) material_.diffuse = glm::vec3(1.0f);
  has_diffuse_ = true;
  material_.diffuse_map = find_file(folder_, words).value_or(folder_ / words).string();
  material_.diffuse_mapping = mapping;
}

glm::vec2 MtlReader::take_texture_vector(std::string_view option, std::string_view& words) const {
  // One to three numbers; the third is for solid textures.
  std::array<double, 3> uvw{};
  uvw.fill(option == "-s" ? 1.0 : 0.0);
  for (std::size_t i = 0; i < 3; ++i) {
    std::string_view rest = words;
    const std::string_view word = take_word(rest);
    if (i > 0 && !to_number(word)) break;
    uvw[i] = expect_number(lines(), word, "map_Kd " + std::string(option));
    words = rest;
  }
  return {uvw[0], uvw[1]};
}

}  // namespace raygate
