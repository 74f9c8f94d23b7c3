// Comparing images: error measures of an image against a reference.
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

/// Error measures over the pixels that both images contain. d is image minus reference; n is the
/// number of pixels times channels. Pixels in which only one image has a NaN or infinity are
/// counted, and make the errors infinite. Equal infinities and two NaNs are equal.
struct Comparison {
  PixelRect window;              ///< the compared pixels, in the frame's coordinates
  std::uint64_t pixels = 0;      ///< in the window
  std::uint64_t differing = 0;   ///< pixels with any difference, however small
  std::uint64_t not_finite = 0;  ///< pixels with a NaN or infinity in only one of the images
  double mse = 0.0;              ///< sum d^2 / n
  double rmse = 0.0;             ///< sqrt(mse)
  double mae = 0.0;              ///< sum |d| / n
  double bias = 0.0;             ///< sum d / sum reference: -0.01 is 1 % too dark; 0 for equal ones
  double max = 0.0;              ///< largest |d|
  /// sum d^2 / (reference^2 + 0.01) / n: weights errors of dark parts more, as the eye does.
  double relative_mse = 0.0;
  /// Peak signal-to-noise ratio in decibels for a peak of 1; +infinity for equal pictures.
  double psnr = std::numeric_limits<double>::infinity();
  /// Structural similarity of the displayed pictures (see ssim()), 1 for equal ones; none if the
  /// channels are not R, G, B or the window is smaller than 11 x 11.
  std::optional<double> ssim;
  /// Largest |d| of each pixel; infinite if only one picture is finite there.
  std::vector<double> difference;
};

/// Compares two pictures with the same number of channels. Throws InputError ("the pictures ...")
/// if the frames differ in size or the windows have no common pixel. Channels "R", "G", "B" are
/// needed for measures of the displayed picture.
[[nodiscard]] Comparison compare(const ChannelPicture& picture, const ChannelPicture& reference);

/// Returns the mean structural similarity of two grey pictures of `width` columns with values in
/// [0, 1], over all 11 x 11 windows inside. Source: Z. Wang, A. C. Bovik, H. R. Sheikh, E. P.
/// Simoncelli, "Image quality assessment: from error visibility to structural similarity", IEEE
/// TIP 13(4), 2004, with its constants: a Gaussian of sigma 1.5, K1 = 0.01, K2 = 0.03.
[[nodiscard]] std::optional<double> ssim(const std::vector<double>& a, const std::vector<double>& b,
                                         std::size_t width);

/// Reads the channels `names` of an OpenEXR file (see read_exr), or R, G, B of a PNG file (.png),
/// scene-linear from 0 to 1. Throws InputError for other channels of a PNG and for files that
/// cannot be read or are damaged.
[[nodiscard]] ChannelPicture read_picture(const std::filesystem::path& file,
                                          std::span<const std::string> names);

}  // namespace raygate
