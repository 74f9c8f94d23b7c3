// Comparing pictures: error measures of a picture against a reference.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "host/film/exr.h"

namespace raygate {

/// Measures over the pixels that both pictures hold. d is picture minus reference, n counts
/// pixels and channels. Where one picture has a NaN or an infinity that the other has not, no
/// number tells how far they are apart: such pixels are counted, and the errors are infinite.
/// Equal infinities, and two NaNs, are equal.
struct Comparison {
  PixelRect window;              ///< what was compared, in the frame's coordinates
  std::uint64_t pixels = 0;      ///< in it
  std::uint64_t differing = 0;   ///< pixels with any difference, however small
  std::uint64_t not_finite = 0;  ///< pixels with a NaN or infinity in one of the pictures alone
  double mse = 0.0;              ///< sum d^2 / n
  double rmse = 0.0;             ///< its root
  double mae = 0.0;              ///< sum |d| / n
  double bias = 0.0;             ///< sum d / sum reference: -0.01 is 1 % too dark; 0 for equal ones
  double max = 0.0;              ///< largest |d|
  /// sum d^2 / (reference^2 + 0.01) / n: errors of dark parts count as the eye sees them
  double relative_mse = 0.0;
  /// Decibels, of a peak of 1: -10 log10(mse); +infinity for equal pictures.
  double psnr = std::numeric_limits<double>::infinity();
  /// Structural similarity of what a display shows, 1 for equal pictures, see ssim(); none where
  /// the channels are not R, G, B or the window is smaller than 11 x 11.
  std::optional<double> ssim;
  /// Largest |d| of each pixel's channels; infinite where one picture alone is not finite.
  std::vector<double> difference;
};

/// Throws InputError (its text begins with "the pictures") if the frames differ in size, or the
/// windows have no pixel in common. The channels must be the same in number; the third and the
/// first two of exactly "R", "G", "B" make a picture to look at.
[[nodiscard]] Comparison compare(const ChannelPicture& picture, const ChannelPicture& reference);

/// Mean structural similarity of two grey pictures of `width` columns with values in [0, 1], over
/// all windows of 11 x 11 that lie wholly within. Source: Z. Wang, A. C. Bovik, H. R. Sheikh, E. P.
/// Simoncelli, "Image quality assessment: from error visibility to structural similarity", IEEE
/// TIP 13(4), 2004, with its constants: a Gaussian of sigma 1.5, K1 = 0.01, K2 = 0.03.
[[nodiscard]] std::optional<double> ssim(const std::vector<double>& a, const std::vector<double>& b,
                                         std::size_t width);

/// Reads the channels `names`: of OpenEXR those of that name (see read_exr); of a PNG file, whose
/// name ends in .png, R, G and B, scene-linear from 0 to 1. Throws InputError for other channels of
/// a PNG, and for files that cannot be read or are damaged.
[[nodiscard]] ChannelPicture read_picture(const std::filesystem::path& file,
                                          std::span<const std::string> names);

}  // namespace raygate
