// Light from an environment map: what comes from a direction, and directions where much comes from.
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "host/base/elementary.h"
#include "host/base/lane_math.h"
#include "host/light/sampler.h"
#include "host/scene/scene.h"

namespace raygate {

/// An EnvironmentMap, ready for use. Directions are unit vectors away from the scene; T is float or
/// FloatLanes.
///
/// It is sampled cell by cell. A cell lies between the middles of four texels (at the upper and the
/// lower edge, of two), where the map is bilinear; it is as likely as the mean brightness of its
/// corners times its solid angle, and all directions of a cell are equally likely. So the pdf
/// is nowhere 0 where something shines, and nowhere less than a quarter of what would be ideal in
/// its cell. ("Physically Based Rendering", Pharr, Jakob and Humphreys, does so with whole texels.)
class Environment {
 public:
  /// Without `is_sampled` there is neither pdf() nor sample().
  explicit Environment(const EnvironmentMap& map, bool is_sampled = true);

  /// Radiance: scene-linear RGB.
  template <class T>
  [[nodiscard]] RAYGATE_INLINE Triple<T> radiance(const Triple<T>& direction) const;
  /// How likely sample() gives a direction, per steradian.
  template <class T>
  [[nodiscard]] RAYGATE_INLINE T pdf(const Triple<T>& direction) const;
  /// A direction for a point of the unit square.
  template <class T>
  [[nodiscard]] RAYGATE_INLINE Triple<T> sample(const SquarePoint<T>& u) const;

  /// Of all directions.
  [[nodiscard]] const glm::dvec3& mean_radiance() const { return mean_; }

 private:
  /// The cell around a direction, and where in it that is.
  template <class T>
  struct Place {
    std::uint32_t columns[LanesOf<T>::kCount], rows[LanesOf<T>::kCount];
    T x, y;  // from the left and the upper edge, of the way between the texels' middles
  };
  template <class T>
  [[nodiscard]] RAYGATE_INLINE Place<T> place(const Triple<T>& direction) const;

  [[nodiscard]] const glm::vec3& texel(std::uint32_t column, std::uint32_t row) const {
    return map_.texels[std::size_t{row} * width_ + column];
  }
  // Of a cell: the texels to its left and right, above and below.
  [[nodiscard]] std::uint32_t left_of(std::uint32_t column) const {
    return column == 0 ? width_ - 1 : column - 1;
  }
  [[nodiscard]] static std::uint32_t above(std::uint32_t row) { return row == 0 ? 0 : row - 1; }
  [[nodiscard]] std::uint32_t below(std::uint32_t row) const { return std::min(row, height_ - 1); }

