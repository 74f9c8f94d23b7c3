#include "host/scene/io/obj_chunk.h"

#include <algorithm>
#include <charconv>
#include <limits>

#include "host/scene/io/tokens.h"

namespace raygate {
namespace {

template <std::size_t size>
bool is_one_of(const std::array<std::string_view, size>& list, std::string_view keyword) {
  return std::find(list.begin(), list.end(), keyword) != list.end();
}

// Statements of shapes other than polygons.
constexpr std::array<std::string_view, 26> kOtherShapes{
    "p",     "l",    "vp",   "cstype", "deg",  "bmat", "step", "curv", "curv2",
    "surf",  "parm", "trim", "hole",   "scrv", "sp",   "end",  "con",  "ctech",
    "stech", "bsp",  "bzp",  "cdc",    "cdp",  "res",  "t",    "vw"};

// Statements that affect neither polygons nor materials: merging groups, display attributes.
constexpr std::array<std::string_view, 9> kOfNoConsequence{
    "mg", "bevel", "c_interp", "d_interp", "lod", "shadow_obj", "trace_obj", "usemap", "maplib"};

}  // namespace

ObjChunk::Counts ObjChunk::count() const {
  Counts counts;
  TextLines lines = lines_;
  while (auto statement = lines.next()) {
    const std::string_view keyword = take_token(*statement);
    if (keyword == "v") ++counts.mesh.positions;
    if (keyword == "vt") ++counts.mesh.texcoords;
    if (keyword == "vn") ++counts.mesh.normals;
  }
  counts.lines = lines.lines_taken();
  return counts;
}

void ObjChunk::begin_after(const Counts& counts) {
  lines_.begin_after(counts.lines);
  mesh_.begin_after(counts.mesh);
}

void ObjChunk::read() {
  try {
    while (const auto statement = lines_.next()) read_statement(*statement);
  } catch (...) {
    error_ = std::current_exception();
  }
}

void ObjChunk::read_statement(std::string_view statement) {
  std::string_view words = statement;
  const std::string_view keyword = take_token(words);
  if (keyword == "v") {
    const auto numbers = read_numbers(keyword, words);
    mesh_.add_position({numbers[0], numbers[1], numbers[2]});
    if (numbers.size() >= 6) mesh_.add_color({numbers[3], numbers[4], numbers[5]});
  } else if (keyword == "vn") {
    const auto numbers = read_numbers(keyword, words);
    mesh_.add_normal({numbers[0], numbers[1], numbers[2]});
  } else if (keyword == "vt") {
    const auto numbers = read_numbers(keyword, words);
    mesh_.add_texcoord({numbers[0], numbers.size() > 1 ? numbers[1] : 0.0});
  } else if (keyword == "f" || keyword == "fo") {  // old files use fo for f
    read_face(words);
  } else if (keyword == "g" || keyword == "o" || keyword == "s" || keyword == "usemtl" ||
             keyword == "mtllib") {
    keep(statement);
  } else if (is_one_of(kOtherShapes, keyword)) {
    keep_once(keyword);
  } else if (keyword == "call" || keyword == "csh") {
    lines_.fail(in_quotes(keyword) + " (another file, a command) is not supported");
  } else if (!is_one_of(kOfNoConsequence, keyword)) {
    lines_.fail(in_quotes(keyword) +
                " is no OBJ statement, expected v, vt, vn, f, g, o, usemtl, "
                "mtllib, # or the like");
  }
}

void ObjChunk::keep(std::string_view statement) {
  rest_.push_back({std::string(statement), lines_.line(), mesh_.face_count()});
}

/// Keeps the keyword of the first statement with this keyword.
void ObjChunk::keep_once(std::string_view keyword) {
  if (kept_.emplace(keyword).second) keep(keyword);
}

std::span<const double> ObjChunk::read_numbers(std::string_view keyword, std::string_view words) {
  std::size_t count = 0;
  for (std::string_view word = take_token_before_comment(words); !word.empty();
       word = take_token_before_comment(words)) {
    if (count == numbers_.size()) lines_.fail("too many numbers after " + in_quotes(keyword));
    // MeshBuilder leaves out normals, texture coordinates and colours that are not finite.
    const bool must_be_finite = keyword == "v" && count < 3;
    numbers_[count++] = must_be_finite
                            ? lines_.number(word, keyword)
                            : to_number(word).value_or(std::numeric_limits<double>::quiet_NaN());
  }
  const auto expect = [&](bool right, const char* what) {
    if (!right) {
      lines_.fail(std::string(keyword) + " with " + std::to_string(count) + " numbers, expected " +
                  what);
    }
  };
  if (keyword == "v") {
    expect(count == 3 || count == 4 || count >= 6, "x y z (and a weight or a colour)");
    if (count == 4 && numbers_[3] != 1.0) {
      keep_once(keyword);
    }
  } else if (keyword == "vn") {
    expect(count == 3, "x y z");
  } else {
    expect(count >= 1 && count <= 3, "u v");
  }
  return {numbers_.data(), count};
}

void ObjChunk::read_face(std::string_view words) {
  corners_.clear();
  for (std::string_view corner = take_token_before_comment(words); !corner.empty();
       corner = take_token_before_comment(words)) {
    // "1/" and "1//" have no texture coordinate and no normal.
    std::string_view plain = corner;
    while (plain.size() > 1 && plain.back() == '/' && corner.size() - plain.size() < 2) {
      plain.remove_suffix(1);
    }
    corners_.push_back(read_corner(plain));
  }
  mesh_.add_face(corners_, lines_.line());
}

FileCorner ObjChunk::read_corner(std::string_view corner) const {
  const auto malformed = [&] {
    lines_.fail("face corner " + in_quotes(corner) + ", expected v, v/vt, v//vn or v/vt/vn");
  };
  const char* at = corner.data();
  const char* const end = at + corner.size();
  std::array<std::int32_t, 3> indices{};  // position, texture coordinate, normal
  for (std::size_t field = 0; field < 3; ++field) {
    if (field == 1 && at != end && *at == '/') {  // v//vn
      ++at;
      continue;
    }
    std::int32_t& index = indices[field];
    const auto [rest, error] = std::from_chars(at, end, index);
    if (error == std::errc::invalid_argument) malformed();
    if (error == std::errc::result_out_of_range || index == INT32_MIN) {
      lines_.fail("face corner " + in_quotes(corner) + ": an index beyond 2147483647");
    }
    if (index == 0 && field == 0) {
      lines_.fail("face corner " + in_quotes(corner) +
                  ": index 0, expected 1 for the first or -1 for the last so far");
    }
    if (index == 0) index = INT32_MIN;  // refers to no element
    at = rest;
    if (at == end) return {indices[0], indices[1], indices[2]};
    if (*at++ != '/') malformed();
  }
  malformed();
  return {};
}

}  // namespace raygate
