// Comparing pictures: error measures of a film against a reference.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "host/film/film.h"

namespace raygate::lab {

/// Error measures of the colours of two films. d is picture minus reference; n is three times the
/// number of pixels.
struct Comparison {
  std::uint64_t differing = 0;  ///< pixels with any difference, however small
  double rmse = 0.0;            ///< sqrt(sum d^2 / n)
  double psnr = 0.0;            ///< decibels for a peak of 1; +infinity for equal pictures
  /// Structural similarity of the displayed pictures (see ssim()), 1 for equal ones; none if they
  /// are smaller than 11 x 11.
  std::optional<double> ssim;
};

/// Compares two films of the same window.
[[nodiscard]] Comparison compare(const Film& picture, const Film& reference);

/// Returns the mean structural similarity of two grey pictures of `width` columns with values in
/// [0, 1], over all 11 x 11 windows inside. Source: Z. Wang, A. C. Bovik, H. R. Sheikh, E. P.
/// Simoncelli, "Image quality assessment: from error visibility to structural similarity", IEEE
/// TIP 13(4), 2004, with its constants: a Gaussian of sigma 1.5, K1 = 0.01, K2 = 0.03.
[[nodiscard]] std::optional<double> ssim(const std::vector<double>& a, const std::vector<double>& b,
                                         std::size_t width);

}  // namespace raygate::lab
