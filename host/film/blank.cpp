#include "host/film/blank.h"

#include <algorithm>
#include <cmath>

namespace raygate {
namespace {

constexpr int kLeastPixels = 16 * 16;
constexpr float kVisible = 1e-3f, kBlack = 1e-4f;  // of a display's white

}  // namespace

std::string why_blank(const Film& film, const DisplayOptions& display) {
  const bool is_whole = film.window.width() == film.width && film.window.height() == film.height;
  if (!is_whole || film.color.size() < kLeastPixels) return "";
  const auto exposure = static_cast<float>(std::exp2(display.exposure));
  const auto shown = [&](const glm::vec4& pixel) {
    return glm::clamp(glm::vec3(pixel) * exposure, glm::vec3(0.0f), glm::vec3(1.0f));
  };
  const auto largest = [](const glm::vec3& v) { return std::max({v.r, v.g, v.b}); };
  const glm::vec3 first = shown(film.color.front());
  const bool is_uniform = std::ranges::all_of(film.color, [&](const glm::vec4& pixel) {
    return largest(glm::abs(shown(pixel) - first)) <= kVisible;
  });
  if (!is_uniform) return "";
  const bool any_hit = std::ranges::any_of(
      film.primitive, [](std::uint32_t primitive) { return primitive != kNoPrimitive; });
  if (!any_hit) return "the camera sees nothing of the scene; --view iso shows all of it";
  if (largest(first) <= kBlack) {
    return "the picture is black: no light comes from what the camera sees; --exposure 4 shows "
           "what is dark, --integrator primary what has no light";
  }
  return "the picture is all one colour; --exposure -2 shows what is too bright, --integrator "
         "primary what has no light";
}

}  // namespace raygate
