// Bounces: rays reflected repeatedly in a concave corner, one reflection per shot.
#pragma once

#include <memory>
#include <vector>

#include "host/bvh/bvh.h"
#include "host/lab/stress/random.h"
#include "host/lab/stress/shot.h"
#include "host/light/spawn_ray.h"

namespace raygate::lab {

/// A generator whose shots are successive reflections: eight rays from a point in a wedge or a box.
/// The next shot starts where one of them is reflected, at the renderer's spawn origin. All shots
/// claim to start inside; the oracle finds out where the rule for origins fails.
class Bounces {
 public:
  Shot operator()(Random& random);

 private:
  void start_anew(Random& random);
  void bounce(Random& random);

  std::shared_ptr<const Mesh> mesh_;
  std::shared_ptr<const Bvh> bvh_;
  glm::vec3 origin_{0.0f};
  std::vector<glm::vec3> directions_;  // directions of the last shot
  glm::vec3 mirrored_{0.0f};           // of the ray that was followed; 0: none
  int bounces_left_ = 0;
};

}  // namespace raygate::lab
