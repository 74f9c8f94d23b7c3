#include "host/light/integrator.h"

#include <algorithm>
#include <numeric>
#include <type_traits>

#include "host/base/vectors.h"
#include "host/light/light_paths.h"
#include "host/scene/instances.h"

namespace raygate {
namespace {

constexpr std::size_t kMostHits = 2048;             // per block; its lists fit into the cache
constexpr std::size_t kFacesAhead = 12;             // prefetch distance
constexpr std::size_t kMostLightSamples = 1 << 16;  // per block: 3 MB

/// Shows diffuse colour times the view's cosine, plus emission. Rays continue through masks' holes.
void shade_primary(const ShadingScene& shading, HitBlock& block, HitKind kind,
                   std::span<const std::uint32_t> at) {
  shade_in_lanes(shading, block, kind, at, []<class T>(Hits<T>& hits) RAYGATE_BODY {
    const T facing = at_least(dot(hits.surface.normal, hits.surface.view), 0.0f);
    const bool is_seen = (hits.kind & kShadowCatcher) == 0;
    const Triple<T> colour = is_seen ? hits.surface.colour : zero<T>();
    const auto are_holes = gather<T>(hits.materials, &MaterialParameters::is_hole);
    hits.set_radiance(choose(are_holes, zero<T>(), colour * facing + hits.emission()));
    if (!any(are_holes)) return;
    ScatteredRays<T> next(hits);
    next.is_wanted = are_holes & next.pass_through(hits, hits.surface.normal);
    next.send(hits, 0);
  });
}

/// Returns ShadingScene::max_depth of `kind`. kPath and kEmitters shade one level deeper than that.
/// kEmitters must stop with the user's integrator, so its limit is one lower unless that is kPath.
int last_depth(IntegratorKind kind, const IntegratorSettings& settings) {
  if (kind == IntegratorKind::kPrimary) return 0;
  const int depth = settings.integrator == IntegratorKind::kPrimary ? 0 : settings.depth();
  const bool is_path = settings.integrator == IntegratorKind::kPath;
  return kind == IntegratorKind::kEmitters && !is_path ? depth - 1 : depth;
}

}  // namespace

Integrator::Integrator(IntegratorKind kind, const PreparedScene& prepared, const Lights& lights,
                       const IntegratorSettings& settings, const LightPaths* light_paths)
    : kind_(kind),
      shading_{.scene = prepared.scene,
               .bvh = prepared.bvh,
               .lights = lights,
               .settings = settings,
               .ambient = is_path()          ? lights.background()
                          : settings.ambient ? glm::vec3(static_cast<float>(*settings.ambient))
                                             : glm::vec3(lights.ambient()),
               .max_depth = last_depth(kind, settings),
               .light_paths = light_paths},
      spawner_(prepared.clearances),
      materials_(prepared.materials),
      has_masks_(std::ranges::any_of(materials_, &MaterialParameters::has_mask)) {
  const bool is_whitted = kind == IntegratorKind::kWhitted;
  const bool splits = is_whitted || kind == IntegratorKind::kEmitters;
  block_.light_samples_per_hit = is_whitted ? lights.count() : is_path() ? 1 : 0;
  block_.scattered_per_hit = splits ? 2 : is_path() || has_masks_ ? 1 : 0;
  block_size_ = std::clamp<std::size_t>(
      kMostLightSamples / std::max<std::size_t>(1, block_.light_samples_per_hit), 1, kMostHits);
  block_.places.resize(block_size_);
  block_.materials.resize(block_size_);
  block_.radiance.resize(block_size_);
  block_.light_samples.resize(block_size_ * block_.light_samples_per_hit);
  block_.scattered.resize(block_size_ * block_.scattered_per_hit);
  kinds_.resize(block_size_);
  query_at_.resize(block_size_);
}

void Integrator::shade(const RayBatch& batch, std::span<const NearestHit> hits, std::size_t begin,
                       std::size_t end, ShadingOutput& output) {
  const std::size_t count = end - begin;
  block_.batch = &batch;
  block_.begin = begin;
  const std::size_t samples = count * block_.light_samples_per_hit;
  for (std::size_t i = 0; i < samples; ++i) block_.light_samples[i].is_asked = 0;
  const std::size_t scattered = count * block_.scattered_per_hit;
  for (std::size_t i = 0; i < scattered; ++i) block_.scattered[i].is_wanted = 0;
  sort(hits, count, output);
  ShadeFunction* const shade_kind = kind_ == IntegratorKind::kPrimary    ? shade_primary
                                    : kind_ == IntegratorKind::kWhitted  ? shade_whitted
                                    : kind_ == IntegratorKind::kLight    ? shade_light_path
                                    : kind_ == IntegratorKind::kEmitters ? shade_emitters
                                                                         : shade_path;
  for (HitKind kind = 0; kind < kHitKinds; ++kind) {
    const std::span<const std::uint32_t> at(order_.data() + first_[kind],
                                            first_[kind + 1] - first_[kind]);
    if (!at.empty()) shade_kind(shading_, block_, kind, at);
  }
  spawn_queries_.clear();
  for (std::size_t i = 0; i < count; ++i) {
    if (kinds_[i] != kHitKinds) list_spawn_queries(i);
  }
  origins_.resize(spawn_queries_.size());
  spawner_.find(spawn_queries_, origins_);
  for (std::size_t i = 0; i < count; ++i) {
    if (kinds_[i] != kHitKinds) output_hit(i, output);
  }
}

/// Sorts the hits of the block by kind, and handles rays without a hit.
void Integrator::sort(std::span<const NearestHit> hits, std::size_t count, ShadingOutput& output) {
  const Scene& scene = shading_.scene;
  const glm::vec3 behind = background();
  const bool is_dark = behind == glm::vec3(0.0f);
  const bool sees_surroundings = sees_environment();
  // Rays of greater depth meet the first surface behind holes.
  const bool may_be_first = kind_ != IntegratorKind::kLight && !output.first_surface.empty() &&
                            (block_.batch->depth == 0 || has_masks_);
  block_.first_surfaces.assign(may_be_first ? count : 0, nullptr);
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
    const bool is_doubtful = !(hit.point_error <= shading_.settings.point_error);
    output.point_doubts += is_doubtful ? 1 : 0;
    const FaceRef stored = shading_.bvh.face_of(hit.primitive);
    const Triangle& face = face_at(scene, stored);
    block_.places[i] = {&block_.batch->rays[block_.begin + i], hit.primitive, &face,
                        is_doubtful ? nullptr : &hit.point, instance_at(scene, stored)};
    const MaterialParameters& material = materials_[face.material];
    const bool is_there =
        !material.has_mask || !is_masked_out(scene, shading_.bvh, block_.places[i]);
    block_.materials[i] = is_there ? &material : &hole_;
    if (is_there && may_be_first) note_first_surface(i, hit, output);
    kinds_[i] = block_.materials[i]->kind | weights_needed(scene, block_.places[i]);
    ++first_[kinds_[i]];
  }
  add_infinite_light(output);
  std::partial_sum(first_.begin(), first_.end(), first_.begin());  // ends of the kinds' ranges
  order_.resize(first_.back());
  for (std::size_t i = count; i-- > 0;) {
    if (kinds_[i] != kHitKinds) order_[--first_[kinds_[i]]] = static_cast<std::uint32_t>(i);
  }
}

