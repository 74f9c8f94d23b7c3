// The film: the arrays of a rendered image, their exact sums, and reconstruction filters.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace raygate {

/// A 192-bit fixed-point sum in two's complement with a unit of 2^-96. Added numbers are truncated
/// to the unit and limited to a magnitude of 2^63, so that 2^31 of them do not overflow. NaN counts
/// as 0. The sum does not depend on the order of additions.
class ExactAccumulator {
 public:
  static_assert(std::endian::native == std::endian::little, "files have its words");

  void add(double number) {
    const double size = std::min(std::abs(number), kMost);
    if (!(size >= kLeast)) return;
    const auto bits = std::bit_cast<std::uint64_t>(size);
    std::uint64_t significand = (bits & (kHidden - 1)) | kHidden;
    int shift = static_cast<int>(bits >> 52) - 1075 + kFraction;
    if (shift < 0) {
      significand >>= -shift;
      shift = 0;
    }
    // The shift is at most 107 (for kMost), so all bits above the lowest 128 fit the last word.
    const Wide low = Wide{significand} << shift;
    const std::uint64_t high = shift > 64 ? significand >> (128 - shift) : 0;
    if (number < 0.0) {
      subtract(low, high);
    } else {
      add(low, high);
    }
  }

  ExactAccumulator& operator+=(const ExactAccumulator& other) {
    add(other.low(), other.words_[2]);
    return *this;
  }

  [[nodiscard]] ExactAccumulator operator-() const {
    ExactAccumulator result;
    result.subtract(low(), words_[2]);
    return result;
  }

  /// Returns the sum as a double, with a relative error below 2^-51.
  [[nodiscard]] double value() const {
    if (words_[2] >> 63 != 0) return -(-*this).value();
    return static_cast<double>(words_[2]) * 0x1p32 +
           (static_cast<double>(words_[1]) * 0x1p-32 + static_cast<double>(words_[0]) * 0x1p-96);
  }

  friend bool operator==(const ExactAccumulator&, const ExactAccumulator&) = default;

 private:
  __extension__ using Wide = unsigned __int128;

  [[nodiscard]] Wide low() const { return Wide{words_[1]} << 64 | words_[0]; }
  void set(Wide low, std::uint64_t high) {
    words_[0] = static_cast<std::uint64_t>(low);
    words_[1] = static_cast<std::uint64_t>(low >> 64);
    words_[2] = high;
  }
  void add(Wide low, std::uint64_t high) {
    const Wide sum = this->low() + low;
    set(sum, words_[2] + high + (sum < low ? 1 : 0));
  }
  void subtract(Wide low, std::uint64_t high) {
    const Wide from = this->low();
    set(from - low, words_[2] - high - (from < low ? 1 : 0));
  }

  static constexpr int kFraction = 96;
  static constexpr double kMost = 0x1p63, kLeast = 0x1p-96;
  static constexpr std::uint64_t kHidden = std::uint64_t{1} << 52;

  std::uint64_t words_[3] = {};  // least significant word first
};

/// Primitive or object index of a pixel without a hit.
inline constexpr std::uint32_t kNoPrimitive = std::numeric_limits<std::uint32_t>::max();

/// Maximum number of pixels of a picture, read or rendered: its film and encodings take up to 5 GB.
inline constexpr std::int64_t kMaxPixels = std::int64_t{1} << 26;

/// Pixels [x0, x1) x [y0, y1) of a larger picture, row 0 at the top.
struct PixelRect {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  [[nodiscard]] int width() const { return x1 - x0; }
  [[nodiscard]] int height() const { return y1 - y0; }
  [[nodiscard]] std::size_t pixels() const { return std::size_t(width()) * std::size_t(height()); }
  /// Returns the index of a pixel in an array of all pixels, row by row from the top.
  [[nodiscard]] std::size_t index_of(int x, int y) const {
    return std::size_t(y - y0) * std::size_t(width()) + std::size_t(x - x0);
  }
  friend bool operator==(const PixelRect&, const PixelRect&) = default;
};

/// Sums and sample counts of a film, by pixel.
struct FilmSums {
  std::vector<std::uint32_t> samples;  ///< number of samples
  std::vector<std::array<ExactAccumulator, 4>> color;
  std::vector<std::array<ExactAccumulator, 3>> albedo;  ///< if the film has albedo
  // Adaptive sampling only, in steps of an 8-bit display (see render/adaptive_sampling.h):
  std::vector<float> error;  ///< estimated standard error; infinite until there is an estimate
  std::vector<float> shown;  ///< display steps at the last check
};

/// Returns the mean of `samples` samples, clamped to 0 if rounding makes it negative.
template <std::size_t N>
[[nodiscard]] glm::vec<N, float> mean_of(const std::array<ExactAccumulator, N>& sums,
                                         double samples) {
  glm::vec<N, float> mean;
  for (std::size_t k = 0; k < N; ++k) {
    mean[static_cast<int>(k)] = static_cast<float>(std::max(sums[k].value(), 0.0) / samples);
  }
  return mean;
}

/// Optional channels of a film.
struct ExtraChannels {
  bool position = false, albedo = false, object = false, tests = false, doubts = false;
  bool sums = false;  ///< exact sums, to resume and merge
};

