// Ray table: a block of rays in the scene file's coordinates, converted for an intersector.
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

/// Some rays in a row.
struct RayTable {
  std::uint64_t first = 0;     ///< number of the first ray, from 0
  std::vector<Ray> rays;       ///< relative to the scene's origin, scaled
  std::vector<float> limits;   ///< of the scaled rays; +infinity: none
  std::vector<int> exponents;  ///< t of the file's ray is 2^exponent times t of the scaled one
  std::uint64_t rounded = 0;   ///< rays that binary32 does not hold as they were given

  void clear(std::uint64_t its_first);

  /// Adds the ray P = origin + t direction, in the file's coordinates, whose hits have 0 < t <
  /// limit. The direction need not have length 1; one that is 0 hits nothing. Origins become
  /// binary32 after the scene's origin has been subtracted; directions and limits, too. Gives what
  /// is wrong with the ray, "found ..., expected ...", and then adds nothing; or nullptr.
  const char* add(const glm::dvec3& origin, const glm::dvec3& direction, double limit,
                  const glm::dvec3& scene_origin);
};

/// Reads rays block by block, so that a file may be longer than the memory is.
///
/// CSV: OX,OY,OZ,DX,DY,DZ or, with the limit, OX,OY,OZ,DX,DY,DZ,LIMIT on each line, between commas,
/// or else semicolons, or else spaces and tabs; spaces and quotes around numbers, a byte order
/// mark, empty lines, lines that begin with # and one header line, without a number, are allowed.
/// NPY: an array of shape (N, 6) or (N, 7), float32 or float64, little-endian, C order (NumPy's NEP
/// 1). Which of the two it is, the first bytes say.
///
/// What the numbers mean, RayTable::add says.
class RayTableReader {
 public:
  /// `file` "-" is standard input. Throws InputError: "rays.csv: cannot read: ...".
  RayTableReader(const std::filesystem::path& file, const glm::dvec3& scene_origin);
  ~RayTableReader();
  RayTableReader(const RayTableReader&) = delete;
  RayTableReader& operator=(const RayTableReader&) = delete;

  /// Replaces `block` by the next rays, at most `most`; false at the end. Throws InputError with
  /// the line (CSV) or row (NPY): what was found and what was expected.
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