/// Records the hit at position i if it is the first surface of its path.
void Integrator::note_first_surface(std::size_t i, const NearestHit& hit, ShadingOutput& output) {
  const PathState& state = block_.state(i);
  FirstSurface& first = output.first_surface[state.sample];
  if (first.primitive != NearestHit::kNone) return;
  block_.first_surfaces[i] = &first;
  first.primitive = hit.primitive;
  if (state.index != 0) return;
  const SurfaceHit& place = block_.places[i];
  first.origin = place.ray->origin;
  first.point = place.point != nullptr
                    ? *place.point
                    : precise_hit(*place.ray, shading_.bvh.corners_of(hit.primitive)).point;
}

/// Adds the environment's radiance along escaped rays. Scattered rays are weighted by MIS if
/// surfaces sample the environment, too.
void Integrator::add_infinite_light(ShadingOutput& output) {
  if (escaped_.empty()) return;
  const Lights& lights = shading_.lights;
  const Environment& environment = *lights.environment();
  const bool is_sampled = kind_ == IntegratorKind::kPath;
  in_vectors([&](auto code) RAYGATE_BODY {
    using T = std::conditional_t<code() == Vectors::kBaseline, float, FloatLanes>;
    constexpr std::size_t kCount = kLanesOf<T>;
    for (std::size_t i = 0; i < escaped_.size(); i += kCount) {
      const std::size_t count = std::min(kCount, escaped_.size() - i);
      const PathState* states[kCount];
      const Ray* rays[kCount];
      float pmfs[kCount] = {};
      for (std::size_t k = 0; k < kCount; ++k) {
        const std::uint32_t place = escaped_[i + std::min(k, count - 1)];
        states[k] = &block_.state(place);
        rays[k] = &block_.batch->rays[block_.begin + place];
        if (is_sampled && states[k]->pdf > 0.0f) {
          pmfs[k] = lights.pmf<T>(lights.environment_source(), states[k]->scattered_at,
                                  states[k]->normal);
        }
      }
      const PathLanes<T> path(states);
      const Triple<T> direction = normalized(gather<T>(rays, &Ray::direction));
      Triple<T> light = path.throughput * environment.radiance(direction);
      if (is_sampled) {
        const T light_pdf = environment.pdf(direction) * load<T>(pmfs);
        light =
            light * choose(path.pdf > 0.0f, power_heuristic(path.pdf, light_pdf), spread<T>(1.0f));
        const auto directions = unpack(direction);
        light = light * gather<T>([&](int k) RAYGATE_BODY {
                  return caustic_weight(*states[k], [&] {
                    return shading_.light_paths->environment_density(states[k]->scattered_at,
                                                                     directions[k]);
                  });
                });
      }
      const auto lights_out = unpack(light);
      for (std::size_t k = 0; k < count; ++k) {
        output.radiance[states[k]->sample] += lights_out[static_cast<int>(k)];
      }
    }
  });
}

