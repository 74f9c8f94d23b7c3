#include "host/light/integrator.h"

#include <algorithm>
#include <optional>

#include "host/light/path.h"
#include "host/light/primary.h"
#include "host/light/whitted.h"

namespace raygate {
namespace {

constexpr std::size_t kMostHits = 2048;          // of a block: its lists stay in the cache
constexpr std::size_t kMostQuestions = 1 << 16;  // of a block: 3 MB

}  // namespace

Integrator::Integrator(const Scene& scene, const Clearances& clearances, const Lights& lights,
                       const Skips& skips, const IntegratorOptions& options,
                       std::size_t questions_each, std::size_t ways_each)
    : shading_{.scene = scene,
               .bvh = clearances.bvh(),
               .lights = lights,
               .ambient = glm::vec3(options.ambient),
               .max_depth = options.max_depth,
               .threshold = static_cast<float>(options.threshold),
               .single_sample = options.single_sample,
               .skips_weightless = skips.weightless},
      departure_(clearances),
      skips_(skips),
      point_error_(options.point_error),
      block_size_(std::clamp<std::size_t>(kMostQuestions / std::max<std::size_t>(1, questions_each),
                                          1, kMostHits)),
      finishes_(finishes_of(scene)) {
  block_.places.resize(block_size_);
  block_.finishes.resize(block_size_);
  block_.radiance.resize(block_size_);
  block_.questions_each = questions_each;
  block_.ways_each = ways_each;
  kinds_.resize(block_size_);
}

void Integrator::shade(const Wave& wave, std::span<const NearestHit> hits, std::size_t begin,
                       std::size_t end, WaveOutput& output) {
  const std::size_t count = end - begin;
  block_.wave = &wave;
  block_.begin = begin;
  block_.first_surfaces = wave.depth == 0 ? output.first_surface.data() : nullptr;
  block_.questions.assign(count * block_.questions_each, {});
  block_.ways.assign(count * block_.ways_each, {});
  sort(hits, count, output);
  for (HitKind kind = 0; kind < kHitKinds; ++kind) {
    const std::span<const std::uint32_t> at(order_.data() + first_[kind],
                                            first_[kind + 1] - first_[kind]);
    if (!at.empty()) shade_kind(block_, kind, at);
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (kinds_[i] != kHitKinds) hand_on(i, output);
  }
}

/// Lists the hits of the block, kind by kind. What hits nothing is done with.
void Integrator::sort(std::span<const NearestHit> hits, std::size_t count, WaveOutput& output) {
  const Scene& scene = shading_.scene;
  first_.assign(kHitKinds + 1, 0);
  for (std::size_t i = 0; i < count; ++i) {
    const NearestHit& hit = hits[block_.begin + i];
    kinds_[i] = kHitKinds;
    if (hit.slot == NearestHit::kNone) {
      const Burden& burden = block_.burden(i);
      output.radiance[burden.sample] += burden.weight * background();
      continue;
    }
    const bool is_doubtful = is_point_doubt(hit, point_error_);
    point_doubts_ += is_doubtful ? 1 : 0;
    const Triangle& face = scene.triangles[shading_.bvh.triangle_of(hit.slot)];
    block_.places[i] = {&block_.wave->rays[block_.begin + i], hit.slot, &face,
                        is_doubtful ? nullptr : &hit.point};
    block_.finishes[i] = &finishes_[face.material];
    kinds_[i] = finishes_[face.material].kind | weights_needed(block_.places[i]);
    ++first_[kinds_[i] + 1];
  }
  for (HitKind kind = 0; kind < kHitKinds; ++kind) first_[kind + 1] += first_[kind];
  order_.resize(first_[kHitKinds]);
  for (std::size_t i = count; i-- > 0;) {
    if (kinds_[i] != kHitKinds) {
      order_[--first_[kinds_[i] + 1]] = static_cast<std::uint32_t>(i);
    }
  }
  first_.erase(first_.begin());
  first_.push_back(static_cast<std::uint32_t>(order_.size()));
}

/// What the hit at place i gives, once it is known where rays go on from.
void Integrator::hand_on(std::size_t i, WaveOutput& output) {
  const Burden& burden = block_.burden(i);
  const HitPlace& place = block_.places[i];
  output.radiance[burden.sample] += block_.radiance[i];
  std::optional<std::optional<glm::vec3>> points[2];
  const auto departure = [&](Departure side) -> const std::optional<glm::vec3>& {
    auto& point = points[side == Departure::kBefore ? 0 : 1];
    if (!point) point = departure_.find(*place.ray, place.slot, side);
    return *point;
  };
  for (std::size_t number = 0; number < block_.questions_each; ++number) {
    const LightQuestion& question = block_.question(i, number);
    if (question.state == LightQuestion::kNotAsked) continue;
    if (question.state == LightQuestion::kBehind && skips_.light_behind) {
      ++skipped_.lights_behind;
      continue;
    }
    const auto& origin = departure(Departure::kBefore);
    if (!origin) continue;
    ShadowRay& shadow = output.shadows.emplace_back();
    shadow.sample = burden.sample;
    shadow.light = question.light;
    shadow.surface = *origin;
    shadow.surface_slot = place.slot;
    if (question.lamp < shading_.lights.points().size()) {
      shadow.point_light = question.lamp;
    } else {
      shadow.lamp = question.place;
      shadow.lamp_slot = question.slot;
    }
  }
  for (std::size_t number = 0; number < block_.ways_each; ++number) {
    const WayOn& way = block_.way(i, number);
    if (!way.is_wanted) continue;
    if (way.burden.weight == glm::vec3(0.0f) && skips_.weightless) {
      ++skipped_.weightless;
      continue;
    }
    const auto leaves = [&](const glm::vec3& scaled) {
      return departure_.leaves(*place.ray, place.slot, way.side, scaled);
    };
    glm::vec3 direction = scaled_direction(glm::dvec3(way.direction));
    if (!leaves(direction)) {
      if (!way.has_flat) continue;
      direction = scaled_direction(glm::dvec3(way.flat));
      if (!leaves(direction)) continue;
    }
    const auto& origin = departure(way.side);
    if (!origin) continue;
    output.next.rays.push_back({*origin, direction});
    Burden& next = output.next.burdens.emplace_back(way.burden);
    next.sample = burden.sample;
    next.index = burden.index;
  }
}

std::unique_ptr<Integrator> make_integrator(IntegratorKind kind, const Scene& scene,
                                            const Clearances& clearances, const Lights& lights,
                                            const Skips& skips, const IntegratorOptions& options) {
  switch (kind) {
    case IntegratorKind::kPrimary:
      return std::make_unique<Primary>(scene, clearances, lights, skips, options);
    case IntegratorKind::kPath:
      return std::make_unique<Path>(scene, clearances, lights, skips, options);
    case IntegratorKind::kWhitted:
      break;
  }
  return std::make_unique<Whitted>(scene, clearances, lights, skips, options);
}

}  // namespace raygate
