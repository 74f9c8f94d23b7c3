#include "host/scene/io/obj_text.h"

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

// What the library takes whole, as it stands.
constexpr std::array<std::string_view, 3> kNames{"g", "o", "usemtl"};

// Bits of a corner's form.
constexpr int kHasTexcoord = 1;
constexpr int kHasNormal = 2;
constexpr const char* kForms[4] = {"v", "v/vt", "v//vn", "v/vt/vn"};

}  // namespace

void ObjText::clean(std::string_view statement, std::string& clean) {
  const std::string_view whole = statement;
  const std::string_view keyword = take_word(statement);
  if (keyword == "v" || keyword == "vn" || keyword == "vt") {
    read_numbers(keyword, statement);
    clean.append(whole);
  } else if (keyword == "f" || keyword == "fo") {  // fo: of old files, to be read as f
    check_face(statement, clean);
  } else if (is_one_of(kNames, keyword)) {
    clean.append(keyword).append(" ").append(statement);
  } else if (keyword == "mtllib") {
    // The library takes backslashes away and splits at spaces; the names are to reach our
    // MtlLoader as they stand.
    clean.append("mtllib ");
    for (const char c : statement) {
      if (c == ' ' || c == '\\') clean += '\\';
      clean += c;
    }
  } else if (is_one_of(kOtherShapes, keyword)) {
    warn_once(keyword,
              std::string(keyword) + " statements are ignored: only polygons are rendered");
    return;
  } else if (is_one_of(kOfNoConsequence, keyword)) {
    return;
  } else if (keyword == "call" || keyword == "csh") {
    lines().fail(in_quotes(keyword) + " (another file, a command) is not supported");
  } else {
    lines().fail(in_quotes(keyword) +
                 " is no OBJ statement, expected v, vt, vn, f, g, o, usemtl, "
                 "mtllib, # or the like");
  }
  clean += '\n';
}

void ObjText::read_numbers(std::string_view keyword, std::string_view words) {
  count_ = 0;
  for (std::string_view word = take_word_before_comment(words); !word.empty();
       word = take_word_before_comment(words)) {
    if (count_ == numbers_.size()) lines().fail("too many numbers after " + in_quotes(keyword));
    numbers_[count_++] = expect_number(lines(), word, keyword);
  }
  const auto expect = [&](bool right, const char* what) {
    if (!right) {
      lines().fail(std::string(keyword) + " with " + std::to_string(count_) +
                   " numbers, expected " + what);
    }
  };
  if (keyword == "v") {
    expect(count_ == 3 || count_ == 4 || count_ >= 6, "x y z (and a weight or a colour)");
    if (count_ == 4 && numbers_[3] != 1.0) {
      warn_once("weight", "vertex weights are ignored: they concern curves alone");
    }
  } else if (keyword == "vn") {
    expect(count_ == 3, "x y z");
  } else {
    expect(count_ >= 1 && count_ <= 3, "u v");
  }
}

void ObjText::check_face(std::string_view corners, std::string& clean) {
  clean += 'f';
  std::size_t count = 0;
  int form = 0;
  for (std::string_view corner = take_word_before_comment(corners); !corner.empty();
       corner = take_word_before_comment(corners)) {
    // "1/" and "1//" have no texture coordinate and no normal, but the library would look for them
    // in the next corner.
    std::string_view plain = corner;
    while (plain.size() > 1 && plain.back() == '/' && corner.size() - plain.size() < 2) {
      plain.remove_suffix(1);
    }
    const int this_form = check_corner(plain);
    if (count++ == 0) form = this_form;
    if (this_form != form) {
      lines().fail("face corner " + in_quotes(corner) + " has the form " + kForms[this_form] +
                   ", expected " + kForms[form] + " as in the face's first corner");
    }
    clean.append(" ").append(plain);
  }
  if (count < 3) {
    lines().fail("face with " + std::to_string(count) + " corners, expected at least 3");
  }
}

// Returns the corner's form.
int ObjText::check_corner(std::string_view corner) const {
  const auto malformed = [&] {
    lines().fail("face corner " + in_quotes(corner) + ", expected v, v/vt, v//vn or v/vt/vn");
  };
  const char* at = corner.data();
  const char* const end = at + corner.size();
  int form = 0;
  for (int field = 0; field < 3; ++field) {
    if (field == 1 && at != end && *at == '/') {  // v//vn
      ++at;
      continue;
    }
    std::int32_t index = 0;
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
    if (at == end) return form;
    if (*at++ != '/') malformed();
  }
  malformed();
  return form;
}

}  // namespace raygate
