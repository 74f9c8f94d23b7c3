// What a path tracer does for less noise in its time.
#pragma once

#include "host/light/light_tree.h"

namespace raygate {

/// The mean of a picture is the same with any of them; its noise, and what it takes, are not. What
/// is here by default is what came out best: `lab techniques` measures the others next to it.
struct Techniques {
  LightChoice lights = LightChoice::kTree;
  /// A lamp that a scattered ray finds counts for as much as the sky beside it, at least.
  bool evens_out = true;
  /// After three surfaces a ray that counts for less than this lives on by chance; 0: each does.
  float sure_weight = 0.25f;
};

}  // namespace raygate
