#include "host/light/integrator.h"

#include <algorithm>

#include "host/light/infinite_light.h"
#include "host/light/path.h"
#include "host/light/primary.h"
#include "host/light/whitted.h"
#include "host/scene/instances.h"

namespace raygate {
namespace {

constexpr std::size_t kMostHits = 2048;             // of a block: its lists stay in the cache
constexpr std::size_t kFacesAhead = 12;             // to fetch
constexpr std::size_t kMostLightSamples = 1 << 16;  // of a block: 3 MB

}  // namespace

Integrator::Integrator(const Scene& scene, const NeighborClearances& clearances,
                       const Lights& lights, const Skips& skips, const IntegratorOptions& options,
                       std::size_t light_samples_per_hit, std::size_t scattered_per_hit)
    : shading_{.scene = scene,
               .bvh = clearances.bvh(),
               .lights = lights,
               .ambient = glm::vec3(options.ambient),
               .max_depth = options.max_depth,
               .threshold = static_cast<float>(options.threshold),
               .single_sample = options.single_sample,
               .skips_weightless = skips.weightless,
               .path = options.path},
      spawner_(clearances),
      skips_(skips),
      point_error_(options.point_error),
      block_size_(std::clamp<std::size_t>(
          kMostLightSamples / std::max<std::size_t>(1, light_samples_per_hit), 1, kMostHits)),
      materials_(material_parameters(scene)) {
  block_.places.resize(block_size_);
  block_.materials.resize(block_size_);
  block_.radiance.resize(block_size_);
  block_.light_samples_per_hit = light_samples_per_hit;
  block_.scattered_per_hit = scattered_per_hit;
  kinds_.resize(block_size_);
}

void Integrator::shade(const RayBatch& batch, std::span<const NearestHit> hits, std::size_t begin,
                       std::size_t end, ShadingOutput& output) {
  const std::size_t count = end - begin;
  block_.batch = &batch;
  block_.begin = begin;
  block_.first_surfaces = batch.depth == 0 ? output.first_surface.data() : nullptr;
  block_.light_samples.resize(count * block_.light_samples_per_hit);
  block_.scattered.resize(count * block_.scattered_per_hit);
  for (LightSample& light_sample : block_.light_samples) light_sample.state = LightSample::kNone;
  for (ScatteredRay& scattered : block_.scattered) scattered.is_wanted = false;
  sort(hits, count, output);
  for (HitKind kind = 0; kind < kHitKinds; ++kind) {
    const std::span<const std::uint32_t> at(order_.data() + first_[kind],
                                            first_[kind + 1] - first_[kind]);
    if (!at.empty()) shade_kind(block_, kind, at);
  }
  spawn_queries_.clear();
  for (std::size_t i = 0; i < count; ++i) {
    if (kinds_[i] != kHitKinds) list_spawn_queries(i);
  }
  origins_.resize(spawn_queries_.size());
  spawner_.find(spawn_queries_, origins_);
  const SpawnOrigin* origins = origins_.data();
  for (std::size_t i = 0; i < count; ++i) {
    if (kinds_[i] != kHitKinds) hand_on(i, origins, output);
  }
}

/// Lists the hits of the block, kind by kind. What hits nothing is done with.
void Integrator::sort(std::span<const NearestHit> hits, std::size_t count, ShadingOutput& output) {
  const Scene& scene = shading_.scene;
  const glm::vec3 behind = background();
  const bool is_dark = behind == glm::vec3(0.0f);
  const bool sees_surroundings = sees_environment();
  escaped_.clear();
  first_.assign(kHitKinds + 1, 0);
  for (std::size_t i = 0; i < count; ++i) {
    const NearestHit& hit = hits[block_.begin + i];
    const std::uint32_t soon = hits[block_.begin + std::min(i + kFacesAhead, count - 1)].primitive;
    if (soon != NearestHit::kNone) {
      __builtin_prefetch(&face_at(scene, shading_.bvh.face_of(soon)).material);
    }
    kinds_[i] = kHitKinds;
    if (hit.primitive == NearestHit::kNone && sees_surroundings) {
      escaped_.push_back(static_cast<std::uint32_t>(i));
      continue;
    }
    if (hit.primitive == NearestHit::kNone) {
      if (is_dark) continue;
      const PathState& state = block_.state(i);
      output.radiance[state.sample] += state.throughput * behind;
      continue;
    }
    const bool is_doubtful = is_point_doubt(hit, point_error_);
    point_doubts_ += is_doubtful ? 1 : 0;
    const FaceRef stored = shading_.bvh.face_of(hit.primitive);
    const Triangle& face = face_at(scene, stored);
    block_.places[i] = {&block_.batch->rays[block_.begin + i], hit.primitive, &face,
                        is_doubtful ? nullptr : &hit.point, instance_at(scene, stored)};
    const MaterialParameters& material = materials_[face.material];
    const bool is_there =
        !material.has_mask || !is_masked_out(scene, shading_.bvh, block_.places[i]);
    block_.materials[i] = is_there ? &material : &transparent_;
    kinds_[i] = block_.materials[i]->kind | weights_needed(block_.places[i]);
    ++first_[kinds_[i] + 1];
  }
  if (!escaped_.empty()) {
    add_infinite_light(shading_, block_, escaped_, shading_.samples_environment, output);
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
void Integrator::list_spawn_queries(std::size_t i) {
  const SurfaceHit& place = block_.places[i];
  bool is_before = false, is_after = false;
  for (std::size_t number = 0; number < block_.light_samples_per_hit; ++number) {
    LightSample& light_sample = block_.light_sample(i, number);
    if (light_sample.state == LightSample::kDark && skips_.light_behind) {
      ++skipped_.lights_behind;
      light_sample.state = LightSample::kNone;
    }
    is_before = is_before || light_sample.state != LightSample::kNone;
  }
  for (std::size_t number = 0; number < block_.scattered_per_hit; ++number) {
    ScatteredRay& scattered = block_.scattered_ray(i, number);
    if (!scattered.is_wanted) continue;
    if (scattered.state.throughput == glm::vec3(0.0f) && skips_.weightless) {
      ++skipped_.weightless;
      scattered.is_wanted = false;
      continue;
    }
    scattered.is_wanted = leaves(place, scattered);
    (scattered.side == SpawnSide::kIncident ? is_before : is_after) |= scattered.is_wanted;
  }
  if (is_before || is_after) spawner_.prefetch(place.primitive);
  if (is_before) spawn_queries_.push_back({place.ray, place.primitive, SpawnSide::kIncident});
  if (is_after) spawn_queries_.push_back({place.ray, place.primitive, SpawnSide::kTransmitted});
}

/// Whether a scattered ray leads away from its triangle, if need be along the flat normal's
/// direction.
bool Integrator::leaves(const SurfaceHit& place, ScatteredRay& scattered) const {
  const auto leaves = [&](const glm::vec3& direction) {
    return spawner_.leaves(*place.ray, place.primitive, scattered.side, direction);
  };
  if (scattered.surely_leaves || leaves(scattered.direction)) return true;
  scattered.direction = scattered.flat;
  return scattered.has_flat && leaves(scattered.flat);
}

/// What the hit at place i gives, now that it is known where rays go on from: `origins` of its
/// departures and those of the hits after it. A hit without one on a side sends nothing there.
void Integrator::hand_on(std::size_t i, const SpawnOrigin*& origins, ShadingOutput& output) {
  const PathState& state = block_.state(i);
  const SurfaceHit& place = block_.places[i];
  output.radiance[state.sample] += block_.radiance[i];
  const SpawnOrigin* points[2] = {nullptr, nullptr};
  const auto departure = [&](SpawnSide side) -> const SpawnOrigin& {
    return *points[side == SpawnSide::kIncident ? 0 : 1];
  };
  const auto* const end = spawn_queries_.data() + spawn_queries_.size();
  for (const auto* asked = spawn_queries_.data() + (origins - origins_.data());
       asked != end && asked->ray == place.ray; ++asked) {
    points[asked->side == SpawnSide::kIncident ? 0 : 1] = origins++;
  }
  for (std::size_t number = 0; number < block_.light_samples_per_hit; ++number) {
    const LightSample& light_sample = block_.light_sample(i, number);
    if (light_sample.state == LightSample::kNone) continue;
    const auto& origin = departure(SpawnSide::kIncident);
    if (!origin) continue;
    ShadowRay& shadow = output.shadows.emplace_back();
    shadow.sample = state.sample;
    shadow.radiance = light_sample.radiance;
    shadow.surface = *origin;
    shadow.surface_slot = place.primitive;
    if (shading_.lights.light(light_sample.light_index).kind == Lights::Kind::kPoint) {
      shadow.point_light = light_sample.light_index;
    } else {
      shadow.target = light_sample.point;
      shadow.target_slot = light_sample.primitive;
    }
  }
  for (std::size_t number = 0; number < block_.scattered_per_hit; ++number) {
    const ScatteredRay& scattered = block_.scattered_ray(i, number);
    if (!scattered.is_wanted) continue;
    const auto& origin = departure(scattered.side);
    if (!origin) continue;
    Ray& ray = output.next.rays.emplace_back();
    ray.origin = *origin;
    ray.direction = scattered.direction;
    PathState& next = output.next.states.emplace_back(scattered.state);
    next.sample = state.sample;
    next.index = state.index;
  }
}

std::unique_ptr<Integrator> make_integrator(IntegratorKind kind, const Scene& scene,
                                            const NeighborClearances& clearances,
                                            const Lights& lights, const Skips& skips,
                                            const IntegratorOptions& options) {
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
