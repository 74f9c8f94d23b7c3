// Scattered rays of a path: samples a lobe of the BSDF, then a direction of the lobe.
#pragma once

#include <optional>

#include "host/light/hits.h"
#include "host/light/light_paths.h"
#include "host/light/shade.h"

namespace raygate {

/// Streams of random numbers used at a surface of a path.
namespace streams {
inline constexpr std::uint32_t kNextRay = 1, kChooseLight = 2, kLightPoint = 3, kChooseLobe = 4,
                               kDirection = 5, kFacet = 6, kLens = 9;
}  // namespace streams

// Russian roulette begins after this many surfaces, for paths with less throughput.
inline constexpr int kRouletteDepth = 3;
inline constexpr float kRouletteThroughput = 0.25f;
// Of a direction; the inverse is within the range of float.
inline constexpr float kMinPdf = 1e-20f;

/// Probability of sampling each lobe, in proportion to its albedo. Rough glass is in `scatter`.
template <class T>
struct LobeProbabilities {
  T mirror, transmission, scatter, sum;

  RAYGATE_INLINE explicit LobeProbabilities(const Bsdf<T>& bsdf)
      : mirror(bsdf.has_rough_glass() ? T{} : largest(bsdf.mirror())),
        transmission(bsdf.has_rough_glass() ? T{} : largest(bsdf.transmission())),
        scatter(bsdf.scattered_share()),
        sum(mirror + transmission + scatter) {}
  /// Excludes diffuse and glossy reflection where `is_specular`.
  RAYGATE_INLINE LobeProbabilities(const Bsdf<T>& bsdf, const MaskOf<T>& is_specular)
      : LobeProbabilities(bsdf) {
    scatter = choose(is_specular, T{}, scatter);
    sum = mirror + transmission + scatter;
  }

  /// Returns the probability of diffuse or glossy reflection; 0 if the albedo of all lobes is 0.
  [[nodiscard]] RAYGATE_INLINE T scatter_probability() const {
    return choose(sum > 0.0f, scatter / sum, T{});
  }
};

/// Returns the cosine of a direction with the surface, clamped, as used in ratios of densities.
template <class T>
RAYGATE_INLINE T edge_cosine(const Hits<T>& hits, const Triple<T>& direction) {
  return at_least(absolute(dot(hits.surface.flat_normal, direction)), kLeastCosine);
}

/// Reverse densities of a hit: the ratio of the densities of light paths and camera paths (see
/// LightPaths). Light paths carry flux; their throughput has the cosines of the opposite ends of
/// edges and the adjoint BSDF ("Robust Monte Carlo methods", 5.3).
template <bool kFromLight, class T>
struct ReversePdf {
  T arrived;  ///< PathState::light_over_camera_pdf at the hit
  T in;       ///< cosine of the incoming edge
  MaskOf<T> is_first;

  RAYGATE_INLINE ReversePdf(const ShadingScene& shading, const Hits<T>& hits)
      : in(edge_cosine(hits, hits.surface.view)), is_first(hits.path.is_first()) {
    T ratio = hits.path.light_over_camera_pdf;
    if (!kFromLight) {
      const Triple<T> way =
          (hits.surface.point - hits.path.scattered_at) * spread<T>(shading.lights.per_unit());
      const T seen = shading.light_paths->camera_ratio(-hits.surface.view) * dot(way, way);
      ratio = choose(is_first, seen, ratio);
    }
    arrived = ratio / in;
  }

  /// Updates the ray after diffuse or glossy reflection.
  RAYGATE_INLINE void scatter(const Hits<T>& hits, const Triple<T>& throughput,
                              ScatteredRays<T>& next) const {
    const auto seen = hits.seen_from(next.direction);
    const T back =
        seen.bsdf.pdf(hits.surface.view) * LobeProbabilities<T>(seen.bsdf).scatter_probability();
    const T out = edge_cosine(hits, next.direction);
    const T known = kFromLight ? back : choose(is_first, spread<T>(1.0f), back);
    next.path.light_over_camera_pdf = bounded(arrived * known * (out / next.path.pdf));
    if (!kFromLight) return;
    const T cosine = at_least(dot(seen.normal, hits.surface.view), 0.0f);
    const Triple<T> flux =
        throughput * seen.bsdf.eval(hits.surface.view) * (cosine * out / (in * next.path.pdf));
    next.path.throughput = choose(largest(next.path.throughput) > 0.0f, bounded(flux), zero<T>());
  }

