// Reconstruction filters, sampled by their weight.
#pragma once

#include <glm/glm.hpp>

namespace raygate {

/// Weights around a pixel's centre, all non-negative and separable.
enum class ReconstructionFilter {
  kBox,             ///< 1 within the pixel: radius 0.5
  kTent,            ///< falls linearly to 0 at radius 1
  kGauss,           ///< standard deviation 0.5, cut off at radius 1.5
  kBlackmanHarris,  ///< four-term window of radius 1.5: sharper than Gauss, and it ends smoothly
};

/// Where a sample falls, in pixels from the pixel's centre, for a point of the unit square: the
/// filter is sampled by its weight, so that every sample of a pixel counts the same and no other
/// pixel has a say in it. What is rendered of a window is what the whole picture has there.
[[nodiscard]] glm::dvec2 filter_offset(ReconstructionFilter filter, const glm::dvec2& u);

/// How likely filter_offset() is to give an offset, per square pixel, for uniform `u`.
[[nodiscard]] double filter_density(ReconstructionFilter filter, const glm::dvec2& offset);

/// No offset is larger, on either axis.
[[nodiscard]] double filter_radius(ReconstructionFilter filter);

}  // namespace raygate
