// Bounces: rays reflected again and again in a concave corner, shot by shot.
#pragma once

#include <memory>
#include <vector>

#include "host/bvh/bvh.h"
#include "host/lab/stress/random.h"
#include "host/lab/stress/shot.h"
#include "host/light/spawn_ray.h"

namespace raygate::lab {

/// A generator whose shots are the bounces of one another: eight rays from a point in a wedge or a
/// box; the next shot starts where one of them is mirrored, by the renderer's own rule for origins.
/// All shots claim to start inside: the truth says where the rule fails.
class Bounces {
 public:
  Shot operator()(Random& random);

 private:
  void start_anew(Random& random);
  void bounce(Random& random);

  std::shared_ptr<const Mesh> mesh_;
  std::shared_ptr<const Bvh> bvh_;
  glm::vec3 origin_{0.0f};
  std::vector<glm::vec3> directions_;  // of the last shot
  glm::vec3 mirrored_{0.0f};           // of the ray that was followed; 0: none
  int bounces_left_ = 0;
};

}  // namespace raygate::lab
