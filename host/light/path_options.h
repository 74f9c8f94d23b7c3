// What a path tracer does for less noise in its time.
#pragma once

#include "host/light/light_tree.h"

namespace raygate {

/// The mean of a picture is the same with any of them; its noise, and what it takes, are not. What
/// is here by default is what came out best: `lab techniques` measures the others next to it.
struct PathOptions {
  LightSampling lights = LightSampling::kTree;
  /// A light that a scattered ray finds counts for as much as the sky beside it, at least.
  bool limits_mis_weight = true;
  /// After three surfaces a ray that counts for less than this lives on by chance; 0: each does.
  float roulette_threshold = 0.25f;
};

}  // namespace raygate
