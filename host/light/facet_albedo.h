// Facet albedo: the share of light that leaves a rough surface after one facet, as a table.
#pragma once

#include "host/base/triple.h"

namespace raygate {

/// Two shares of the light along a direction that leave GGX facets after meeting one of them, by
/// the direction's cosine and alpha; the rest meets a second facet. Each is an integral over the
/// facets that the direction sees, made when it is first asked for, and
/// bilinear over square roots: off by less than 0.01 for cosines of 0.05 and more.
class FacetAlbedo {
 public:
  /// One of each a lane.
  template <class T>
  struct Shares {
    T first, second;
  };

  /// `first`: of facets that reflect all; `second`: of facets that reflect Schlick's share.
  [[nodiscard]] static const FacetAlbedo& of_mirrors();
  /// Of glass of that index of refraction, reflected and transmitted together: `first` of light
  /// from outside, `second` from inside.
  [[nodiscard]] static const FacetAlbedo& of_glass(float index);

  /// At cosines and alphas in [0, 1].
  template <class T>
  [[nodiscard]] RAYGATE_INLINE Shares<T> at(const T& cosine, const T& alpha) const {
    return at<T>([&](int) RAYGATE_BODY -> const FacetAlbedo& { return *this; }, cosine, alpha);
  }
  /// The same of several tables: lane k has table_of(k).
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
  /// The means over the cosine: of light from all sides.
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
  /// A place between two rows or columns.
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

  explicit FacetAlbedo(float index);  // of glass; 0: of mirrors

  Cell cells_[kSize][kSize];  // by alpha, then by cosine
  Cell means_[kSize];
};

}  // namespace raygate
