#include "host/film/film_region.h"

#include <cassert>
#include <cstring>
#include <type_traits>

namespace raygate {
namespace {

/// Calls `visit` with the first pixel of each row of `rect` in each array that is there, and how
/// many bytes the row has.
template <class AnyFilm, class Visit>
void for_each_row(AnyFilm& film, const PixelRect& rect, const Visit& visit) {
  const auto visit_rows = [&](auto& values) {
    using Value = std::remove_cvref_t<decltype(values.front())>;
    static_assert(std::is_trivially_copyable_v<Value>);
    if (values.empty()) return;
    for (int y = rect.y0; y < rect.y1; ++y) {
      visit(values.data() + film.index_of(rect.x0, y), sizeof(Value) * std::size_t(rect.width()));
    }
  };
  for_each_array(visit_rows, film);
}

}  // namespace

std::string region_bytes(const Film& film, const PixelRect& rect) {
  std::string bytes;
  for_each_row(film, rect, [&](const auto* row, std::size_t size) {
    bytes.append(reinterpret_cast<const char*>(row), size);
  });
  return bytes;
}

void set_region(Film& film, const PixelRect& rect, std::string_view bytes) {
  for_each_row(film, rect, [&](auto* row, std::size_t size) {
    assert(bytes.size() >= size);
    std::memcpy(static_cast<void*>(row), bytes.data(), size);
    bytes.remove_prefix(size);
  });
  assert(bytes.empty());
}

}  // namespace raygate
