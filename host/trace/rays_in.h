// Rays as people have them: a CSV table or a NumPy array, in the scene file's coordinates.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <glm/glm.hpp>
#include <memory>
#include <string>
#include <vector>

#include "host/exact/exact.h"

namespace raygate {

/// A run of rays, made ready for a finder.
struct RayBlock {
  std::uint64_t first = 0;     ///< number of the first ray, from 0
  std::vector<Ray> rays;       ///< relative to the scene's origin, scaled
  std::vector<float> limits;   ///< of the scaled rays; +infinity: none
  std::vector<int> exponents;  ///< t of the file's ray is 2^exponent times t of the scaled one
};

/// Reads rays block by block, so that a file may be longer than the memory is.
///
/// CSV: OX,OY,OZ,DX,DY,DZ or, with the limit, OX,OY,OZ,DX,DY,DZ,LIMIT on each line; spaces around
/// numbers, empty lines, lines that begin with # and one header line are allowed. NPY: an array of
/// shape (N, 6) or (N, 7), float32 or float64, little-endian, C order (NumPy's NEP 1). Which of the
/// two it is, the first bytes say.
///
/// A hit has 0 < t < LIMIT, P = O + t D; LIMIT above 0, inf for none. The direction need not have
/// length 1; one that is 0 hits nothing. Origins become binary32 after the scene's origin has been
/// subtracted; directions and limits, too: rounded() counts the rays that this changed.
class RaysIn {
 public:
  /// `file` "-" is standard input. Throws InputError: "rays.csv: cannot read: ...".
  RaysIn(const std::filesystem::path& file, const glm::dvec3& scene_origin);
  ~RaysIn();
  RaysIn(const RaysIn&) = delete;
  RaysIn& operator=(const RaysIn&) = delete;

  /// Replaces `block` by the next rays, at most `most`; false at the end. Throws InputError with
  /// the line (CSV) or row (NPY): what was found and what was expected.
  bool read(std::size_t most, RayBlock& block);

  /// Rays so far that binary32 does not hold as they were given.
  [[nodiscard]] std::uint64_t rounded() const { return rounded_; }

 private:
  class Source;
  class CsvSource;
  class NpySource;

  void add(const double* numbers, int count, RayBlock& block);

  std::string name_;
  glm::dvec3 scene_origin_;
  std::unique_ptr<Source> source_;
  std::uint64_t number_ = 0, rounded_ = 0;
};

}  // namespace raygate
