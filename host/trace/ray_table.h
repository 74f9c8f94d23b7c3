// Ray table: blocks of rays, converted from the scene file's coordinates for an intersector.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <glm/glm.hpp>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "host/exact/exact.h"

namespace raygate {

/// A block of consecutive rays.
struct RayTable {
  std::uint64_t first = 0;     ///< index of the first ray
  std::vector<Ray> rays;       ///< relative to the scene's origin, scaled
  std::vector<float> limits;   ///< of the scaled rays; +infinity: none
  std::vector<int> exponents;  ///< t of the given ray is 2^exponent times t of the scaled ray
  std::uint64_t rounded = 0;   ///< number of rays that were rounded to binary32

  void clear(std::uint64_t its_first);

  /// Adds the ray P = origin + t direction with hits 0 < t < limit, in the file's coordinates. The
  /// direction can have any length; a zero direction hits nothing. Origins are rounded to binary32
  /// after subtracting the scene's origin, directions and limits directly. Returns null, or, for an
  /// invalid ray, which is not added, the message "found ..., expected ...".
  const char* add(const glm::dvec3& origin, const glm::dvec3& direction, double limit,
                  const glm::dvec3& scene_origin);
};

/// Reads rays block by block; a file can be larger than memory.
///
/// CSV: OX,OY,OZ,DX,DY,DZ or, with the limit, OX,OY,OZ,DX,DY,DZ,LIMIT on each line, between commas,
/// or else semicolons, or else spaces and tabs; spaces and quotes around numbers, a byte order
/// mark, empty lines, lines that begin with # and one header line, without a number, are allowed.
/// NPY: an array of shape (N, 6) or (N, 7), float32 or float64, little-endian, C order (NumPy's NEP
/// 1). The first bytes decide between the two. See RayTable::add for the meaning of the columns.
class RayTableReader {
 public:
  /// `file` "-" is standard input. Throws InputError: "rays.csv: cannot read: ...".
  RayTableReader(const std::filesystem::path& file, const glm::dvec3& scene_origin);
  ~RayTableReader();
  RayTableReader(const RayTableReader&) = delete;
  RayTableReader& operator=(const RayTableReader&) = delete;

  /// Replaces `block` by the next rays, at most `most`; returns false at the end. Throws InputError
  /// with the line (CSV) or row (NPY), what was found and what was expected.
  bool read(std::size_t most, RayTable& block);

 private:
  class Source;
  class CsvSource;
  class NpySource;

  std::string name_;
  glm::dvec3 scene_origin_;
  std::unique_ptr<Source> source_;
  std::uint64_t number_ = 0;
};

}  // namespace raygate
