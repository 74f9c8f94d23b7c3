#include "sim/bench/test_stream.h"

#include <array>
#include <cmath>
#include <random>

#include "host/scene/camera.h"

namespace raygate {
namespace {

class Source {
 public:
  double uniform(double low, double high) {
    return low + (high - low) * std::ldexp(static_cast<double>(random_() >> 11), -53);
  }
  glm::dvec3 point_in_box() { return {uniform(-2, 2), uniform(-2, 2), uniform(2, 6)}; }

 private:
  std::mt19937_64 random_{1};
};

}  // namespace

TestStream random_stream(int bursts, int tests, double aimed) {
  Source source;
  TestStream stream;
  for (int burst = 0; burst < bursts; ++burst) {
    const glm::dvec3 target = source.point_in_box();
    const glm::vec3 direction = scaled_direction(target);
    RayBundle bundle;
    for (int k = 0; k < 3; ++k) bundle.direction[k][0] = direction[k];
    bundle.lanes = 1;
    bundle.record_count = static_cast<std::uint32_t>(tests);
    for (int i = 0; i < tests; ++i) {
      std::array<glm::dvec3, 3> corners{source.point_in_box(), source.point_in_box(),
                                        source.point_in_box()};
      if (source.uniform(0.0, 1.0) < aimed) {  // move the triangle's centre onto the ray
        const glm::dvec3 middle = (corners[0] + corners[1] + corners[2]) / 3.0;
        for (glm::dvec3& corner : corners) corner += target * (middle.z / target.z) - middle;
      }
      stream.records.push_back(make_record(
          glm::vec3(0.0f), {glm::vec3(corners[0]), glm::vec3(corners[1]), glm::vec3(corners[2])}));
      const PolygonRecord& record = stream.records.back();
      stream.plane_tests.push_back({direction, record.normal, record.d});
    }
    stream.bundles.push_back(bundle);
  }
  for (std::size_t i = 0; i < stream.bundles.size(); ++i) {
    stream.bundles[i].records = stream.records.data() + i * static_cast<std::size_t>(tests);
  }
  return stream;
}

}  // namespace raygate
