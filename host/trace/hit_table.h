// Hit table: the rows that say which triangle each ray hits, where, and all that follows.
#pragma once

#include <cstddef>
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

/// A column of the table, or the columns of one vector.
enum class HitColumn {
  kRay,        ///< the ray's number, from 0
  kHit,        ///< 1: it hits something; 0: nothing, and what follows is -1, inf or nan
  kTriangle,   ///< number of the triangle, from 0: the file's faces in order, cut into triangles
  kObject,     ///< number of its `o` or `g`, from 0, in the order of the file
  kMaterial,   ///< number of its material, from 0
  kT,          ///< P = O + t D
  kPoint,      ///< x, y, z: P in the file's coordinates
  kUv,         ///< u, v: P = (1 - u - v) A + u B + v C; 0 <= u, 0 <= v, u + v <= 1
  kNormal,     ///< nx, ny, nz: (B - A) x (C - A) by its length; not turned towards the ray
  kSide,       ///< the exact sign of D . N: -1 where the ray meets the front, 1 the back
  kDoubts,     ///< tests of this ray that binary32 left open: the engine's, resolved exactly
  kUnitPoint,  ///< unit_x, unit_y, unit_z: P with the bits of the hit-test unit
  kUnitError,  ///< unit_error: its error bound, as NearestHit::point_error
};

/// Which hits of a ray are asked for.
enum class Hits {
  kNearest,  ///< one row a ray
  kAny,      ///< one row a ray: whether there is a hit; the query ends at the first one found
  kAll,  ///< a row for each hit, near before far, in exact order; none for a ray that hits nothing
};

/// The columns of these names ("ray", "unit-point" ...) or, without names, the usual ones. Throws
/// InputError, "--columns: found ..., expected ...", with `dashes` in the place of "--": for a name
/// that is unknown, repeated or not available with `hits`, and for all hits of another engine than
/// `cpu`.
[[nodiscard]] std::vector<HitColumn> columns_of(std::span<const std::string> names, Hits hits,
                                                bool is_cpu, const std::string& dashes);

/// Where on its triangle a ray hits.
struct HitPoint {
  double t;     ///< the middle of its interval: off by at most 2^-33 of itself
  double u, v;  ///< as Barycentric
};

/// The triangle must be hit.
[[nodiscard]] HitPoint hit_point_of(const Ray& ray, const Corners& corners);

/// One hit of a ray of a table.
struct RayHit {
  std::uint32_t ray = 0;  ///< index into the table of rays
  NearestHit hit;         ///< primitive kNone: the ray hits nothing
  std::uint32_t doubts = 0;
};

enum class TableFormat { kCsv, kNpy };

/// Turns hits into rows of a table. Numbers of CSV are the shortest decimals that are read back as
/// the same; a NumPy array is structured, a field a column.
class HitTable {
 public:
  /// The references must outlive this.
  HitTable(const Scene& scene, const Bvh& bvh, std::vector<HitColumn> columns, TableFormat format)
      : scene_(scene), bvh_(bvh), columns_(std::move(columns)), format_(format) {}

  /// What comes before the rows; of an NPY file, where `rows` are to come. Its length does not
  /// depend on `rows`.
  [[nodiscard]] std::string header(std::uint64_t rows) const;

  /// The fields of a row, their names and NumPy's types: {"t", "<f8"}.
  [[nodiscard]] std::vector<std::pair<std::string, std::string>> fields() const;

  /// Appends the rows of `hits` of `rays` to `bytes`.
  void append(const RayTable& rays, std::span<const RayHit> hits, std::string& bytes) const;

 private:
  void append(const RayTable& rays, const RayHit& hit, std::string& bytes) const;

  const Scene& scene_;
  const Bvh& bvh_;
  std::vector<HitColumn> columns_;
  TableFormat format_;
};

}  // namespace raygate
