#include "host/trace/answers.h"

#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

#include "host/trace/hit_place.h"

namespace raygate {
namespace {

struct Field {
  Answer answer;
  const char* name;
  bool is_integer;
};

constexpr Field kFields[] = {{Answer::kRay, "ray", true},
                             {Answer::kHit, "hit", true},
                             {Answer::kTriangle, "triangle", true},
                             {Answer::kObject, "object", true},
                             {Answer::kMaterial, "material", true},
                             {Answer::kT, "t", false},
                             {Answer::kPoint, "x", false},
                             {Answer::kPoint, "y", false},
                             {Answer::kPoint, "z", false},
                             {Answer::kUv, "u", false},
                             {Answer::kUv, "v", false},
                             {Answer::kNormal, "nx", false},
                             {Answer::kNormal, "ny", false},
                             {Answer::kNormal, "nz", false},
                             {Answer::kDoubts, "doubts", true},
                             {Answer::kUnitPoint, "unit_x", false},
                             {Answer::kUnitPoint, "unit_y", false},
                             {Answer::kUnitPoint, "unit_z", false},
                             {Answer::kUnitError, "unit_error", false}};

/// A line of decimals.
class CsvRow {
 public:
  explicit CsvRow(std::string& bytes) : bytes_(bytes) {}
  void integer(std::int64_t value) { put(value); }
  void number(double value) { put(value); }
  void end() { bytes_.back() = '\n'; }

 private:
  template <class T>
  void put(T value) {
    char text[32];
    bytes_.append(text, std::to_chars(text, text + sizeof text, value).ptr);
    bytes_ += ',';
  }
  std::string& bytes_;
};

/// A structure of words of 64 bits, little-endian.
class NpyRow {
 public:
  explicit NpyRow(std::string& bytes) : bytes_(bytes) {}
  void integer(std::int64_t value) { put(value); }
  void number(double value) { put(value); }
  void end() {}

 private:
  template <class T>
  void put(T value) {
    const auto word = std::bit_cast<std::uint64_t>(value);
    for (int i = 0; i < 8; ++i) bytes_ += static_cast<char>(word >> (8 * i));
  }
  std::string& bytes_;
};

}  // namespace

Answers::Answers(const Scene& scene, const Bvh& bvh, std::vector<Answer> columns,
                 AnswerFormat format)
    : scene_(scene), bvh_(bvh), columns_(std::move(columns)), format_(format) {}

std::vector<std::pair<std::string, std::string>> Answers::fields() const {
  std::vector<std::pair<std::string, std::string>> fields;
  for (const Answer answer : columns_) {
    for (const Field& field : kFields) {
      if (field.answer == answer) fields.emplace_back(field.name, field.is_integer ? "<i8" : "<f8");
    }
  }
  return fields;
}

/// NPY: version 1.0, padded so that any number of rows fits and the rows begin at a multiple of 64.
std::string Answers::header(std::uint64_t rows) const {
  std::string text;
  for (const auto& [name, type] : fields()) {
    if (format_ == AnswerFormat::kCsv) {
      text.append(text.empty() ? "" : ",").append(name);
    } else {
      text.append(text.empty() ? "('" : ", ('")
          .append(name)
          .append("', '")
          .append(type)
          .append("')");
    }
  }
  if (format_ == AnswerFormat::kCsv) return text + "\n";
  text = "{'descr': [" + text + "], 'fortran_order': False, 'shape': (";
  constexpr std::size_t kLongestNumber = 20, kStart = 10;
  const std::size_t longest = kStart + text.size() + kLongestNumber + sizeof ",), }";
  const std::size_t length = (longest + 63) / 64 * 64 - kStart;
  text += std::to_string(rows) + ",), }";
  text.resize(length - 1, ' ');
  text += '\n';
  return std::string("\x93NUMPY\x01\x00", 8) + static_cast<char>(length & 0xFF) +
         static_cast<char>(length >> 8) + text;
}

template <class Row>
void Answers::write(const RayBlock& block, const RayHit& found, Row& row) const {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const NearestHit& hit = found.hit;
  const bool is_hit = hit.primitive != NearestHit::kNone;
  const Ray& ray = block.rays[found.ray];
  Corners corners{};
  std::int64_t number = -1;
  FaceRef stored;
  HitPlace place{std::numeric_limits<double>::infinity(), kNan, kNan};  // t of the scaled ray
  if (is_hit) {
    corners = bvh_.corners_of(hit.primitive);
    number = bvh_.triangle_of(hit.primitive);
    stored = bvh_.face_of(hit.primitive);
    place = place_of_hit(ray, corners);
  }
  const auto vector = [&](const glm::dvec3& v) {
    for (int k = 0; k < 3; ++k) row.number(is_hit ? v[k] : kNan);
  };
  const auto from_origin = [&](const glm::dvec3& way) {
    vector(scene_.origin + (glm::dvec3(ray.origin) + way));
  };
  for (const Answer answer : columns_) {
    switch (answer) {
      case Answer::kRay:
        row.integer(static_cast<std::int64_t>(block.first + found.ray));
        break;
      case Answer::kHit:
        row.integer(is_hit ? 1 : 0);
        break;
      case Answer::kTriangle:
        row.integer(number);
        break;
      case Answer::kObject:
        row.integer(is_hit ? std::int64_t{object_at(scene_, stored)} : -1);
        break;
      case Answer::kMaterial:
        row.integer(is_hit ? std::int64_t{face_at(scene_, stored).material} : -1);
        break;
      case Answer::kT:
        row.number(std::ldexp(place.t, block.exponents[found.ray]));
        break;
      case Answer::kPoint:
        from_origin(place.t * glm::dvec3(ray.direction));
        break;
      case Answer::kUv:
        row.number(place.u);
        row.number(place.v);
        break;
      case Answer::kNormal:
        vector(glm::normalize(triangle_normal(corners)));
        break;
      case Answer::kDoubts:
        row.integer(found.doubts);
        break;
      case Answer::kUnitPoint:
        from_origin(glm::dvec3(hit.point));
        break;
      case Answer::kUnitError:
        row.number(is_hit ? double{hit.point_error} : kNan);
        break;
    }
  }
  row.end();
}

void Answers::append(const RayBlock& block, std::span<const RayHit> hits,
                     std::string& bytes) const {
  for (const RayHit& hit : hits) {
    if (format_ == AnswerFormat::kCsv) {
      CsvRow row(bytes);
      write(block, hit, row);
    } else {
      NpyRow row(bytes);
      write(block, hit, row);
    }
  }
}

}  // namespace raygate
