#include "host/scene/io/obj_reader.h"

#include <algorithm>
#include <charconv>
#include <cstdint>

#include "host/scene/io/words.h"

namespace raygate {
namespace {

template <std::size_t size>
bool is_one_of(const std::array<std::string_view, size>& list, std::string_view keyword) {
  return std::find(list.begin(), list.end(), keyword) != list.end();
}

// Shapes that are not polygons, and what belongs to them.
constexpr std::array<std::string_view, 26> kOtherShapes{
    "p",     "l",    "vp",   "cstype", "deg",  "bmat", "step", "curv", "curv2",
    "surf",  "parm", "trim", "hole",   "scrv", "sp",   "end",  "con",  "ctech",
    "stech", "bsp",  "bzp",  "cdc",    "cdp",  "res",  "t",    "vw"};

// What changes no polygon and no material: smoothing and merging groups, display attributes.
constexpr std::array<std::string_view, 10> kOfNoConsequence{
    "s",   "mg",         "bevel",     "c_interp", "d_interp",
    "lod", "shadow_obj", "trace_obj", "usemap",   "maplib"};

// Bits of a corner's form.
constexpr int kHasTexcoord = 1;
constexpr int kHasNormal = 2;
constexpr const char* kForms[4] = {"v", "v/vt", "v//vn", "v/vt/vn"};

}  // namespace

void ObjReader::read() {
  while (const auto statement = lines().next()) read_statement(*statement);
}

void ObjReader::read_statement(std::string_view statement) {
  const std::string_view keyword = take_word(statement);
  if (keyword == "v") {
    const auto numbers = read_numbers(keyword, statement);
    mesh_.add_position({numbers[0], numbers[1], numbers[2]});
  } else if (keyword == "vn") {
    const auto numbers = read_numbers(keyword, statement);
    mesh_.add_normal({numbers[0], numbers[1], numbers[2]});
  } else if (keyword == "vt") {
    const auto numbers = read_numbers(keyword, statement);
    mesh_.add_texcoord({numbers[0], numbers.size() > 1 ? numbers[1] : 0.0});
  } else if (keyword == "f" || keyword == "fo") {  // fo: of old files, to be read as f
    read_face(statement);
  } else if (keyword == "g") {
    set_group(statement);
  } else if (keyword == "o") {
    object_ = statement;
    object_is_known_ = false;
  } else if (keyword == "usemtl") {
    use_material(std::string(statement));
  } else if (keyword == "mtllib") {
    mtl_.load_library(statement);
  } else if (is_one_of(kOtherShapes, keyword)) {
    warn_once(keyword,
              std::string(keyword) + " statements are ignored: only polygons are rendered");
  } else if (keyword == "call" || keyword == "csh") {
    lines().fail(in_quotes(keyword) + " (another file, a command) is not supported");
  } else if (!is_one_of(kOfNoConsequence, keyword)) {
    lines().fail(in_quotes(keyword) +
                 " is no OBJ statement, expected v, vt, vn, f, g, o, usemtl, "
                 "mtllib, # or the like");
  }
}

std::span<const double> ObjReader::read_numbers(std::string_view keyword, std::string_view words) {
  std::size_t count = 0;
  for (std::string_view word = take_word_before_comment(words); !word.empty();
       word = take_word_before_comment(words)) {
    if (count == numbers_.size()) lines().fail("too many numbers after " + in_quotes(keyword));
    numbers_[count++] = expect_number(lines(), word, keyword);
  }
  const auto expect = [&](bool right, const char* what) {
    if (!right) {
      lines().fail(std::string(keyword) + " with " + std::to_string(count) + " numbers, expected " +
                   what);
    }
  };
  if (keyword == "v") {
    expect(count == 3 || count == 4 || count >= 6, "x y z (and a weight or a colour)");
    if (count == 4 && numbers_[3] != 1.0) {
      warn_once("weight", "vertex weights are ignored: they concern curves alone");
    }
  } else if (keyword == "vn") {
    expect(count == 3, "x y z");
  } else {
    expect(count >= 1 && count <= 3, "u v");
  }
  return {numbers_.data(), count};
}

void ObjReader::read_face(std::string_view words) {
  corners_.clear();
  int form = 0;
  for (std::string_view corner = take_word_before_comment(words); !corner.empty();
       corner = take_word_before_comment(words)) {
    // "1/" and "1//" have no texture coordinate and no normal.
    std::string_view plain = corner;
    while (plain.size() > 1 && plain.back() == '/' && corner.size() - plain.size() < 2) {
      plain.remove_suffix(1);
    }
    int this_form = 0;
    corners_.push_back(read_corner(plain, this_form));
    if (corners_.size() == 1) form = this_form;
    if (this_form != form) {
      lines().fail("face corner " + in_quotes(corner) + " has the form " + kForms[this_form] +
                   ", expected " + kForms[form] + " as in the face's first corner");
    }
  }
  if (corners_.size() < 3) {
    lines().fail("face with " + std::to_string(corners_.size()) + " corners, expected at least 3");
  }
  if (!object_is_known_) {
    const std::string between = object_.empty() || group_.empty() ? "" : "/";
    const std::string name = object_ + between + group_;
    object_number_ = objects_.number_of(name.empty() ? "default" : name);
    object_is_known_ = true;
  }
  mesh_.add_face(corners_, material_number_, object_number_, lines().line());
}

FileCorner ObjReader::read_corner(std::string_view corner, int& form) const {
  const auto malformed = [&] {
    lines().fail("face corner " + in_quotes(corner) + ", expected v, v/vt, v//vn or v/vt/vn");
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
      lines().fail("face corner " + in_quotes(corner) + ": an index beyond 2147483647");
    }
    if (index == 0) {
      lines().fail("face corner " + in_quotes(corner) +
                   ": index 0, expected 1 for the first or -1 for the last so far");
    }
    if (field > 0) form |= field == 1 ? kHasTexcoord : kHasNormal;
    at = rest;
    if (at == end) return {indices[0], indices[1], indices[2]};
    if (*at++ != '/') malformed();
  }
  malformed();
  return {};
}

/// "a b" may be one group or two: it is one name here.
void ObjReader::set_group(std::string_view names) {
  group_.clear();
  for (std::string_view name = take_word(names); !name.empty(); name = take_word(names)) {
    group_.append(group_.empty() ? "" : " ").append(name);
  }
  object_is_known_ = false;
}

void ObjReader::use_material(const std::string& name) {
  material_number_ = materials_.number_of(name);
  if (material_number_ == places_.size()) places_.push_back(lines().place());
}

}  // namespace raygate
