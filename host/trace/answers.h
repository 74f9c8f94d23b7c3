// What is said of a ray: which triangle it hits, where, and all that follows.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "host/bvh/bvh.h"
#include "host/intersect/intersector.h"
#include "host/scene/scene.h"
#include "host/trace/ray_block.h"

namespace raygate {

/// A column of a table of answers, or the coordinates of one thing.
enum class Answer {
  kRay,        ///< the ray's number, from 0
  kHit,        ///< 1: it hits something; 0: nothing, and what follows is -1, inf or nan
  kTriangle,   ///< number of the triangle, from 0: the file's faces in order, cut into triangles
  kObject,     ///< number of its `o` or `g`, from 0, in the order of the file
  kMaterial,   ///< number of its material, from 0
  kT,          ///< P = O + t D
  kPoint,      ///< x, y, z: P in the file's coordinates
  kUv,         ///< u, v: P = (1 - u - v) A + u B + v C; 0 <= u, 0 <= v, u + v <= 1
  kNormal,     ///< nx, ny, nz: (B - A) x (C - A) by its length; not turned towards the ray
  kDoubts,     ///< tests of this ray that binary32 left open: the engine's, and exact arithmetic
               ///< settled them
  kUnitPoint,  ///< unit_x, unit_y, unit_z: P with the bits of the hit-test unit
  kUnitError,  ///< unit_error: how far each coordinate of P - O may be off in it, of itself
};

/// What the answers are called, in their order: "ray", "hit", "triangle" ...
inline constexpr std::string_view kAnswerNames[] = {
    "ray",   "hit", "triangle", "object", "material",   "t",
    "point", "uv",  "normal",   "doubts", "unit-point", "unit-error"};

/// One hit of a ray of a block.
struct RayHit {
  std::uint32_t ray = 0;  ///< index into the block
  NearestHit hit;         ///< primitive kNone: the ray hits nothing
  std::uint32_t doubts = 0;
};

enum class AnswerFormat { kCsv, kNpy };

/// Turns hits into rows of a table. Numbers of CSV are the shortest decimals that are read back as
/// the same; a NumPy array is structured, a field a column.
class Answers {
 public:
  /// The references must outlive this.
  Answers(const Scene& scene, const Bvh& bvh, std::vector<Answer> columns, AnswerFormat format);

  /// What comes before the rows; of an NPY file, where `rows` are to come. Its length does not
  /// depend on `rows`.
  [[nodiscard]] std::string header(std::uint64_t rows) const;

  /// The fields of a row, their names and NumPy's types: {"t", "<f8"}.
  [[nodiscard]] std::vector<std::pair<std::string, std::string>> fields() const;

  /// Appends the rows of `hits` of `block` to `bytes`.
  void append(const RayBlock& block, std::span<const RayHit> hits, std::string& bytes) const;

 private:
  template <class Row>
  void write(const RayBlock& block, const RayHit& hit, Row& row) const;

  const Scene& scene_;
  const Bvh& bvh_;
  std::vector<Answer> columns_;
  AnswerFormat format_;
};

}  // namespace raygate
