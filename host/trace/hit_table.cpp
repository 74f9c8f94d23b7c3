#include "host/trace/hit_table.h"

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>

#include "host/base/input_error.h"

namespace raygate {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// A row that is being written: a hit of a ray, or a miss.
struct Row {
  const Scene& scene;
  const RayTable& rays;
  const RayHit& found;
  TableFormat format;
  std::string& bytes;
  ExactRay ray = rays.exact_ray(found.ray);
  bool is_hit = found.hit.primitive != NearestHit::kNone;
  std::int64_t triangle = -1;
  FaceRef stored{};
  Corners corners{};                                                    // if a column needs them
  HitPoint place{std::numeric_limits<double>::infinity(), kNan, kNan};  // t of the scaled ray

  /// Appends a decimal number and a comma (CSV), or a little-endian 64-bit word.
  template <class T>
  void put(T value) {
    if (format == TableFormat::kCsv) {
      char text[32];
      bytes.append(text, std::to_chars(text, text + sizeof text, value).ptr);
      bytes += ',';
      return;
    }
    const auto word = std::bit_cast<std::uint64_t>(value);
    for (int i = 0; i < 8; ++i) bytes += static_cast<char>(word >> (8 * i));
  }
  void put(const glm::dvec3& v) {
    for (int k = 0; k < 3; ++k) put(is_hit ? v[k] : kNan);
  }
  /// Appends the fields of a column.
  void put_column(HitColumn column) {
    using enum HitColumn;
    switch (column) {
      case kRay:
        return put(std::int64_t(rays.first + found.ray));
      case kHit:
        return put(std::int64_t{is_hit});
      case kTriangle:
        return put(triangle);
      case kObject:
        return put(is_hit ? std::int64_t{object_at(scene, stored)} : -1);
      case kMaterial:
        return put(is_hit ? std::int64_t{face_at(scene, stored).material} : -1);
      case kT:
        return put(std::ldexp(place.t, rays.exponents[found.ray]));
      case kPoint:
        return put(scene.origin + (ray.origin + place.t * ray.direction));
      case kUv:
        put(place.u);
        return put(place.v);
      case kNormal:
        return put(glm::normalize(triangle_normal(corners)));
      case kSide:
        return put(std::int64_t{is_hit ? direction_side(ray.direction, corners) : 0});
      case kDoubts:
        return put(std::int64_t{found.doubts});
    }
  }
};

struct Column {
  std::string_view name;
  bool is_integer;
  std::array<std::string_view, 3> fields;  // unused ones are empty
};

/// Columns in the order of HitColumn.
constexpr Column kColumns[] = {{"ray", true, {"ray"}},
                               {"hit", true, {"hit"}},
                               {"triangle", true, {"triangle"}},
                               {"object", true, {"object"}},
                               {"material", true, {"material"}},
                               {"t", false, {"t"}},
                               {"point", false, {"x", "y", "z"}},
                               {"uv", false, {"u", "v"}},
                               {"normal", false, {"nx", "ny", "nz"}},
                               {"side", true, {"side"}},
                               {"doubts", true, {"doubts"}}};

}  // namespace

std::vector<HitColumn> columns_of(std::span<const std::string> names, Hits hits,
                                  const std::string& dashes) {
  using enum HitColumn;
  if (names.empty()) {
    if (hits == Hits::kAny) return {kRay, kHit};
    return {kRay, kHit, kTriangle, kObject, kT, kPoint, kUv, kNormal, kDoubts};
  }
  std::vector<HitColumn> columns;
  const auto fail = [&](const std::string& name, const std::string& expected) {
    throw InputError(dashes + "columns: found '" + name + "', expected " + expected);
  };
  for (const std::string& name : names) {
    const auto* const at = std::ranges::find(kColumns, name, &Column::name);
    if (at == std::end(kColumns)) {
      std::string list;
      for (const Column& other : kColumns) list.append(list.empty() ? "" : ", ").append(other.name);
      fail(name, "some of " + list);
    }
    const auto column = static_cast<HitColumn>(at - std::begin(kColumns));
    if (std::ranges::find(columns, column) != columns.end()) fail(name, "each name once");
    // The engine determines which hit is found first, but not whether there is a hit.
    if (hits == Hits::kAny && column != kRay && column != kHit && column != kDoubts) {
      fail(name, "ray, hit or doubts with " + dashes + "hits any");
    }
    columns.push_back(column);
  }
  return columns;
}

HitPoint hit_point_of(const ExactRay& ray, const Corners& corners) {
  const Interval t = hit_distance(ray, corners);
  const Barycentric place = barycentric(ray, corners);
  return {0.5 * (t.low + t.high), place.u, place.v};
}

std::vector<std::pair<std::string, std::string>> HitTable::fields() const {
  std::vector<std::pair<std::string, std::string>> fields;
  for (const HitColumn column : columns_) {
    const auto& [name, is_integer, names] = kColumns[static_cast<std::size_t>(column)];
    for (const std::string_view field : names) {
      if (!field.empty()) fields.emplace_back(field, is_integer ? "<i8" : "<f8");
    }
  }
  return fields;
}

std::string HitTable::header() const {
  std::string text;
  for (const auto& [name, type] : fields()) text.append(text.empty() ? "" : ",").append(name);
  return text + "\n";
}

void HitTable::append(const RayTable& rays, const RayHit& found, std::string& bytes) const {
  Row row{scene_, rays, found, format_, bytes};
  const std::uint32_t primitive = found.hit.primitive;
  if (row.is_hit) {
    row.triangle = bvh_.triangle_of(primitive);
    row.stored = bvh_.face_of(primitive);
  }
  if (row.is_hit && needs_corners_) {
    row.corners = bvh_.corners_of(primitive);
    row.place = hit_point_of(row.ray, row.corners);
  }
  for (const HitColumn column : columns_) row.put_column(column);
  if (format_ == TableFormat::kCsv) bytes.back() = '\n';
}

void HitTable::append(const RayTable& rays, std::span<const RayHit> hits,
                      std::string& bytes) const {
  constexpr std::size_t kAhead = 8;  // rows between steps of prefetch_rests
  for (std::size_t i = 0; i < hits.size(); ++i) {
    for (int step = 0; step < 3 && needs_corners_; ++step) {
      const std::size_t later = i + kAhead * static_cast<std::size_t>(3 - step);
      if (later >= hits.size()) continue;
      const std::uint32_t primitive = hits[later].hit.primitive;
      if (primitive != NearestHit::kNone) bvh_.prefetch_rests(primitive, step);
    }
    append(rays, hits[i], bytes);
  }
}

}  // namespace raygate
