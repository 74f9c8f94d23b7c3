#include "host/render/emitter_supersampler.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "host/base/measure.h"
#include "host/render/tiles.h"

namespace raygate {
namespace {

constexpr int kRaysPerSample = 8;
constexpr std::size_t kManyRays = 1 << 11;   // per batch
constexpr float kLeastShare = 1.0f / 64.0f;  // of the brightest emitter's radiance

constexpr HistoryMask kDirect = 1u << 1, kAllHistories = ~1u;

template <class Visit>
void for_each(HistoryMask histories, const Visit& visit) {
  for (; histories != 0; histories &= histories - 1) {
    visit(static_cast<std::uint32_t>(std::countr_zero(histories)));
  }
}

HistoryMask with_prefixes(HistoryMask histories) {
  HistoryMask all = histories;
  for_each(histories, [&](std::uint32_t history) {
    for (; history != 0; history /= 2) all |= 1u << history;
  });
  return all;
}

}  // namespace

EmitterSupersampler::EmitterSupersampler(const RenderContext& context, Intersector& intersector,
                                         bool counts_work, RenderStats& stats)
    : context_(context),
      intersector_(intersector),
      integrator_(IntegratorKind::kEmitters, context.prepared, context.lights, context.settings),
      counts_work_(counts_work),
      all_(kDirect),
      stats_(stats) {
  // Whitted images have few samples, so finding more histories would cost more than it saves.
  if (context.settings.integrator == IntegratorKind::kPath &&
      std::ranges::any_of(context.prepared.materials, &MaterialParameters::is_mirror_or_glass)) {
    all_ = kAllHistories;
  }
  for (const AreaLight& light : context.lights.areas()) {
    least_ = std::max(least_, kLeastShare * largest(glm::vec3(light.radiance)));
  }
}

void EmitterSupersampler::add(const Ray& ray, HistoryMask histories) {
  PathState& state = batch_.states.emplace_back();
  state.sample =
      static_cast<std::uint32_t>(batch_.rays.size() * kSpecularHistories + state.specular_history);
  state.supersampled = with_prefixes(histories);
  batch_.rays.push_back(ray);
}

/// Traces and shades all rays that were added.
void EmitterSupersampler::trace() {
  const std::size_t count = batch_.rays.size();
  output_.radiance.assign(count * kSpecularHistories, glm::vec3(0.0f));
  ray_work_.assign(counts_work_ ? count : 0, {});
  stats_.camera_rays += count;
  Stopwatch watch;
  for (batch_.depth = 0; !batch_.rays.empty(); std::swap(batch_, output_.next)) {
    const std::size_t rays = batch_.rays.size();
    stats_.rays += rays;
    hits_.resize(rays);
    work_.resize(counts_work_ ? rays : 0);
    intersector_.nearest(batch_.rays, query_of(context_, batch_, work_), hits_);
    watch.lap();
    for (std::size_t i = 0; i < work_.size(); ++i) {
      ray_work_[batch_.states[i].sample / kSpecularHistories] += work_[i];
    }
    output_.next.clear();
    output_.next.depth = batch_.depth + 1;
    for (std::size_t i = 0; i < rays; i += integrator_.block_size()) {
      integrator_.shade(batch_, hits_, i, std::min(rays, i + integrator_.block_size()), output_);
    }
    stats_.point_doubts += std::exchange(output_.point_doubts, 0);
    stats_.shade_seconds += watch.lap();
  }
}

void EmitterSupersampler::find(const Film& film, const PixelRect& tile,
                               std::span<HistoryMask> histories, std::span<RayWork> work) {
  // Corners are used up to this number of pixels beyond the tile.
  const int beyond = static_cast<int>(std::ceil(filter_radius(context_.settings.filter) - 0.5));
  const auto may_see = [&](const AreaLight& light) {
    return may_see_box(light.low, light.high, context_.camera, film, tile, beyond + 1.0);
  };
  if (all_ == kDirect && std::ranges::none_of(context_.lights.areas(), may_see)) {
    for (int y = tile.y0; y < tile.y1; ++y) {
      const auto row = histories.subspan(film.index_of(tile.x0, y), std::size_t(tile.width()));
      std::ranges::fill(row, 0);
    }
    return;
  }
  const PixelRect corners{tile.x0 - beyond, tile.y0 - beyond, tile.x1 + 1 + beyond,
                          tile.y1 + 1 + beyond};
  batch_.clear();
  for (int y = corners.y0; y < corners.y1; ++y) {
    for (int x = corners.x0; x < corners.x1; ++x) {
      add(context_.camera.ray(double(x) / film.width, double(y) / film.height, {}), all_);
    }
  }
  trace();
  for (std::size_t i = 0; i < ray_work_.size(); ++i) {  // count a ray's work at the nearest pixel
    const int x = corners.x0 + static_cast<int>(i % std::size_t(corners.width()));
    const int y = corners.y0 + static_cast<int>(i / std::size_t(corners.width()));
    work[tile.index_of(std::clamp(x, tile.x0, tile.x1 - 1), std::clamp(y, tile.y0, tile.y1 - 1))] +=
        ray_work_[i];
  }
  std::vector<HistoryMask> seen(corners.pixels());  // by corner
  for (std::size_t i = 0; i < seen.size(); ++i) {
    for_each(all_, [&](std::uint32_t history) {
      if (largest(radiance(i, history)) >= least_) seen[i] |= 1u << history;
    });
  }
  for (int y = tile.y0; y < tile.y1; ++y) {
    for (int x = tile.x0; x < tile.x1; ++x) {
      const auto for_corners = [&](const auto& visit) {
        for (int row = y - beyond; row <= y + 1 + beyond; ++row) {
          const std::size_t first = corners.index_of(x - beyond, row);
          for (int i = 0; i < 2 + 2 * beyond; ++i) visit(first + std::size_t(i));
        }
      };
      HistoryMask near = 0, different = 0;
      for_corners([&](std::size_t at) { near |= seen[at]; });
      for_each(near, [&](std::uint32_t history) {
        const glm::vec3& first = radiance(corners.index_of(x - beyond, y - beyond), history);
        for_corners([&](std::size_t at) {
          if (radiance(at, history) != first) different |= 1u << history;
        });
      });
      histories[film.index_of(x, y)] = different;
    }
  }
}

void EmitterSupersampler::supersample(std::span<const PixelSamples> pixels,
                                      std::span<const HistoryMask> histories,
                                      std::span<std::array<ExactAccumulator, 3>> sums,
                                      std::span<RayWork> work) {
  std::vector<std::size_t> pixel_of;
  const auto trace_them = [&] {
    trace();
    for (std::size_t i = 0; i < pixel_of.size(); ++i) {
      for_each(histories[pixels[pixel_of[i]].index], [&](std::uint32_t history) {
        const glm::dvec3 light(radiance(i, history));
        for (int k = 0; k < 3; ++k) sums[pixel_of[i]][k].add(light[k] / kRaysPerSample);
      });
      if (counts_work_) work[pixels[pixel_of[i]].place] += ray_work_[i];
    }
    batch_.clear();
    pixel_of.clear();
  };
  batch_.clear();
  for (std::size_t p = 0; p < pixels.size(); ++p) {
    const PixelSamples& pixel = pixels[p];
    if (histories[pixel.index] == 0) continue;
    const std::uint32_t key = pixel_key(context_.settings.seed, pixel.x, pixel.y);
    for (int i = pixel.first * kRaysPerSample; i < pixel.end * kRaysPerSample; ++i) {
      add(camera_ray(context_, pixel.x, pixel.y, key, static_cast<std::uint32_t>(i),
                     kEmitterStream),
          histories[pixel.index]);
      pixel_of.push_back(p);
      if (pixel_of.size() == kManyRays) trace_them();
    }
  }
  trace_them();
}

}  // namespace raygate
