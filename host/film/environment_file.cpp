#include "host/film/environment_file.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>

#include "host/base/elementary.h"
#include "host/film/exr_reader.h"
#include "host/film/hdr_reader.h"

namespace raygate {
namespace {

float usable(double x) { return x > 0.0 ? static_cast<float>(std::min(x, 1e30)) : 0.0f; }

bool is_radiance(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  char first[2] = {};
  stream.read(first, 2);
  return first[0] == '#' && first[1] == '?';
}

/// What is ahead where `up` is upwards: across it, and nearly -z or +y.
glm::dvec3 ahead_of(const glm::dvec3& up) {
  const glm::dvec3 across = glm::cross(up, glm::dvec3(1.0, 0.0, 0.0));
  return glm::length(across) > 1e-6 ? glm::normalize(across) : glm::dvec3(0.0, 0.0, -1.0);
}

}  // namespace

void load_environment(const EnvironmentSetting& setting, const glm::dvec3& up, Scene& scene) {
  EnvironmentMap map;
  if (is_radiance(setting.file)) {
    HdrImage picture = read_hdr(setting.file);
    map.width = picture.width;
    map.height = picture.height;
    map.texels = std::move(picture.pixels);
  } else {
    const std::string names[] = {"R", "G", "B"};
    const ChannelPicture picture = read_exr(setting.file, names);
    map.width = picture.window.width();
    map.height = picture.window.height();
    const auto& channels = picture.channels;
    for (std::size_t i = 0; i < channels[0].size(); ++i) {
      map.texels.emplace_back(usable(channels[0][i]), usable(channels[1][i]),
                              usable(channels[2][i]));
    }
  }
  map.strength = static_cast<float>(setting.strength);
  map.up = glm::normalize(up);
  const glm::dvec3 ahead = ahead_of(map.up);
  const auto turn = sine_cosine(setting.rotation / 360.0);
  map.ahead = turn.cosine * ahead + turn.sine * glm::cross(map.up, ahead);
  scene.files.push_back(setting.file);
  scene.environment = std::move(map);
}

}  // namespace raygate
