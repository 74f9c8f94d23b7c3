// OBJ statements, checked one by one before the library reads them.
#pragma once

#include <array>
#include <span>

#include "host/scene/io/clean_text.h"

namespace raygate {

/// Lets through v, vt, vn, f, g, o, usemtl and mtllib, each well-formed: the right count of finite
/// numbers, corners of one form without index 0, no comments. Points, lines and free-form curves
/// and surfaces are left out with a warning, what only concerns a modeller without one; all else
/// is an InputError. (B. Wavefront's "Object Files", version 3.0, is the source of the statements.)
class ObjText final : public CleanText {
 public:
  using CleanText::CleanText;

  /// The numbers of the v, vt or vn statement that the library reads just now, to the nearest
  /// double. (The library adds up decimal digits in double: more than half of all numbers of nine
  /// digits come out some units in the last place off.)
  [[nodiscard]] std::span<const double> numbers() const { return {numbers_.data(), count_}; }

 private:
  void clean(std::string_view statement, std::string& clean) override;
  void read_numbers(std::string_view keyword, std::string_view words);
  void check_face(std::string_view corners, std::string& clean);
  int check_corner(std::string_view corner) const;

  std::array<double, 7> numbers_{};
  std::size_t count_ = 0;
};

}  // namespace raygate
