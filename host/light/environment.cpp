#include "host/light/environment.h"

#include <cassert>
#include <cstddef>
#include <numbers>

namespace raygate {
namespace {

/// Writes the cumulative distribution of `weights` to `cdf`, or a uniform one if all are 0.
void put_cdf(const std::vector<double>& weights, float* cdf) {
  double sum = 0.0;
  for (const double weight : weights) sum += weight;
  double so_far = 0.0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    so_far += sum > 0.0 ? weights[i] / sum : 1.0 / static_cast<double>(weights.size());
    cdf[i] = static_cast<float>(std::min(so_far, 1.0));
  }
  cdf[weights.size() - 1] = 1.0f;
}

}  // namespace

Environment::Environment(const EnvironmentMap& map)
    : map_(map),
      width_(static_cast<std::uint32_t>(map.width)),
      height_(static_cast<std::uint32_t>(map.height)),
      up_(map.up),
      ahead_(map.ahead),
      right_(glm::cross(map.ahead, map.up)) {
  assert(map.width > 0 && map.height > 0);
  const std::uint32_t rows = height_ + 1;
  cosines_.push_back(1.0f);
  for (std::uint32_t row = 0; row < height_; ++row) {
    cosines_.push_back(static_cast<float>(sine_cosine((row + 0.5) / (2.0 * height_)).cosine));
  }
  cosines_.push_back(-1.0f);
  row_cdf_.resize(rows);
  column_cdf_.resize(std::size_t{rows} * width_);
  std::vector<double> of_rows(rows), of_cells(width_);
  glm::dvec3 sum(0.0);
  for (std::uint32_t row = 0; row < rows; ++row) {
    const double solid_angle =
        2.0 * std::numbers::pi / width_ * (double{cosines_[row]} - double{cosines_[row + 1]});
    per_solid_angle_.push_back(static_cast<float>(1.0 / solid_angle));
    for (std::uint32_t column = 0; column < width_; ++column) {
      glm::dvec3 corners(0.0);
      double bright = 0.0;
      for (const std::uint32_t x : {left_of(column), column}) {
        for (const std::uint32_t y : {above(row), below(row)}) {
          corners += glm::dvec3(texel(x, y));
          bright += mean(glm::dvec3(texel(x, y)));
        }
      }
      sum += 0.25 * solid_angle * corners;
      of_cells[column] = bright;
      of_rows[row] += bright * solid_angle;
    }
    put_cdf(of_cells, &column_cdf_[std::size_t{row} * width_]);
  }
  put_cdf(of_rows, row_cdf_.data());
  mean_ = sum * (double{map.strength} / (4.0 * std::numbers::pi));
}

}  // namespace raygate
