// Environment light: radiance from a map of all directions, with importance sampling.
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "host/light/sampler.h"
#include "host/scene/scene.h"

namespace raygate {

[[nodiscard]] inline double mean(const glm::dvec3& colour) {
  return (colour.x + colour.y + colour.z) / 3.0;
}

/// An EnvironmentMap prepared for rendering. Directions are unit vectors away from the scene.
///
/// Sampling is by cell. A cell lies between the centres of four texels (two at the poles), where
/// the map is bilinear. A cell's probability is the mean brightness of its corners times its solid
/// angle; within a cell, directions are uniform. So the pdf is positive wherever the map is
/// positive, and at least a quarter of the ideal pdf. ("Physically Based Rendering", Pharr, Jakob
/// and Humphreys, uses whole texels.) T is float or FloatLanes.
class Environment {
 public:
  explicit Environment(const EnvironmentMap& map);

  /// Returns radiance, scene-linear RGB.
  template <class T>
  [[nodiscard]] RAYGATE_INLINE Triple<T> radiance(const Triple<T>& direction) const {
    const Place<T> at = place(direction);
    const auto texels = [&](bool is_right, bool is_lower) RAYGATE_BODY {
      return gather<T>([&](int k) RAYGATE_BODY -> const glm::vec3& {
        return texel(is_right ? at.columns[k] : left_of(at.columns[k]),
                     is_lower ? below(at.rows[k]) : above(at.rows[k]));
      });
    };
    const T x = 1.0f - at.x, y = 1.0f - at.y;
    const Triple<T> upper = texels(false, false) * x + texels(true, false) * at.x;
    const Triple<T> lower = texels(false, true) * x + texels(true, true) * at.x;
    return (upper * y + lower * at.y) * spread<T>(map_.strength);
  }
  /// Returns the probability density of sample(), per steradian.
  template <class T>
  [[nodiscard]] RAYGATE_INLINE T pdf(const Triple<T>& direction) const {
    const Place<T> at = place(direction);
    return gather<T>([&](int k) RAYGATE_BODY {
      const std::uint32_t row = at.rows[k], column = at.columns[k];
      const float* const cdf = &column_cdf_[std::size_t{row} * width_];
      const float in_row = cdf[column] - (column == 0 ? 0.0f : cdf[column - 1]);
      const float of_row = row_cdf_[row] - (row == 0 ? 0.0f : row_cdf_[row - 1]);
      return of_row * in_row * per_solid_angle_[row];
    });
  }
  /// Samples a direction for a point of the unit square.
  template <class T>
  [[nodiscard]] RAYGATE_INLINE Triple<T> sample(const SquarePoint<T>& u) const {
    constexpr int kCount = kLanesOf<T>;
    const auto xs = unpack(u.x), ys = unpack(u.y);
    std::uint32_t rows[kCount];
    float in_rows[kCount], columns[kCount], in_columns[kCount];
    // The position of a number within the chosen interval selects the position within the cell.
    const auto find = [](const float* cdf, std::uint32_t count, float wanted, float& rest) {
      const auto found =
          static_cast<std::uint32_t>(std::upper_bound(cdf, cdf + count - 1, wanted) - cdf);
      const float begin = found == 0 ? 0.0f : cdf[found - 1], size = cdf[found] - begin;
      rest = size > 0.0f ? std::min((wanted - begin) / size, 1.0f) : 0.5f;
      return found;
    };
    for (int k = 0; k < kCount; ++k) {
      rows[k] = find(row_cdf_.data(), height_ + 1, ys[k], in_rows[k]);
      columns[k] = static_cast<float>(
          find(&column_cdf_[std::size_t{rows[k]} * width_], width_, xs[k], in_columns[k]));
    }
    const T in_row = load<T>(in_rows);
    const T upper = gather<T>([&](int k) RAYGATE_BODY { return cosines_[rows[k]]; });
    const T lower = gather<T>([&](int k) RAYGATE_BODY { return cosines_[rows[k] + 1]; });
    const T cosine = upper * (1.0f - in_row) + lower * in_row;
    const T sine = root(at_least(1.0f - cosine * cosine, 0.0f));
    const auto turn = sine_cosine(
        (wide(load<T>(columns)) + wide(load<T>(in_columns)) - 0.5) * (1.0 / double(width_)) - 0.5);
    return spread<T>(up_) * cosine + spread<T>(right_) * (sine * narrow(turn.sine)) +
           spread<T>(ahead_) * (sine * narrow(turn.cosine));
  }

  /// Returns the mean radiance over all directions.
  [[nodiscard]] const glm::dvec3& mean_radiance() const { return mean_; }

 private:
  /// The cell of a direction, and the position within the cell.
  template <class T>
  struct Place {
    std::uint32_t columns[kLanesOf<T>], rows[kLanesOf<T>];
    T x, y;  // in [0, 1] from the left and upper edge, between texel centres
  };
  template <class T>
  [[nodiscard]] RAYGATE_INLINE Place<T> place(const Triple<T>& direction) const {
    constexpr int kCount = kLanesOf<T>;
    const T right = dot(direction, spread<T>(right_)), ahead = dot(direction, spread<T>(ahead_));
    const T up = dot(direction, spread<T>(up_));
    // Cell 0 begins half a texel before the map.
    const T x = at_least(narrow((turns_of<T>(right, ahead) + 0.5) * double(width_) + 0.5), 0.0f);
    const T y = at_least(
        narrow(turns_of<T>(root(right * right + ahead * ahead), up) * (2.0 * double(height_)) +
               0.5),
        0.0f);
    const auto xs = unpack(x), ys = unpack(y);
    Place<T> found;
    float from_left[kCount], from_top[kCount];
    for (int k = 0; k < kCount; ++k) {
      const auto column = static_cast<std::uint32_t>(xs[k]),
                 row = static_cast<std::uint32_t>(ys[k]);
      found.columns[k] = column % width_;
      found.rows[k] = std::min(row, height_);
      from_left[k] = xs[k] - static_cast<float>(column);
      from_top[k] = std::min(ys[k] - static_cast<float>(found.rows[k]), 1.0f);
    }
    found.x = load<T>(from_left);
    found.y = load<T>(from_top);
    return found;
  }

  [[nodiscard]] const glm::vec3& texel(std::uint32_t column, std::uint32_t row) const {
    return map_.texels[std::size_t{row} * width_ + column];
  }
  // Neighbours of a cell: the texels to its left and right, above and below.
  [[nodiscard]] std::uint32_t left_of(std::uint32_t column) const {
    return column == 0 ? width_ - 1 : column - 1;
  }
  [[nodiscard]] static std::uint32_t above(std::uint32_t row) { return row == 0 ? 0 : row - 1; }
  [[nodiscard]] std::uint32_t below(std::uint32_t row) const { return std::min(row, height_ - 1); }

  const EnvironmentMap& map_;
  std::uint32_t width_, height_;  // size of the map; there is one more row of cells than of texels
  glm::vec3 up_, ahead_, right_;
  glm::dvec3 mean_{0.0};
  std::vector<float> row_cdf_;          // cumulative probability of the rows
  std::vector<float> column_cdf_;       // cumulative probability of the cells within each row
  std::vector<float> cosines_;          // cosines of the angles between up_ and the rows' edges
  std::vector<float> per_solid_angle_;  // by row: 1 / the solid angle of a cell
};

}  // namespace raygate