  const EnvironmentMap& map_;
  std::uint32_t width_, height_;  // of the map: there are as many columns of cells, a row more
  glm::vec3 up_, ahead_, right_;
  glm::dvec3 mean_{0.0};
  std::vector<float> row_cdf_;          // chance of the rows so far, each included
  std::vector<float> column_cdf_;       // the same of the cells of each row
  std::vector<float> cosines_;          // of the rows' edges, from straight up; one more than rows
  std::vector<float> per_solid_angle_;  // by row: 1 / the solid angle of a cell
};

template <class T>
RAYGATE_INLINE Environment::Place<T> Environment::place(const Triple<T>& direction) const {
  constexpr int kCount = LanesOf<T>::kCount;
  const T right = dot(direction, spread<T>(right_)), ahead = dot(direction, spread<T>(ahead_));
  const T up = dot(direction, spread<T>(up_));
  // Cell 0 begins half a texel before the map does.
  const T x = at_least(narrow((turns_of<T>(right, ahead) + 0.5) * double(width_) + 0.5), 0.0f);
  const T y = at_least(
      narrow(turns_of<T>(root(right * right + ahead * ahead), up) * (2.0 * double(height_)) + 0.5),
      0.0f);
  float xs[kCount], ys[kCount];
  lanes_to(xs, x);
  lanes_to(ys, y);
  Place<T> found;
  Gathered<T, 2> rest;
  for (int k = 0; k < kCount; ++k) {
    const auto column = static_cast<std::uint32_t>(xs[k]), row = static_cast<std::uint32_t>(ys[k]);
    rest.values[0][k] = xs[k] - static_cast<float>(column);
    found.columns[k] = column % width_;
    found.rows[k] = std::min(row, height_);
    rest.values[1][k] = std::min(ys[k] - static_cast<float>(found.rows[k]), 1.0f);
  }
  found.x = rest.one(0);
  found.y = rest.one(1);
  return found;
}

template <class T>
RAYGATE_INLINE Triple<T> Environment::radiance(const Triple<T>& direction) const {
  const Place<T> at = place(direction);
  Gathered<T, 12> corners;
  for (int k = 0; k < LanesOf<T>::kCount; ++k) {
    const std::uint32_t left = left_of(at.columns[k]), right = at.columns[k];
    const std::uint32_t upper = above(at.rows[k]), lower = below(at.rows[k]);
    corners.put(0, k, texel(left, upper));
    corners.put(3, k, texel(right, upper));
    corners.put(6, k, texel(left, lower));
    corners.put(9, k, texel(right, lower));
  }
  const T x = 1.0f - at.x, y = 1.0f - at.y;
  const Triple<T> upper = corners.triple(0) * x + corners.triple(3) * at.x;
  const Triple<T> lower = corners.triple(6) * x + corners.triple(9) * at.x;
  return (upper * y + lower * at.y) * spread<T>(map_.strength);
}

template <class T>
RAYGATE_INLINE T Environment::pdf(const Triple<T>& direction) const {
  const Place<T> at = place(direction);
  Gathered<T, 1> pdfs;
  for (int k = 0; k < LanesOf<T>::kCount; ++k) {
    const std::uint32_t row = at.rows[k], column = at.columns[k];
    const float* const cdf = &column_cdf_[std::size_t{row} * width_];
    const float in_row = cdf[column] - (column == 0 ? 0.0f : cdf[column - 1]);
    const float of_row = row_cdf_[row] - (row == 0 ? 0.0f : row_cdf_[row - 1]);
    pdfs.values[0][k] = of_row * in_row * per_solid_angle_[row];
  }
  return pdfs.one(0);
}

template <class T>
RAYGATE_INLINE Triple<T> Environment::sample(const SquarePoint<T>& u) const {
  constexpr int kCount = LanesOf<T>::kCount;
  float xs[kCount], ys[kCount];
  lanes_to(xs, u.x);
  lanes_to(ys, u.y);
  enum : std::uint8_t { kUpper, kLower, kInRow, kColumn, kInColumn, kFields };
  Gathered<T, kFields> in;
  // Where a number lies within what it chooses says where in that.
  const auto find = [](const float* cdf, std::uint32_t count, float wanted, float& rest) {
    const auto found =
        static_cast<std::uint32_t>(std::upper_bound(cdf, cdf + count - 1, wanted) - cdf);
    const float begin = found == 0 ? 0.0f : cdf[found - 1], size = cdf[found] - begin;
    rest = size > 0.0f ? std::min((wanted - begin) / size, 1.0f) : 0.5f;
    return found;
  };
  for (int k = 0; k < kCount; ++k) {
    const std::uint32_t row = find(row_cdf_.data(), height_ + 1, ys[k], in.values[kInRow][k]);
    const std::uint32_t column =
        find(&column_cdf_[std::size_t{row} * width_], width_, xs[k], in.values[kInColumn][k]);
    in.values[kUpper][k] = cosines_[row];
    in.values[kLower][k] = cosines_[row + 1];
    in.values[kColumn][k] = static_cast<float>(column);
  }
  const T in_row = in.one(kInRow);
  const T cosine = in.one(kUpper) * (1.0f - in_row) + in.one(kLower) * in_row;
  const T sine = root(at_least(1.0f - cosine * cosine, 0.0f));
  const auto turn = sine_cosine(
      (wide(in.one(kColumn)) + wide(in.one(kInColumn)) - 0.5) * (1.0 / double(width_)) - 0.5);
  return spread<T>(up_) * cosine + spread<T>(right_) * (sine * narrow(turn.sine)) +
         spread<T>(ahead_) * (sine * narrow(turn.cosine));
}

}  // namespace raygate
