// Light tree: samples one of many lights in proportion to its estimated contribution at a point.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "host/base/triple.h"
#include "host/scene/scene.h"

namespace raygate {

/// Bounds of the position and emission of a light, or of a planar part of a light.
struct LightBounds {
  glm::dvec3 middle{0.0};  ///< of the bounding sphere
  double radius = 0.0;
  /// Emission is full within the angle `spread` of the axis. Farther from the axis, emission falls
  /// off with the cosine of the excess angle, up to an excess of `reach`. Both members are cosines.
  glm::dvec3 axis{0.0, 0.0, 1.0};
  double spread = -1.0, reach = 1.0;
  double back = 0.0;  ///< fraction emitted against the axis
  /// Whether the light is distant: `middle` is the direction towards it, or 0 for all directions.
  bool is_far = false;
  /// Irradiance on a facing surface at distance 1; for a distant light, at any distance. A source
  /// without power is never chosen.
  double power = 0.0;
};

/// Samples a light source for a surface point with a probability nearly proportional to its
/// unoccluded contribution: by power, distance and the orientation of source and surface (Conty
/// Estevez and Kulla, "Importance sampling of many lights with adaptive tree splitting", 2018, but
/// with up to eight children per node instead of splitting). Every source that contributes has a
/// positive probability. All types T give the same bits.
class LightTree {
 public:
  LightTree() = default;
  explicit LightTree(std::span<const LightBounds> sources);

  struct Sample {
    std::uint32_t source = kNoIndex;  ///< kNoIndex: no source contributes
    float pmf = 0.0f;                 ///< probability of the choice
  };
  /// Samples a source for u in [0, 1); some source must have power. A normal of 0 stands for a
  /// surface that is lit from both sides. T determines how many children are weighted at once.
  template <class T>
  [[nodiscard]] RAYGATE_INLINE Sample sample(const glm::vec3& point, const glm::vec3& normal,
                                             double u) const {
    float pmf = 1.0f;
    for (std::uint32_t at = 0;;) {
      const Node& node = nodes_[at];
      alignas(4 * kLanes) float weights[kLanes];
      const float total = importance<T>(node, point, normal, weights);
      if (!(total > 0.0f)) return {};
      // Falls back to the last child with a positive weight if rounding exhausts the others.
      const double wanted = u * double{total};
      double begin = 0.0, end = 0.0;
      int found = 0;
      for (int k = 0; k < kLanes && end <= wanted; ++k) {
        if (!(weights[k] > 0.0f)) continue;
        begin = end;
        end += double{weights[k]};
        found = k;
      }
      constexpr double kBelowOne = 1.0 - 0x1p-53;
      const double rest = (wanted - begin) / double{weights[found]};
      u = rest < kBelowOne ? rest : kBelowOne;
      pmf *= weights[found] / total;
      at = node.child[found];
      if ((at & kIsSource) != 0) return {at & ~kIsSource, pmf};
    }
  }
  /// Returns the probability that sample() chooses a source.
  template <class T>
  [[nodiscard]] RAYGATE_INLINE float pmf(std::uint32_t source, const glm::vec3& point,
                                         const glm::vec3& normal) const {
    if (place_of_[source] == kNoIndex) return 0.0f;
    float pmf = 1.0f;
    std::uint32_t at = place_of_[source] / kLanes, place = place_of_[source] % kLanes;
    while (at != kNoIndex) {
      const Node& node = nodes_[at];
      alignas(4 * kLanes) float weights[kLanes];
      const float total = importance<T>(node, point, normal, weights);
      if (!(weights[place] > 0.0f)) return 0.0f;
      pmf *= weights[place] / total;
      at = node.parent;
      place = node.place;
    }
    return pmf;
  }

