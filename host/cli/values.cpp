#include "host/cli/values.h"

#include <algorithm>
#include <cmath>

#include "host/base/input_error.h"

namespace raygate {
namespace {

/// A frame or crop that fits into memory.
void require_pixels(const std::string& option, const std::string& text, int width, int height) {
  if (std::int64_t{width} * height <= kMaxPixels) return;
  fail_value(
      option, text,
      "at most " + std::to_string(kMaxPixels) +
          " pixels in one run, for their memory (a larger frame can be rendered in parts with "
          "--crop)");
}

}  // namespace

Size parse_size(const std::string& text) {
  const std::size_t x = text.find('x');
  const auto width = parse_number<std::int64_t>(text.substr(0, x));
  const auto height = x == std::string::npos
                          ? std::nullopt
                          : parse_number<std::int64_t>(std::string_view(text).substr(x + 1));
  const auto possible = [](std::int64_t side) { return side >= 1 && side <= kMaxSide; };
  if (!width || !height || !possible(*width) || !possible(*height)) {
    fail_value("--size", text,
               "WIDTHxHEIGHT, each from 1 to " + std::to_string(kMaxSide) + " pixels (640x480)");
  }
  return {static_cast<int>(*width), static_cast<int>(*height)};
}

CameraSetting parse_camera(const std::string& text) {
  const auto numbers = parse_list<double>(text);
  if (!numbers || (numbers->size() != 6 && numbers->size() != 7)) {
    fail_value("--camera", text,
               "EX,EY,EZ,TX,TY,TZ or EX,EY,EZ,TX,TY,TZ,FOV (eye, target, degrees)");
  }
  const std::vector<double>& n = *numbers;
  for (const double number : n) {
    if (!std::isfinite(number)) fail_value("--camera", text, "finite numbers");
  }
  CameraSetting camera{{n[0], n[1], n[2]}, {n[3], n[4], n[5]}, std::nullopt, std::nullopt};
  if (camera.eye == camera.target) fail_value("--camera", text, "an eye and a target that differ");
  if (n.size() == 7) {
    if (n[6] <= 0.0 || n[6] >= 180.0) {
      fail_value("--camera", text, "a field of view above 0 and below 180 degrees");
    }
    camera.fov = n[6];
  }
  return camera;
}

std::pair<double, double> parse_view(const std::string& text) {
  constexpr double kIso = 35.264389682754654;  // all three axes look equally long
  constexpr std::pair<const char*, std::pair<double, double>> kNames[] = {
      {"front", {0, 0}}, {"back", {180, 0}},  {"left", {-90, 0}},  {"right", {90, 0}},
      {"top", {0, 90}},  {"iso", {45, kIso}}, {"bottom", {0, -90}}};
  for (const auto& [name, angles] : kNames) {
    if (text == name) return angles;
  }
  const auto angles = parse_list<double>(text);
  if (!angles || angles->size() != 2 || !(std::abs((*angles)[0]) <= 360.0) ||
      !(std::abs((*angles)[1]) <= 90.0)) {
    fail_value("--view", text,
               "front, back, left, right, top, bottom, iso, or AZIMUTH,ELEVATION in degrees (from "
               "-360 to 360, and from -90 to 90)");
  }
  return {(*angles)[0], (*angles)[1]};
}

glm::dvec3 parse_axis(const std::string& text) {
  return choose<glm::dvec3>("--up", text,
                            {{"x", {1, 0, 0}},
                             {"y", {0, 1, 0}},
                             {"z", {0, 0, 1}},
                             {"-x", {-1, 0, 0}},
                             {"-y", {0, -1, 0}},
                             {"-z", {0, 0, -1}}});
}

double parse_fov(const std::string& text) {
  const auto fov = parse_number<double>(text);
  if (!fov || !(*fov > 0.0 && *fov < 180.0)) {
    fail_value("--fov", text, "degrees above 0 and below 180");
  }
  return *fov;
}

double parse_smooth(const std::string& text) {
  const auto angle = parse_number<double>(text);
  if (!angle || !(*angle >= 0.0 && *angle <= 180.0)) {
    fail_value("--smooth", text, "degrees from 0 to 180");
  }
  return *angle;
}

PixelRect parse_crop(const std::string& text, Size size) {
  const std::string frame = std::to_string(size.width) + "x" + std::to_string(size.height);
  PixelRect window{0, 0, size.width, size.height};
  if (text.empty()) {
    require_pixels("--size", frame, size.width, size.height);
    return window;
  }
  const auto corners = parse_list<int>(text);
  if (corners && corners->size() == 4) {
    window = {(*corners)[0], (*corners)[1], (*corners)[2], (*corners)[3]};
  }
  if (!corners || corners->size() != 4 || window.x0 < 0 || window.x0 >= window.x1 ||
      window.x1 > size.width || window.y0 < 0 || window.y0 >= window.y1 ||
      window.y1 > size.height) {
    fail_value("--crop", text,
               "X0,Y0,X1,Y1 with X0 < X1 and Y0 < Y1 within the frame of " + frame +
                   " (0,0 is the top left corner, X1 and Y1 are not included)");
  }
  require_pixels("--crop", text, window.width(), window.height());
  return window;
}

std::uint64_t parse_seed(const std::string& text) {
  const auto seed = parse_number<std::uint64_t>(text);
  if (!seed) fail_value("--seed", text, "a whole number from 0 to 18446744073709551615");
  return *seed;
}

}  // namespace raygate
