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
  HitPoint place{std::numeric_limits<double>::infinity(), kNan, kNan};  // for t of the scaled ray

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
  /// Appends a point that is given relative to the ray's origin, in world coordinates.
  void put_from_origin(const glm::dvec3& way) { put(scene.origin + (ray.origin + way)); }
};

struct Column {
  std::string_view name;
  bool is_integer;
  std::array<std::string_view, 3> fields;  // unused ones are empty
  void (*write)(Row&);
};

/// Columns in the order of HitColumn.
constexpr Column kColumns[] = {
    {"ray", true, {"ray"}, [](Row& r) { r.put(std::int64_t(r.rays.first + r.found.ray)); }},
    {"hit", true, {"hit"}, [](Row& r) { r.put(std::int64_t{r.is_hit}); }},
    {"triangle", true, {"triangle"}, [](Row& r) { r.put(r.triangle); }},
    {"object",
     true,
     {"object"},
     [](Row& r) { r.put(r.is_hit ? std::int64_t{object_at(r.scene, r.stored)} : -1); }},
    {"material",
     true,
     {"material"},
     [](Row& r) { r.put(r.is_hit ? std::int64_t{face_at(r.scene, r.stored).material} : -1); }},
    {"t",
     false,
     {"t"},
     [](Row& r) { r.put(std::ldexp(r.place.t, r.rays.exponents[r.found.ray])); }},
    {"point",
     false,
     {"x", "y", "z"},
     [](Row& r) { r.put_from_origin(r.place.t * r.ray.direction); }},
    {"uv",
     false,
     {"u", "v"},
     [](Row& r) {
       r.put(r.place.u);
       r.put(r.place.v);
     }},
    {"normal",
     false,
     {"nx", "ny", "nz"},
     [](Row& r) { r.put(glm::normalize(triangle_normal(r.corners))); }},
    {"side",
     true,
     {"side"},
     [](Row& r) {
       r.put(std::int64_t{r.is_hit ? direction_side(r.ray.direction, r.corners) : 0});
     }},
    {"doubts", true, {"doubts"}, [](Row& r) { r.put(std::int64_t{r.found.doubts}); }},
    {"unit-point",
     false,
     {"unit_x", "unit_y", "unit_z"},
     [](Row& r) { r.put_from_origin(glm::dvec3(r.found.hit.point)); }},
    {"unit-error", false, {"unit_error"}, [](Row& r) {
       r.put(r.is_hit ? double{r.found.hit.point_error} : kNan);
     }}};

}  // namespace

std::vector<HitColumn> columns_of(std::span<const std::string> names, Hits hits, bool is_cpu,
                                  const std::string& dashes) {
  using enum HitColumn;
  // Units return nearest hits only.
  if (hits == Hits::kAll && !is_cpu) {
    throw InputError(dashes + "engine: expected cpu with " + dashes + "hits all");
  }
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
      for (const Column& known : kColumns) list.append(list.empty() ? "" : ", ").append(known.name);
      fail(name, "some of " + list);
    }
    const auto column = static_cast<HitColumn>(at - std::begin(kColumns));
    if (std::ranges::find(columns, column) != columns.end()) fail(name, "each name once");
    // Which hit is found first depends on the engine, but not whether there is one.
    if (hits == Hits::kAny && column != kRay && column != kHit && column != kDoubts) {
      fail(name, "ray, hit or doubts with " + dashes + "hits any");
    }
    if (hits == Hits::kAll && (column == kUnitPoint || column == kUnitError)) {
      fail(name, "none of the unit's with " + dashes + "hits all");
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
    const Column& known = kColumns[static_cast<std::size_t>(column)];
    for (const std::string_view field : known.fields) {
      if (field.empty()) continue;
      fields.emplace_back(field, known.is_integer ? "<i8" : "<f8");
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
  if (row.is_hit) {
    row.triangle = bvh_.triangle_of(found.hit.primitive);
    row.stored = bvh_.face_of(found.hit.primitive);
  }
  if (row.is_hit && needs_corners_) {
    row.corners = bvh_.corners_of(found.hit.primitive);
    row.place = hit_point_of(row.ray, row.corners);
  }
  for (const HitColumn column : columns_) kColumns[static_cast<std::size_t>(column)].write(row);
  if (format_ == TableFormat::kCsv) bytes.back() = '\n';
}

void HitTable::append(const RayTable& rays, std::span<const RayHit> hits,
                      std::string& bytes) const {
  constexpr std::size_t kAhead = 8;  // rows between steps
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