 private:
  /// Up to eight sources and clusters, field by field. An empty entry has power 0.
  struct alignas(32) Node {
    float x[kLanes] = {}, y[kLanes] = {}, z[kLanes] = {};  // `middle` of LightBounds
    float nearness[kLanes] = {};                           // 1, or 0 for a distant light
    float squared_radius[kLanes] = {};
    float axis_x[kLanes] = {}, axis_y[kLanes] = {}, axis_z[kLanes] = {};
    float spread[kLanes] = {}, spread_sine[kLanes] = {}, reach[kLanes] = {};
    float back[kLanes] = {};
    float power[kLanes] = {};
    std::uint32_t child[kLanes] = {};  // node index, or source index | kIsSource
    std::uint32_t parent = kNoIndex, place = 0;
  };
  static constexpr std::uint32_t kIsSource = 1u << 31;

  class Builder;

  /// Sets `weights` to the relative importance of each child, and returns their sum.
  template <class T>
  RAYGATE_INLINE static float importance(const Node& node, const glm::vec3& point,
                                         const glm::vec3& normal, float (&weights)[kLanes]) {
    // Error bound of the cosines. It is added to them, so no partly visible light is dropped.
    constexpr float kMargin = 0x1p-10f;
    constexpr float kLeastSquare = 0x1p-40f;
    const T one = spread<T>(1.0f);
    for (int k = 0; k < kLanes; k += kLanesOf<T>) {
      const T nearness = load<T>(node.nearness + k);
      const Triple<T> way = {load<T>(node.x + k) - nearness * point.x,
                             load<T>(node.y + k) - nearness * point.y,
                             load<T>(node.z + k) - nearness * point.z};
      const T squared = dot(way, way), radius = load<T>(node.squared_radius + k);
      const auto is_inside = !(squared > radius);
      const T per_distance = 1.0f / root(choose(squared > 0.0f, squared, one));
      // Sine and cosine of the half angle that the bounding sphere subtends.
      const T ball_sine_squared = choose(is_inside, one, radius * (per_distance * per_distance));
      const T ball_sine = root(ball_sine_squared);
      const T ball_cosine = root(at_least(1.0f - ball_sine_squared, 0.0f));
      // The cosine of an angle minus the sphere's half angle, or 1 if the difference is negative.
      const auto less_ball = [&](const T& cosine, const T& sine) RAYGATE_BODY {
        return choose(is_inside | (cosine > ball_cosine), one,
                      cosine * ball_cosine + sine * ball_sine);
      };
      const auto sine_of = [](const T& cosine) RAYGATE_BODY {
        return root(at_least(1.0f - cosine * cosine, 0.0f));
      };
      const T arriving = dot(way, spread<T>(normal)) * per_distance;
      const T received =
          normal == glm::vec3(0.0f) ? one : less_ball(arriving, sine_of(arriving)) + kMargin;

      const Triple<T> axis = {load<T>(node.axis_x + k), load<T>(node.axis_y + k),
                              load<T>(node.axis_z + k)};
      const T leaving = -dot(way, axis) * per_distance, leaving_sine = sine_of(leaving);
      const T cone_cosine = load<T>(node.spread + k), cone_sine = load<T>(node.spread_sine + k);
      const T reach = load<T>(node.reach + k);
      const auto sent_at = [&](const T& cosine) RAYGATE_BODY {
        const auto is_in_cone = cosine > cone_cosine;
        const T beyond = choose(is_in_cone, one, cosine * cone_cosine + leaving_sine * cone_sine);
        const T sine = choose(is_in_cone, T{}, leaving_sine * cone_cosine - cosine * cone_sine);
        const T sent = less_ball(beyond, sine) + kMargin;
        return choose(sent > reach, sent, T{});
      };
      const T sent = maximum(sent_at(leaving), load<T>(node.back + k) * sent_at(-leaving));
      const T weight = load<T>(node.power + k) * received * sent /
                       at_least(maximum(squared, radius), kLeastSquare);
      store(weights + k, choose(received > 0.0f, weight, T{}));
    }
    float total = 0.0f;
    for (const float weight : weights) total += weight;
    return total;
  }

  std::vector<Node> nodes_;              // the root is first
  std::vector<std::uint32_t> place_of_;  // by source: node index * kLanes + position in the node
};

}  // namespace raygate
