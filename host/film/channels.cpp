#include "host/film/channels.h"

#include <array>
#include <cstring>

namespace raygate {
namespace {

void add_vector(std::vector<Channel>& channels, const std::string& layer, const char* parts,
                const std::vector<glm::vec3>& values) {
  if (values.empty()) return;
  for (int k = 0; k < 3; ++k) {
    channels.push_back(
        {layer + "." + parts[k], Channel::Type::kFloat, &values.front()[k], sizeof(glm::vec3)});
  }
}

void add_numbers(std::vector<Channel>& channels, const char* name,
                 const std::vector<std::uint32_t>& values) {
  if (values.empty()) return;
  channels.push_back({name, Channel::Type::kUint, values.data(), sizeof(std::uint32_t)});
}

void add_numbers(std::vector<Channel>& channels, const char* name,
                 const std::vector<float>& values) {
  if (values.empty()) return;
  channels.push_back({name, Channel::Type::kFloat, values.data(), sizeof(float)});
}

/// "sums.R.0" to "sums.R.5" and so on.
template <std::size_t N>
void add_sums(std::vector<Channel>& channels, const std::string& layer, const char* parts,
              const std::vector<std::array<ExactAccumulator, N>>& sums) {
  if (sums.empty()) return;
  for (std::size_t k = 0; k < N; ++k) {
    for (int word = 0; word < ExactAccumulator::kWords; ++word) {
      channels.push_back({layer + "." + parts[k] + "." + std::to_string(word), Channel::Type::kUint,
                          static_cast<const std::uint32_t*>(sums.front()[k].words()) + word,
                          sizeof(std::array<ExactAccumulator, N>)});
    }
  }
}

}  // namespace

std::vector<Channel> channels_of(const Film& film) {
  std::vector<Channel> channels;
  channels.reserve(18);
  for (int k = 0; k < 4; ++k) {
    channels.push_back({std::string(1, "RGBA"[k]), Channel::Type::kFloat, &film.color.front()[k],
                        sizeof(glm::vec4)});
  }
  add_numbers(channels, "Z", film.depth);
  add_vector(channels, "N", "XYZ", film.normal);
  add_numbers(channels, "id", film.primitive);
  add_vector(channels, "P", "XYZ", film.position);
  add_vector(channels, "Albedo", "RGB", film.albedo);
  add_numbers(channels, "objectId", film.object);
  add_numbers(channels, "tests", film.tests);
  add_numbers(channels, "doubts", film.doubts);
  if (film.keeps_sums || !film.sums.error.empty()) {
    add_numbers(channels, "samples", film.sums.samples);
  }
  add_numbers(channels, "error", film.sums.error);
  if (film.keeps_sums) {
    add_numbers(channels, "sums.shown", film.sums.shown);
    add_sums(channels, "sums", "RGBA", film.sums.color);
    add_sums(channels, "sums.Albedo", "RGB", film.sums.albedo);
  }
  return channels;
}

double value_at(const Channel& channel, std::size_t index) {
  const char* const at = static_cast<const char*>(channel.first) + index * channel.stride;
  if (channel.type == Channel::Type::kUint) {
    std::uint32_t number = 0;
    std::memcpy(&number, at, sizeof number);
    return number;
  }
  float number = 0.0f;
  std::memcpy(&number, at, sizeof number);
  return number;
}

}  // namespace raygate