  /// Updates the ray after a mirror or refraction, where `is_specular`; `eta` is 1 for mirrors. A
  /// tilted normal has no reverse path.
  RAYGATE_INLINE void mirror(const Hits<T>& hits, const MaskOf<T>& is_specular, const T& eta,
                             ScatteredRays<T>& next) const {
    const T out = edge_cosine(hits, next.direction);
    const auto has_back = !hits.surface.is_tilted();
    const T ratio = choose(has_back & (kFromLight ? has_back : !is_first), arrived * out, T{});
    next.path.light_over_camera_pdf = choose(is_specular, ratio, next.path.light_over_camera_pdf);
    if (!kFromLight) return;
    const T facing = absolute(dot(hits.surface.normal, hits.surface.view));
    const T leaving = at_least(absolute(dot(hits.surface.normal, next.direction)), kLeastCosine);
    const T scale = out * facing / (in * leaving * eta * eta);
    next.path.throughput =
        choose(is_specular, bounded(next.path.throughput * scale), next.path.throughput);
    next.has_flat = next.has_flat & !is_specular;
    next.is_wanted = next.is_wanted & (has_back | !is_specular);
  }
};

/// Spawns one ray per hit: samples a lobe of the BSDF by its probability, then a direction.
template <bool kFromLight, class T>
RAYGATE_INLINE void sample_scattered_ray(const ShadingScene& shading, Hits<T>& hits,
                                         const LobeProbabilities<T>& lobes) {
  const Surface<T>& surface = hits.surface;
  const Bsdf<T>& bsdf = hits.bsdf;
  const SquarePoint<T> choice = hits.random(streams::kChooseLobe);
  Triple<T> throughput = hits.path.throughput;
  ScatteredRays<T> next(hits);
  next.is_wanted = lobes.sum > 0.0f;
  // Russian roulette precedes the choice of a lobe, so that terminated rays cost nothing.
  if (hits.block.batch->depth >= kRouletteDepth) {
    const T weight =
        kFromLight ? spread<T>(1.0f) : largest(throughput) * (1.0f / kRouletteThroughput);
    const T survival = at_most(weight * lobes.sum, 1.0f);
    next.is_wanted = next.is_wanted & (choice.y < survival);
    throughput = choose(next.is_wanted, throughput * (1.0f / survival), throughput);
  }
  if (!any(next.is_wanted)) return;
  const T u = choice.x * lobes.sum;
  const auto is_mirrored = u < lobes.mirror;
  next.is_transmitted = (!is_mirrored) & (u < lobes.mirror + lobes.transmission);
  next.has_flat = is_mirrored | next.is_transmitted;
  next.path.stream = hash(hits.path.stream, streams::kNextRay);

  const bool has_reverse = kFromLight || shading.light_paths != nullptr;
  std::optional<ReversePdf<kFromLight, T>> reverse;
  if (has_reverse) reverse.emplace(shading, hits);
  const bool has_rough_glass = bsdf.has_rough_glass();
  next.path.scattered_at = surface.point;
  next.path.normal = hits.lit_normal();
  const WordOf<T> none{};
  next.path.specular_history = none;
  next.path.supersampled = choose(next.has_flat, hits.path.supersampled, none);
  next.direction = next.flat = zero<T>();
  if (any(bsdf.scatters())) {
    next.direction = bsdf.sample(hits.random(streams::kDirection),
                                 has_rough_glass ? hits.random(streams::kFacet).x : T{});
    next.flat = next.direction;
    next.path.pdf = bsdf.pdf(next.direction) * lobes.scatter_probability();
    const T cosine = hits.cosine(next.direction);
    const auto contributes = (next.path.pdf > kMinPdf) & (cosine > 0.0f);
    next.path.throughput = choose(
        contributes, bounded(throughput * bsdf.eval(next.direction) * (cosine / next.path.pdf)),
        zero<T>());
    // Light paths do not pass: PathState::light_over_camera_pdf is 0 from here on.
    if (has_rough_glass) {
      if (kFromLight) return;
      next.is_transmitted = dot(surface.normal, next.direction) < 0.0f;
      next.is_wanted = next.is_wanted & contributes;
      next.path.light_over_camera_pdf = T{};
      next.send(hits, 0);
      return;
    }
    if (has_reverse) reverse->scatter(hits, throughput, next);
  }
  if ((hits.kind & kMirrors) != 0) {
    const Triple<T> reflected = reflect(surface.view, surface.normal);
    const Triple<T> reflected_throughput = throughput * bsdf.mirror() * (lobes.sum / lobes.mirror);
    next.direction = choose(is_mirrored, reflected, next.direction);
    next.flat = choose(is_mirrored, reflect(surface.view, surface.flat_normal), next.flat);
    next.path.throughput = choose(is_mirrored, reflected_throughput, next.path.throughput);
    next.path.pdf = choose(is_mirrored, T{}, next.path.pdf);
    next.path.specular_history =
        choose(is_mirrored, hits.path.after_mirror(), next.path.specular_history);
  }
  if ((hits.kind & kTransmits) != 0) {
    const auto is_bent = next.is_transmitted & bsdf.is_refracting();
    const auto is_straight = next.is_transmitted & !bsdf.is_refracting();
    const Refraction<T> bent(surface.view, surface.normal, bsdf.eta());
    const Refraction<T> flat(surface.view, surface.flat_normal, bsdf.eta());
    next.direction = choose(is_bent, bent.direction, next.direction);
    next.flat = choose(is_bent, flat.direction, next.flat);
    next.has_flat = next.has_flat & ((!is_bent) | flat.exists);
    next.is_wanted = next.is_wanted & ((!is_bent) | bent.exists);
    const Triple<T> transmitted_throughput =
        throughput * bsdf.transmission() * (lobes.sum / lobes.transmission);
    next.path.throughput =
        choose(next.is_transmitted, transmitted_throughput, next.path.throughput);
    next.path.pdf = choose(is_bent, T{}, next.path.pdf);
    next.direction = choose(is_straight, -surface.view, next.direction);
    next.flat = choose(is_straight, -surface.view, next.flat);
    next.path.pdf = choose(is_straight, hits.path.pdf, next.path.pdf);
    next.path.scattered_at = choose(is_straight, hits.path.scattered_at, next.path.scattered_at);
    next.path.normal = choose(is_straight, hits.path.normal, next.path.normal);
    next.path.specular_history =
        choose(is_straight, hits.path.specular_history,
               choose(is_bent, hits.path.after_glass(), next.path.specular_history));
  }
  if (has_reverse) {
    const auto is_bent = next.is_transmitted & bsdf.is_refracting();
    const auto is_straight = next.is_transmitted & !bsdf.is_refracting();
    const T eta = choose(is_bent, bsdf.eta(), spread<T>(1.0f));
    reverse->mirror(hits, is_mirrored | is_bent, eta, next);
    next.path.light_over_camera_pdf =
        choose(is_straight, hits.path.light_over_camera_pdf, next.path.light_over_camera_pdf);
  }
  next.send(hits, 0);
}

}  // namespace raygate
