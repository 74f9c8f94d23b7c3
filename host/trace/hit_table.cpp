#include "host/trace/hit_table.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>

#include "host/base/input_error.h"

namespace raygate {
namespace {

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
                               {"doubts", true, {"doubts"}},
                               {"unit-point", false, {"unit_x", "unit_y", "unit_z"}},
                               {"unit-error", false, {"unit_error"}}};

/// Appends a decimal number and a comma (CSV), or a little-endian 64-bit word.
template <class T>
void put(TableFormat format, T value, std::string& bytes) {
  if (format == TableFormat::kCsv) {
    char text[32];
    bytes.append(text, std::to_chars(text, text + sizeof text, value).ptr);
    bytes += ',';
    return;
  }
  const auto word = std::bit_cast<std::uint64_t>(value);
  for (int i = 0; i < 8; ++i) bytes += static_cast<char>(word >> (8 * i));
}

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
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const NearestHit& hit = found.hit;
  const bool is_hit = hit.primitive != NearestHit::kNone;
  const ExactRay ray = rays.exact_ray(found.ray);
  Corners corners{};
  std::int64_t number = -1;
  FaceRef stored;
  HitPoint place{std::numeric_limits<double>::infinity(), kNan, kNan};  // for t of the scaled ray
  if (is_hit) {
    number = bvh_.triangle_of(hit.primitive);
    stored = bvh_.face_of(hit.primitive);
  }
  if (is_hit && needs_corners_) {
    corners = bvh_.corners_of(hit.primitive);
    place = hit_point_of(ray, corners);
  }
  const auto integer = [&](std::int64_t value) { put(format_, value, bytes); };
  const auto real = [&](double value) { put(format_, value, bytes); };
  const auto vector = [&](const glm::dvec3& v) {
    for (int k = 0; k < 3; ++k) real(is_hit ? v[k] : kNan);
  };
  const auto from_origin = [&](const glm::dvec3& way) {
    vector(scene_.origin + (ray.origin + way));
  };
  for (const HitColumn column : columns_) {
    switch (column) {
      case HitColumn::kRay:
        integer(static_cast<std::int64_t>(rays.first + found.ray));
        break;
      case HitColumn::kHit:
        integer(is_hit ? 1 : 0);
        break;
      case HitColumn::kTriangle:
        integer(number);
        break;
      case HitColumn::kObject:
        integer(is_hit ? std::int64_t{object_at(scene_, stored)} : -1);
        break;
      case HitColumn::kMaterial:
        integer(is_hit ? std::int64_t{face_at(scene_, stored).material} : -1);
        break;
      case HitColumn::kT:
        real(std::ldexp(place.t, rays.exponents[found.ray]));
        break;
      case HitColumn::kPoint:
        from_origin(place.t * ray.direction);
        break;
      case HitColumn::kUv:
        real(place.u);
        real(place.v);
        break;
      case HitColumn::kNormal:
        vector(glm::normalize(triangle_normal(corners)));
        break;
      case HitColumn::kSide:
        integer(is_hit ? direction_side(ray.direction, corners) : 0);
        break;
      case HitColumn::kDoubts:
        integer(found.doubts);
        break;
      case HitColumn::kUnitPoint:
        from_origin(glm::dvec3(hit.point));
        break;
      case HitColumn::kUnitError:
        real(is_hit ? double{hit.point_error} : kNan);
        break;
    }
  }
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
