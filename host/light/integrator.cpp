#include "host/light/integrator.h"

#include <algorithm>

#include "host/light/escapes.h"
#include "host/light/path.h"
#include "host/light/primary.h"
#include "host/light/whitted.h"
#include "host/scene/instance_transform.h"

namespace raygate {
namespace {

constexpr std::size_t kMostHits = 2048;          // of a block: its lists stay in the cache
constexpr std::size_t kFacesAhead = 12;          // to fetch
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
               .skips_weightless = skips.weightless,
               .techniques = options.techniques},
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
  block_.questions.resize(count * block_.questions_each);
  block_.ways.resize(count * block_.ways_each);
  for (LightQuestion& question : block_.questions) question.state = LightQuestion::kNotAsked;
  for (WayOn& way : block_.ways) way.is_wanted = false;
  sort(hits, count, output);
  for (HitKind kind = 0; kind < kHitKinds; ++kind) {
    const std::span<const std::uint32_t> at(order_.data() + first_[kind],
                                            first_[kind + 1] - first_[kind]);
    if (!at.empty()) shade_kind(block_, kind, at);
  }
  departures_.clear();
  for (std::size_t i = 0; i < count; ++i) {
    if (kinds_[i] != kHitKinds) choose_departures(i);
  }
  origins_.resize(departures_.size());
  departure_.find(departures_, origins_);
  const DepartureOrigin* origins = origins_.data();
  for (std::size_t i = 0; i < count; ++i) {
    if (kinds_[i] != kHitKinds) hand_on(i, origins, output);
  }
}

/// Lists the hits of the block, kind by kind. What hits nothing is done with.
void Integrator::sort(std::span<const NearestHit> hits, std::size_t count, WaveOutput& output) {
  const Scene& scene = shading_.scene;
  const glm::vec3 behind = background();
  const bool is_dark = behind == glm::vec3(0.0f);
  const bool sees_surroundings = sees_environment();
  escaped_.clear();
  first_.assign(kHitKinds + 1, 0);
  for (std::size_t i = 0; i < count; ++i) {
    const NearestHit& hit = hits[block_.begin + i];
    const std::uint32_t soon = hits[block_.begin + std::min(i + kFacesAhead, count - 1)].slot;
    if (soon != NearestHit::kNone) {
      __builtin_prefetch(&face_at(scene, shading_.bvh.face_of(soon)).material);
    }
    kinds_[i] = kHitKinds;
    if (hit.slot == NearestHit::kNone && sees_surroundings) {
      escaped_.push_back(static_cast<std::uint32_t>(i));
      continue;
    }
    if (hit.slot == NearestHit::kNone) {
      if (is_dark) continue;
      const Burden& burden = block_.burden(i);
      output.radiance[burden.sample] += burden.weight * behind;
      continue;
    }
    const bool is_doubtful = is_point_doubt(hit, point_error_);
    point_doubts_ += is_doubtful ? 1 : 0;
    const FaceRef stored = shading_.bvh.face_of(hit.slot);
    const Triangle& face = face_at(scene, stored);
    block_.places[i] = {&block_.wave->rays[block_.begin + i], hit.slot, &face,
                        is_doubtful ? nullptr : &hit.point, instance_at(scene, stored)};
    const Finish& finish = finishes_[face.material];
    const bool is_there = !finish.has_mask || !is_masked_out(scene, shading_.bvh, block_.places[i]);
    block_.finishes[i] = is_there ? &finish : &nothing_;
    kinds_[i] = block_.finishes[i]->kind | weights_needed(block_.places[i]);
    ++first_[kinds_[i] + 1];
  }
  if (!escaped_.empty()) {
    add_environment(shading_, block_, escaped_, shading_.asks_environment, output);
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

/// Forgets what is not worth asking, and notes on which sides of the hit at place i rays begin.
void Integrator::choose_departures(std::size_t i) {
  const HitPlace& place = block_.places[i];
  bool is_before = false, is_after = false;
  for (std::size_t number = 0; number < block_.questions_each; ++number) {
    LightQuestion& question = block_.question(i, number);
    if (question.state == LightQuestion::kBehind && skips_.light_behind) {
      ++skipped_.lights_behind;
      question.state = LightQuestion::kNotAsked;
    }
    is_before = is_before || question.state != LightQuestion::kNotAsked;
  }
  for (std::size_t number = 0; number < block_.ways_each; ++number) {
    WayOn& way = block_.way(i, number);
    if (!way.is_wanted) continue;
    if (way.burden.weight == glm::vec3(0.0f) && skips_.weightless) {
      ++skipped_.weightless;
      way.is_wanted = false;
      continue;
    }
    way.is_wanted = leaves(place, way);
    (way.side == Departure::kBefore ? is_before : is_after) |= way.is_wanted;
  }
  if (is_before || is_after) departure_.prefetch(place.slot);
  if (is_before) departures_.push_back({place.ray, place.slot, Departure::kBefore});
  if (is_after) departures_.push_back({place.ray, place.slot, Departure::kAfter});
}

/// Whether a way leads away from its triangle, if need be along the flat normal's direction.
bool Integrator::leaves(const HitPlace& place, WayOn& way) const {
  const auto leaves = [&](const glm::vec3& direction) {
    return departure_.leaves(*place.ray, place.slot, way.side, direction);
  };
  if (way.surely_leaves || leaves(way.direction)) return true;
  way.direction = way.flat;
  return way.has_flat && leaves(way.flat);
}

/// What the hit at place i gives, now that it is known where rays go on from: `origins` of its
/// departures and those of the hits after it. A hit without one on a side sends nothing there.
void Integrator::hand_on(std::size_t i, const DepartureOrigin*& origins, WaveOutput& output) {
  const Burden& burden = block_.burden(i);
  const HitPlace& place = block_.places[i];
  output.radiance[burden.sample] += block_.radiance[i];
  const DepartureOrigin* points[2] = {nullptr, nullptr};
  const auto departure = [&](Departure side) -> const DepartureOrigin& {
    return *points[side == Departure::kBefore ? 0 : 1];
  };
  const auto* const end = departures_.data() + departures_.size();
  for (const auto* asked = departures_.data() + (origins - origins_.data());
       asked != end && asked->ray == place.ray; ++asked) {
    points[asked->way == Departure::kBefore ? 0 : 1] = origins++;
  }
  for (std::size_t number = 0; number < block_.questions_each; ++number) {
    const LightQuestion& question = block_.question(i, number);
    if (question.state == LightQuestion::kNotAsked) continue;
    const auto& origin = departure(Departure::kBefore);
    if (!origin) continue;
    ShadowRay& shadow = output.shadows.emplace_back();
    shadow.sample = burden.sample;
    shadow.light = question.light;
    shadow.surface = *origin;
    shadow.surface_slot = place.slot;
    if (shading_.lights.lamp(question.lamp).kind == Lights::Kind::kPoint) {
      shadow.point_light = question.lamp;
    } else {
      shadow.lamp = question.place;
      shadow.lamp_slot = question.slot;
    }
  }
  for (std::size_t number = 0; number < block_.ways_each; ++number) {
    const WayOn& way = block_.way(i, number);
    if (!way.is_wanted) continue;
    const auto& origin = departure(way.side);
    if (!origin) continue;
    Ray& ray = output.next.rays.emplace_back();
    ray.origin = *origin;
    ray.direction = way.direction;
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
