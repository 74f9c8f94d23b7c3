#include "host/lab/stress/shot.h"

#include <bit>
#include <cstdint>
#include <cstdio>
#include <sstream>
#include <stdexcept>

namespace raygate::lab {

std::string to_text(const Case& failure) {
  std::string text;
  const auto add = [&](const glm::vec3& v, const char* before) {
    text += before;
    for (int k = 0; k < 3; ++k) {
      char word[16];
      std::snprintf(word, sizeof word, k == 0 ? "%08X" : " %08X",
                    std::bit_cast<std::uint32_t>(v[k]));
      text += word;
    }
  };
  add(failure.origin, "");
  add(failure.direction, "  ");
  for (const Corners& triangle : failure.triangles) {
    for (const glm::vec3& vertex : triangle) add(vertex, "  ");
  }
  return text;
}

Case case_from(const std::string& line) {
  std::istringstream text(line);
  std::vector<float> words;
  for (std::string word; text >> word;) {
    std::size_t read = 0;
    const unsigned long value = word.size() == 8 ? std::stoul(word, &read, 16) : 0;
    if (read != 8) throw std::invalid_argument(word + ": expected a word of 8 hexadecimal digits");
    words.push_back(std::bit_cast<float>(static_cast<std::uint32_t>(value)));
  }
  if (words.size() < 15 || words.size() % 9 != 6) {
    throw std::invalid_argument(std::to_string(words.size()) +
                                " words, expected 6 and 9 for each triangle");
  }
  const auto vector = [&](std::size_t i) {
    return glm::vec3(words[i], words[i + 1], words[i + 2]);
  };
  Case result{vector(0), vector(3), {}};
  for (std::size_t i = 6; i < words.size(); i += 9) {
    result.triangles.push_back({vector(i), vector(i + 3), vector(i + 6)});
  }
  return result;
}

Shot shot_of(const Case& failure) {
  auto mesh = std::make_shared<Mesh>();
  mesh->triangles = failure.triangles;
  Shot shot;
  shot.mesh = std::move(mesh);
  shot.origin = failure.origin;
  shot.directions = {failure.direction};
  return shot;
}

}  // namespace raygate::lab
