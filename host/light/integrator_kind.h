// Which light a picture shows.
#pragma once

namespace raygate {

enum class IntegratorKind {
  kPrimary,  ///< camera rays alone, lit from the camera: diffuse colour times cosine, and emission
  kWhitted,  ///< reflection, refraction and shadows, as in the paper
  kPath,     ///< all light there is, by chance: path tracing
};

}  // namespace raygate
