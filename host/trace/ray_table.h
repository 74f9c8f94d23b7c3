// Ray table: blocks of rays, converted from the scene file's coordinates for an intersector.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <glm/glm.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "host/exact/exact.h"

namespace raygate {

/// A block of consecutive rays.
struct RayTable {
  std::uint64_t first = 0;           ///< index of the first ray
  std::vector<Ray> rays;             ///< relative to the scene's origin, scaled, in binary32
  std::vector<ExactRay> exact_rays;  ///< the same rays in binary64; empty: `rays` are exact
  std::vector<double> limits;        ///< limits of t of the scaled rays; see is_before()
  std::vector<int> exponents;        ///< t of the given ray is 2^exponent times t of the scaled ray
  std::uint64_t rounded = 0;         ///< number of rays that were rounded

  void clear(std::uint64_t its_first);

  /// Adds the ray P = origin + t direction with hits 0 < t < limit, in the file's coordinates. The
  /// direction can have any length; a zero direction hits nothing. Origins are rounded to binary64
  /// after subtracting the scene's origin. Returns null. For an invalid ray, adds nothing and
  /// returns the message "found ..., expected ...".
  const char* add(const glm::dvec3& origin, const glm::dvec3& direction, double limit,
                  const glm::dvec3& scene_origin);

  /// Returns a ray in its most exact stored form.
  [[nodiscard]] ExactRay exact_ray(std::size_t i) const {
    return exact_rays.empty() ? ExactRay(rays[i]) : exact_rays[i];
  }
  /// Rounds all rays to binary32.
  void round() {
    exact_rays.clear();
    rounded = rounded_to_floats_;
  }

 private:
  std::uint64_t rounded_to_floats_ = 0;  // `rounded` after round()
};

/// Reads rays block by block; a file can be larger than memory. Each line is OX,OY,OZ,DX,DY,DZ or
/// OX,OY,OZ,DX,DY,DZ,LIMIT (see RayTable::add). Numbers are separated by commas, in a line without
/// commas by semicolons, and in a line without both by white space. Spaces and quotes around
/// numbers, a byte order mark, empty lines, lines that begin with # and one header without a number
/// are allowed. A header that names these columns in another order is an error.
class RayTableReader {
 public:
  /// `file` "-" is standard input. Throws InputError: "rays.csv: cannot read: ...".
  RayTableReader(const std::filesystem::path& file, const glm::dvec3& scene_origin);

  /// Replaces `block` by the next rays, at most `most`; returns false at the end. Throws InputError
  /// with the line, what was found and what was expected.
  bool read(std::size_t most, RayTable& block);

 private:
  static constexpr int kMostNumbers = 7;

  /// Reads the next row of 6 or 7 numbers. Returns their count, or 0 at the end.
  int next(double (&numbers)[kMostNumbers]);
  /// Reads the numbers of a line. Returns their count, or 0 for a header.
  int split(std::string_view line, double (&numbers)[kMostNumbers]);
  [[noreturn]] void fail(const std::string& what) const;
  [[noreturn]] void fail_reading() const;

  std::string name_;
  glm::dvec3 scene_origin_;
  std::ifstream file_;
  std::istream& stream_;    // the file, or standard input
  std::vector<char> text_;  // buffer of a line
  std::size_t line_ = 0;
  bool past_header_ = false;
  std::uint64_t number_ = 0;  // number of rays read
};

}  // namespace raygate
