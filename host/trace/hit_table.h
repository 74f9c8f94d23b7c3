// Hit table: rows with the triangle and position that each ray hits, as CSV or binary numbers.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "host/bvh/bvh.h"
#include "host/intersect/intersector.h"
#include "host/scene/scene.h"
#include "host/trace/ray_table.h"

namespace raygate {

/// A column of the table. kPoint, kUv and kNormal stand for the columns of a vector.
enum class HitColumn {
  kRay,       ///< index of the ray, from 0
  kHit,       ///< 1: a hit; 0: a miss, and the other columns are -1, inf or nan
  kTriangle,  ///< index of the triangle, from 0: the file's faces in order, cut into triangles
  kObject,    ///< index of the triangle's `o` or `g`, from 0, in the order of the file
  kMaterial,  ///< index of the triangle's material, from 0
  // From kT to kSide: columns that need the corners of the triangle.
  kT,       ///< t of the hit point P = origin + t direction
  kPoint,   ///< x, y, z: P in the file's coordinates
  kUv,      ///< u, v: P = (1 - u - v) A + u B + v C for corners A, B, C; 0 <= u, 0 <= v, u + v <= 1
  kNormal,  ///< nx, ny, nz: (B - A) x (C - A) normalised; not flipped towards the ray
  kSide,    ///< exact sign of direction . normal: -1 for the front, 1 for the back
  kDoubts,  ///< number of the ray's tests that binary32 could not decide; exact arithmetic did
};

/// Hits to report for each ray.
enum class Hits {
  kNearest,  ///< one row per ray
  kAny,      ///< one row per ray: whether there is a hit; the search ends at the first hit found
  kAll,      ///< one row per hit, nearest first, in exact order; none for a miss
};

/// Returns the columns of these names ("ray", "t" ...), or the default ones if `names` is empty.
/// Throws InputError "--columns: found ..., expected ...", with `dashes` in place of "--", for a
/// name that is unknown, repeated or not available with `hits`.
[[nodiscard]] std::vector<HitColumn> columns_of(std::span<const std::string> names, Hits hits,
                                                const std::string& dashes);

/// The position of a hit on its triangle.
struct HitPoint {
  double t;     ///< relative error at most 2^-33
  double u, v;  ///< as in Barycentric
};

/// Returns the position of the hit; the ray must hit the triangle.
[[nodiscard]] HitPoint hit_point_of(const ExactRay& ray, const Corners& corners);

/// One hit of a ray of a table.
struct RayHit {
  std::uint32_t ray = 0;  ///< index into the table of rays
  NearestHit hit;         ///< primitive kNone: a miss
  std::uint32_t doubts = 0;
};

/// Decimal numbers, or little-endian 64-bit words as in a structured NumPy array.
enum class TableFormat { kCsv, kBinary };

/// Formats hits as rows of a table. CSV numbers are the shortest decimals that round-trip.
class HitTable {
 public:
  /// `scene` and `bvh` must outlive this object.
  HitTable(const Scene& scene, const Bvh& bvh, std::vector<HitColumn> columns, TableFormat format)
      : scene_(scene), bvh_(bvh), columns_(std::move(columns)), format_(format) {}

  /// Returns the first line of a CSV file.
  [[nodiscard]] std::string header() const;

  /// Returns the names and NumPy types of the fields of a row: {"t", "<f8"}.
  [[nodiscard]] std::vector<std::pair<std::string, std::string>> fields() const;

  /// Appends to `bytes` the rows for `hits`, which are hits of `rays`.
  void append(const RayTable& rays, std::span<const RayHit> hits, std::string& bytes) const;

 private:
  void append(const RayTable& rays, const RayHit& hit, std::string& bytes) const;

  const Scene& scene_;
  const Bvh& bvh_;
  std::vector<HitColumn> columns_;
  TableFormat format_;
  bool needs_corners_ = std::ranges::any_of(columns_, [](HitColumn column) {
    return column >= HitColumn::kT && column <= HitColumn::kSide;
  });
};

}  // namespace raygate
