// Reconstruction filters, sampled by their weight.
#pragma once

#include <glm/glm.hpp>

namespace raygate {

/// Filters around a pixel's centre; all are non-negative and separable.
enum class ReconstructionFilter {
  kBox,             ///< 1 within the pixel: radius 0.5
  kTent,            ///< falls linearly to 0 at radius 1
  kGauss,           ///< standard deviation 0.5, cut off at radius 1.5
  kBlackmanHarris,  ///< four-term window of radius 1.5: sharper than Gauss, and it ends smoothly
};

/// Returns the position of a sample in pixels from the pixel's centre, for a point of the unit
/// square. The filter is importance sampled: all samples of a pixel have equal weight, and pixels
/// are independent, so that a window is a part of the whole picture.
[[nodiscard]] glm::dvec2 filter_offset(ReconstructionFilter filter, const glm::dvec2& u);

/// Returns the probability density of filter_offset() for uniform `u`, per square pixel.
[[nodiscard]] double filter_density(ReconstructionFilter filter, const glm::dvec2& offset);

/// Returns the largest offset on either axis.
[[nodiscard]] double filter_radius(ReconstructionFilter filter);

}  // namespace raygate