/// Drops scattered rays that contribute nothing, and lists spawn queries for the remaining light
/// samples and rays of the hit at position i.
void Integrator::list_spawn_queries(std::size_t i) {
  const SurfaceHit& place = block_.places[i];
  bool any_at[2] = {};  // by side
  for (const LightSample& sample : block_.light_samples_of(i)) {
    if (sample.is_asked != 0) any_at[sample.is_transmitted] = true;
  }
  for (ScatteredRay& scattered : block_.scattered_of(i)) {
    if (scattered.is_wanted == 0) continue;
    if (scattered.state.throughput != glm::vec3(0.0f) && leaves(place, scattered)) {
      any_at[scattered.is_transmitted] = true;
    } else {
      scattered.is_wanted = 0;
    }
  }
  if (any_at[0] || any_at[1]) spawner_.prefetch(place.primitive);
  for (const SpawnSide side : {SpawnSide::kIncident, SpawnSide::kTransmitted}) {
    if (!any_at[static_cast<int>(side)]) continue;
    query_at_[i][static_cast<int>(side)] = static_cast<std::uint32_t>(spawn_queries_.size());
    spawn_queries_.push_back({place.ray, place.primitive, side});
  }
}

/// Returns whether a scattered ray leaves its triangle, if necessary in direction `flat`.
bool Integrator::leaves(const SurfaceHit& place, ScatteredRay& scattered) const {
  const auto leaves = [&](const glm::vec3& direction) {
    return spawner_.leaves(*place.ray, place.primitive, scattered.side(), direction);
  };
  if (scattered.surely_leaves != 0 || leaves(scattered.direction)) return true;
  scattered.direction = scattered.flat;
  scattered.state.light_over_camera_pdf = 0.0f;  // no light path has this direction
  return scattered.has_flat != 0 && leaves(scattered.flat);
}

/// Outputs the results of the hit at position i. Rays to a side without a spawn origin are dropped.
void Integrator::output_hit(std::size_t i, ShadingOutput& output) {
  const std::uint32_t sample = block_.state(i).sample;
  const SurfaceHit& place = block_.places[i];
  output.radiance[sample] += block_.radiance[i];
  for (const LightSample& light : block_.light_samples_of(i)) {
    if (light.is_asked == 0) continue;
    const SpawnOrigin& origin = origins_[query_at_[i][light.is_transmitted]];
    if (!origin) continue;
    ShadowRay& shadow = output.shadows.emplace_back();
    static_cast<LightSample&>(shadow) = light;
    shadow.sample = sample;
    shadow.surface = *origin;
    shadow.surface_primitive = place.primitive;
  }
  for (const ScatteredRay& scattered : block_.scattered_of(i)) {
    if (scattered.is_wanted == 0) continue;
    const SpawnOrigin& origin = origins_[query_at_[i][scattered.is_transmitted]];
    if (!origin) continue;
    output.next.rays.push_back({*origin, scattered.direction});
    output.next.sources.push_back(place.primitive);
    output.next.states.push_back(scattered.state);
  }
}

}  // namespace raygate
