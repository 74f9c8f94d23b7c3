// MTL statements, checked one by one before the library reads them.
#pragma once

#include <set>

#include "host/scene/io/clean_text.h"

namespace raygate {

/// Lets through what Material holds, well-formed: finite numbers, a single one written out for
/// three where it means three, texture options but -s, -o and -clamp taken out, the defaults of
/// Material stated where the library has others. Values out of range are clamped with a warning;
/// what Material does not hold is left out, with a warning where that shows in a picture.
class MtlText final : public CleanText {
 public:
  using CleanText::CleanText;

 private:
  void clean(std::string_view statement, std::string& clean) override;
  void begin_material(std::string_view name, std::string& clean);
  void check_colour(std::string_view keyword, std::string_view words, std::string& clean);
  void check_value(std::string_view keyword, std::string_view words, std::string& clean);
  void check_diffuse_map(std::string_view words, std::string& clean);
  std::string take_texture_vector(std::string_view option, std::string_view& words) const;

  std::set<std::string, std::less<>> names_;
  bool in_material_ = false;
  bool nameless_ = false;     // this material: checked, but not let through
  bool has_diffuse_ = false;  // this material: Kd was there, or stands in for it
};

}  // namespace raygate
