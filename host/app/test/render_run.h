// Shared by the tests of whole runs.
#pragma once

#include <gtest/gtest.h>
#include <png.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "host/app/test/program.h"

namespace raygate {

namespace fs = std::filesystem;
using nlohmann::json;
using namespace std::string_literals;

inline const std::string kCornell = RAYGATE_SCENES "/cornell.obj";
inline const std::string kPaper = RAYGATE_SCENES "/paper_room.json";

/// Runs ./render; each test has its own folder.
class Render : public testing::Test {
 protected:
  [[nodiscard]] Outcome run(const std::vector<std::string>& arguments) const {
    return run_program({.arguments = arguments, .folder = folder_.path()});
  }
  /// Runs ./render, expects success, and stores the statistics in `stats_`.
  Outcome render(const std::vector<std::string>& arguments) {
    const Outcome outcome = run(joined(arguments, {"--stats", "stats.json"}));
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    stats_ = json::parse(folder_.read("stats.json"), nullptr, false);
    EXPECT_FALSE(stats_.is_discarded());
    return outcome;
  }

  /// Expects that both pictures of two runs have the same bytes.
  void expect_same_pictures(const std::string& a, const std::string& b) const {
    EXPECT_NE(folder_.read(a + ".exr"), "");
    EXPECT_NE(folder_.read(a + ".png"), "");
    EXPECT_TRUE(folder_.read(a + ".exr") == folder_.read(b + ".exr")) << a << " " << b;
    EXPECT_TRUE(folder_.read(a + ".png") == folder_.read(b + ".png")) << a << " " << b;
  }

  const TempFolder folder_{TempFolder::on_disk()};
  json stats_;
};

/// Returns a PNG file's pixels as 24-bit RGB. The bytes of the file depend on zlib's version.
inline std::vector<std::uint8_t> decode_png(const std::string& bytes, png_image* size = nullptr) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  EXPECT_NE(png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()), 0);
  image.format = PNG_FORMAT_RGB;
  std::vector<std::uint8_t> pixels(PNG_IMAGE_SIZE(image));
  EXPECT_NE(png_image_finish_read(&image, nullptr, pixels.data(), 0, nullptr), 0);
  if (size != nullptr) *size = image;
  return pixels;
}

}  // namespace raygate
