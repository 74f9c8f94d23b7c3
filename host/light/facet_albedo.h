// Facet albedo: a table of the single-scattering albedo of rough surfaces.
#pragma once

#include "host/base/triple.h"

namespace raygate {

/// Two single-scattering albedos of GGX facets, by the cosine of a direction and alpha. Each is an
/// integral over the visible facets, computed on first use and interpolated bilinearly over square
/// roots; the error is below 0.01 for cosines of at least 0.05.
class FacetAlbedo {
 public:
  /// One value per lane.
  template <class T>
  struct Shares {
    T first, second;
  };

  /// Returns the table of mirrors. `first` has reflectance 1, `second` Schlick's weight.
  [[nodiscard]] static const FacetAlbedo& of_mirrors();
  /// Returns the table of glass with this index of refraction, reflection plus transmission:
  /// `first` for light from outside, `second` from inside.
  [[nodiscard]] static const FacetAlbedo& of_glass(float index);

  /// Returns the albedos at cosines and alphas in [0, 1].
  template <class T>
  [[nodiscard]] RAYGATE_INLINE Shares<T> at(const T& cosine, const T& alpha) const {
    return at<T>([&](int) RAYGATE_BODY -> const FacetAlbedo& { return *this; }, cosine, alpha);
  }
  /// Returns albedos from several tables: lane k uses table_of(k).
  template <class T, class TableOf>
  [[nodiscard]] RAYGATE_INLINE static Shares<T> at(const TableOf& table_of, const T& cosine,
                                                   const T& alpha) {
    const Place<T> row(alpha), column(cosine);
    const auto share = [&](float Cell::*which) RAYGATE_BODY {
      const auto cell = [&](int below, int beside) RAYGATE_BODY {
        return gather<T>([&](int k) RAYGATE_BODY {
          return table_of(k).cells_[row.number[k] + below][column.number[k] + beside].*which;
        });
      };
      const T upper = between(cell(0, 0), cell(0, 1), column.rest);
      return between(upper, between(cell(1, 0), cell(1, 1), column.rest), row.rest);
    };
    return {share(&Cell::first), share(&Cell::second)};
  }
  /// Returns the means over all directions, weighted by the cosine.
  template <class T>
  [[nodiscard]] RAYGATE_INLINE Shares<T> mean(const T& alpha) const {
    const Place<T> row(alpha);
    const auto share = [&](float Cell::*which) RAYGATE_BODY {
      const auto cell = [&](int below) RAYGATE_BODY {
        return gather<T>([&](int k) RAYGATE_BODY { return means_[row.number[k] + below].*which; });
      };
      return between(cell(0), cell(1), row.rest);
    };
    return {share(&Cell::first), share(&Cell::second)};
  }

 private:
  static constexpr int kSize = 24;  // a multiple of kLanes
  struct Cell {
    float first = 0.0f, second = 0.0f;
  };
  /// A position between two rows or columns.
  template <class T>
  struct Place {
    LaneArray<std::int32_t, kLanesOf<T>> number;
    T rest;

    RAYGATE_INLINE explicit Place(const T& x) {
      const T at = root(x) * (kSize - 1.0f);
      const auto before = whole(at_most(at, kSize - 2.0f));
      number = unpack(before);
      rest = at - narrow(wide(before));
    }
  };
  template <class T>
  [[nodiscard]] RAYGATE_INLINE static T between(const T& a, const T& b, const T& rest) {
    return a + (b - a) * rest;
  }

  explicit FacetAlbedo(float index);  // index of glass, or 0 for mirrors

  Cell cells_[kSize][kSize];  // by alpha, then by cosine
  Cell means_[kSize];
};

}  // namespace raygate