/// A scene-linear picture of `window` (the crop) within a `width` x `height` frame.
///
/// Arrays have window.width() * window.height() elements, row-major from the top; optional ones may
/// be empty. With several samples per pixel, `color` and `albedo` are the filtered mean, `tests`
/// and `doubts` the sum, and the others are values of the first sample.
struct Film {
  int width = 0, height = 0;
  PixelRect window;
  std::vector<glm::vec4> color;   ///< R G B A, scene-linear, premultiplied; A = 0 for a miss
  std::vector<float> depth;       ///< Z: distance along the camera's axis; +infinity for a miss
  std::vector<glm::vec3> normal;  ///< unit shading normal towards the viewer; 0 for a miss
  std::vector<std::uint32_t> primitive;  ///< triangle index of the scene; kNoPrimitive for a miss

  // Optional:
  std::vector<glm::vec3> position;    ///< point of the first surface in world axes; 0 for a miss
  std::vector<glm::vec3> albedo;      ///< diffuse colour of the first surface; 0 for a miss
  std::vector<std::uint32_t> object;  ///< index into Scene::objects; kNoPrimitive for a miss
  /// Hit tests of all rays of the pixel's paths. They depend on the engine and the window.
  std::vector<std::uint32_t> tests;
  std::vector<std::uint32_t> doubts;  ///< tests that binary32 could not decide
  /// Present while rendering continues; written to files if `keeps_sums`.
  FilmSums sums;
  bool keeps_sums = false;

  /// Returns the array index of a pixel of the window.
  [[nodiscard]] std::size_t index_of(int x, int y) const { return window.index_of(x, y); }
};

/// The name of a film's array in files: "N" with the parts "XYZ" has channels N.X, N.Y, N.Z.
struct FilmField {
  std::string_view layer, parts = {};
  bool is_sum = false;  ///< written to files only if the film keeps its sums
};

/// Calls `visit` for each field with its array in each of `films`. No other code lists all arrays.
template <class Visit, class... Films>
void for_each_field(const Visit& visit, Films&... films) {
  visit(FilmField{"", "RGBA"}, films.color...);
  visit(FilmField{"Z"}, films.depth...);
  visit(FilmField{"N", "XYZ"}, films.normal...);
  visit(FilmField{"id"}, films.primitive...);
  visit(FilmField{"P", "XYZ"}, films.position...);
  visit(FilmField{"Albedo", "RGB"}, films.albedo...);
  visit(FilmField{"objectId"}, films.object...);
  visit(FilmField{"tests"}, films.tests...);
  visit(FilmField{"doubts"}, films.doubts...);
  visit(FilmField{"samples", {}, true}, films.sums.samples...);
  visit(FilmField{"error"}, films.sums.error...);
  visit(FilmField{"sums.shown", {}, true}, films.sums.shown...);
  visit(FilmField{"sums", "RGBA", true}, films.sums.color...);
  visit(FilmField{"sums.Albedo", "RGB", true}, films.sums.albedo...);
}
static_assert(sizeof(FilmSums) == 5 * sizeof(std::vector<int>) &&
                  sizeof(Film) == 14 * sizeof(std::vector<int>) + 2 * sizeof(PixelRect),
              "for_each_field() has them all");

/// Returns a film of misses, with the optional channels of `extra` and without sums.
[[nodiscard]] Film make_film(int width, int height, const PixelRect& window,
                             const ExtraChannels& extra);

/// Adds arrays of sums, without samples yet; if `with_error`, also those for adaptive sampling.
void add_sums(Film& film, bool with_error);

/// A channel of a film, with its name in picture files. Valid while the film's arrays exist.
struct Channel {
  enum class Type { kFloat, kUint };  ///< float or std::uint32_t

  std::string name;  ///< as in OpenEXR: "R", "Z", "N.X", "id"
  Type type;
  const void* first;   ///< address of the window's first pixel
  std::size_t stride;  ///< bytes from one pixel to the next; rows follow without a gap
};

/// Returns the channels for files: no sums unless `keeps_sums`, but `samples` if there is `error`.
[[nodiscard]] std::vector<Channel> channels_of(const Film& film);

/// Returns the channel's value at array index `index`; exact.
[[nodiscard]] double value_at(const Channel& channel, std::size_t index);

/// Copies the pixels of `rect`, within both films' windows, to a film with the same arrays.
void copy_region(const Film& from, const PixelRect& rect, Film& to);

/// Filters around a pixel's centre; all are non-negative and separable.
enum class ReconstructionFilter {
  kBox,             ///< 1 within the pixel: radius 0.5
  kBlackmanHarris,  ///< four-term window of radius 1.5: sharper than Gauss, with smooth ends
};

/// Returns the position of a sample in pixels from the pixel's centre, for a point of the unit
/// square. The filter is importance sampled: all samples of a pixel have equal weight.
[[nodiscard]] glm::dvec2 filter_offset(ReconstructionFilter filter, const glm::dvec2& u);

/// Returns the probability density of filter_offset() for uniform `u`, per square pixel.
[[nodiscard]] double filter_density(ReconstructionFilter filter, const glm::dvec2& offset);

/// Returns the largest offset on either axis.
[[nodiscard]] double filter_radius(ReconstructionFilter filter);

}  // namespace raygate
