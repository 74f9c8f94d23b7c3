#include "host/scene/io/mtl_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

#include "host/scene/io/words.h"
#include "host/scene/scene.h"

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

constexpr std::array<std::string_view, 5> kColours{"Kd", "Ks", "Ke", "Tf", "Ka"};

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

std::string shortest(const glm::vec3& colour) {
  return shortest(colour.r) + " " + shortest(colour.g) + " " + shortest(colour.b);
}

}  // namespace

void MtlText::clean(std::string_view statement, std::string& clean) {
  const std::string_view keyword = take_word(statement);
  if (keyword == "newmtl") return begin_material(statement, clean);

  const bool is_colour = std::find(kColours.begin(), kColours.end(), keyword) != kColours.end();
  const bool is_value = std::any_of(kValues.begin(), kValues.end(),
                                    [&](const Value& value) { return value.keyword == keyword; });
  if ((is_colour || is_value || keyword == "map_Kd") && !in_material_) {
    lines().fail(in_quotes(keyword) + " before the first newmtl");
  }
  if (is_colour) {
    check_colour(keyword, statement, clean);
  } else if (is_value) {
    check_value(keyword, statement, clean);
  } else if (keyword == "map_Kd") {
    check_diffuse_map(statement, clean);
  } else {
    warn_once(keyword, in_quotes(keyword) + " is not supported, ignored");
  }
  if (nameless_) clean.clear();
}

void MtlText::begin_material(std::string_view name, std::string& clean) {
  in_material_ = true;
  has_diffuse_ = false;
  nameless_ = name.empty();
  if (nameless_) return warn("newmtl without a name: nothing can use this material, ignored");
  if (!names_.emplace(name).second) {
    warn("material " + in_quotes(name) + " was defined before, which stands");
  }
  const Material defaults;
  clean.append("newmtl ").append(name);
  clean.append("\nKd ").append(shortest(defaults.diffuse));
  clean.append("\nTf ").append(shortest(defaults.transmittance));
  clean.append("\nNs ").append(shortest(defaults.shininess));
  clean.append("\nillum ").append(std::to_string(defaults.illumination_model)).append("\n");
}

void MtlText::check_colour(std::string_view keyword, std::string_view words, std::string& clean) {
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
  clean.append(keyword);
  for (const double component : rgb) clean.append(" ").append(shortest(component));
  clean += '\n';
}

void MtlText::check_value(std::string_view keyword, std::string_view words, std::string& clean) {
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
  if (keyword == "illum" && number != std::floor(number)) {
    lines().fail("illum: " + in_quotes(word) + ", expected a whole number from 0 to 10");
  }
  clean.append(keyword).append(" ").append(shortest(number)).append("\n");
}

void MtlText::check_diffuse_map(std::string_view words, std::string& clean) {
  std::string kept;
  while (words.starts_with('-')) {
    std::string_view rest = words;
    const std::string_view name = take_word(rest);
    const auto* const option =
        std::find_if(kTextureOptions.begin(), kTextureOptions.end(),
                     [&](const TextureOption& known) { return known.name == name; });
    if (option == kTextureOptions.end()) break;  // a file whose name begins with '-'
    words = rest;
    if (name == "-clamp") {
      kept += take_word(rest) == "on" ? "-clamp on " : "";
      words = rest;
    } else if (name == "-s" || name == "-o") {
      kept += std::string(name) + " " + take_texture_vector(name, words) + " ";
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
  if (!has_diffuse_) clean.append("Kd 1 1 1\n");
  clean.append("map_Kd ").append(kept).append(words).append("\n");
}

std::string MtlText::take_texture_vector(std::string_view option, std::string_view& words) const {
  // One to three numbers; the third is for solid textures. The library wants all three.
  const bool is_scale = option == "-s";
  std::array<double, 3> uvw{};
  uvw.fill(is_scale ? 1.0 : 0.0);
  for (std::size_t i = 0; i < 3; ++i) {
    std::string_view rest = words;
    const std::string_view word = take_word(rest);
    if (i > 0 && !to_number(word)) break;
    uvw[i] = expect_number(lines(), word, "map_Kd " + std::string(option));
    words = rest;
  }
  return shortest(uvw[0]) + " " + shortest(uvw[1]) + " " + shortest(uvw[2]);
}

}  // namespace raygate
