#include "host/render/tile_renderer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "host/base/measure.h"
#include "host/render/tiles.h"

namespace raygate {

SplatLayer::SplatLayer(const PixelRect& window, ReconstructionFilter filter)
    : window_(window), filter_(filter), sums_(window.pixels()) {}

void SplatLayer::add(std::span<const Splat> splats) {
  const double radius = filter_radius(filter_);
  for (const Splat& splat : splats) {
    const glm::dvec2 low = splat.place - radius, high = splat.place + radius;
    // Positions may exceed the range of int.
    const auto pixel = [](double at, int first, int end) {
      return static_cast<int>(std::clamp<double>(at, first, end));
    };
    const int x0 = pixel(std::ceil(low.x - 0.5), window_.x0, window_.x1);
    const int x1 = pixel(std::floor(high.x - 0.5) + 1.0, window_.x0, window_.x1);
    const int y0 = pixel(std::ceil(low.y - 0.5), window_.y0, window_.y1);
    const int y1 = pixel(std::floor(high.y - 0.5) + 1.0, window_.y0, window_.y1);
    for (int y = y0; y < y1; ++y) {
      for (int x = x0; x < x1; ++x) {
        const double weight = filter_density(filter_, splat.place - glm::dvec2(x + 0.5, y + 0.5));
        auto& sum = sums_[window_.index_of(x, y)];
        for (int k = 0; k < 3; ++k) sum[k].add(weight * splat.light[k]);
      }
    }
  }
}

void SplatLayer::add_to(Film& film) const {
  for (std::size_t i = 0; i < sums_.size(); ++i) {
    const std::uint32_t samples = film.sums.samples[i];
    for (std::size_t k = 0; k < 3; ++k) film.sums.color[i][k] += sums_[i][k];
    if (samples != 0) film.color[i] = mean_of(film.sums.color[i], samples);
  }
}

TileRenderer::TileRenderer(const RenderContext& context, Intersector& intersector, Film& film,
                           std::span<HistoryMask> emitter_histories)
    : context_(context),
      intersector_(intersector),
      film_(film),
      emitter_histories_(emitter_histories),
      integrator_(context.settings.integrator, context.prepared, context.lights, context.settings,
                  context.light_paths),
      shadow_rays_(context.prepared, context.lights, intersector,
                   context.settings.integrator != IntegratorKind::kPath),
      is_counting_(!film.tests.empty() || !film.doubts.empty()) {
  if (!emitter_histories.empty()) {
    emitter_supersampler_.emplace(context, intersector, is_counting_, stats_);
  }
  if (context.light_paths == nullptr) return;
  light_integrator_.emplace(IntegratorKind::kLight, context.prepared, context.lights,
                            context.settings, context.light_paths);
}

void TileRenderer::make_camera_rays() {
  batch_.clear();
  batch_.depth = 0;
  for (const PixelSamples& pixel : pixels_) {
    const std::uint32_t key = pixel_key(context_.settings.seed, pixel.x, pixel.y);
    for (int i = pixel.first; i < pixel.end; ++i) {
      const auto index = static_cast<std::uint32_t>(i);
      PathState& state = batch_.states.emplace_back();
      state.sample = static_cast<std::uint32_t>(batch_.rays.size());
      state.stream = key;
      state.index = index;
      if (!emitter_histories_.empty()) state.supersampled = emitter_histories_[pixel.index];
      const Ray& ray = batch_.rays.emplace_back(
          camera_ray(context_, pixel.x, pixel.y, key, index, kFilterStream));
      state.scattered_at = ray.origin;
    }
  }
}

bool TileRenderer::trace(const PixelRect& tile, int end, const std::function<bool()>& keep_going) {
  Stopwatch watch;
  splats_.clear();
  pixels_ = samples_to_trace(context_.settings, film_, tile, end);
  if (pixels_.empty()) return true;
  tile_ = tile;
  pixel_work_.assign(is_counting_ ? tile.pixels() : 0, {});
  const RenderSettings& settings = context_.settings;
  const double margin = 1.0 + (settings.samples > 1 ? filter_radius(settings.filter) : 0.0);
  // If true, camera rays can only meet the background.
  const bool is_empty =
      !integrator_.sees_environment() &&
      !may_see_anything(context_.prepared.bvh, context_.camera, film_, tile_, margin);
  paths_ = 0;
  for (const PixelSamples& pixel : pixels_) paths_ += pixel.path_count();
  path_work_.assign(is_counting_ ? paths_ : 0, {});
  output_.radiance.assign(paths_, is_empty ? integrator_.background() : glm::vec3(0.0f));
  output_.first_surface.assign(paths_, {});
  output_.shadows.clear();
  direct_light_.assign(paths_, glm::vec3(0.0f));
  emitter_sums_.assign(pixels_.size(), {});
  stats_.shade_seconds += watch.lap();
  return (is_empty || trace_camera_rays(keep_going)) && trace_light_paths(keep_going);
}

bool TileRenderer::trace_camera_rays(const std::function<bool()>& keep_going) {
  Stopwatch watch;
  if (emitter_supersampler_ && emitter_histories_[pixels_[0].index] == kUnknownHistories) {
    emitter_supersampler_->find(film_, tile_, emitter_histories_, pixel_work_);
  }
  watch.lap();
  make_camera_rays();
  stats_.camera_rays += paths_;
  stats_.shade_seconds += watch.lap();
  if (!trace_batch(integrator_, keep_going)) return false;
  if (!emitter_supersampler_) return true;
  emitter_supersampler_->supersample(pixels_, emitter_histories_, emitter_sums_, pixel_work_);
  return true;
}

/// Traces the batch and all rays that its hits spawn. Returns false if tracing was stopped.
bool TileRenderer::trace_batch(Integrator& integrator, const std::function<bool()>& keep_going) {
  while (!batch_.rays.empty()) {
    if (!keep_going()) return false;
    trace_wave(integrator);
  }
  return true;
}

/// Traces the light paths of the current samples. Each sample of a pixel has an equal fraction of
/// the frame's light paths, so the result does not depend on how work is distributed. The pixels of
/// a window trace all light paths of the frame.
bool TileRenderer::trace_light_paths(const std::function<bool()>& keep_going) {
  if (!light_integrator_) return true;
  constexpr std::size_t kManyPaths = 1 << 16;  // per batch
  const std::uint64_t paths = context_.light_paths->count(), window = film_.color.size();
  std::size_t camera_path = 0;  // path to which the work is attributed
  batch_.clear();
  for (const PixelSamples& pixel : pixels_) {
    for (int i = pixel.first; i < pixel.end; ++i, ++camera_path) {
      for (std::uint64_t path = pixel.index * paths / window;
           path < (pixel.index + 1) * paths / window; ++path) {
        const auto start = context_.light_paths->start(static_cast<std::uint64_t>(i) * paths + path,
                                                       context_.settings.seed);
        if (!start) continue;
        batch_.rays.push_back(start->ray);
        batch_.states.push_back(start->state);
        batch_.states.back().sample = static_cast<std::uint32_t>(camera_path);
        if (batch_.rays.size() < kManyPaths) continue;
        batch_.depth = 1;
        if (!trace_batch(*light_integrator_, keep_going)) return false;
        batch_.clear();
      }
    }
  }
  batch_.depth = 1;
  return trace_batch(*light_integrator_, keep_going);
}

/// Traces the rays of one depth and the shadow rays from their hits. Many shadow rays are split
/// into several batches. Direct light is summed separately from other light, so the order in which
/// a sample's light is summed does not depend on the batches.
void TileRenderer::trace_wave(Integrator& integrator) {
  constexpr std::size_t kManyShadowRays = 1 << 17;  // per batch: 14 MB of queries
  const std::size_t rays = batch_.rays.size();
  stats_.rays += rays;
  hits_.resize(rays);
  work_.resize(is_counting_ ? rays : 0);
  intersector_.nearest(batch_.rays, query_of(context_, batch_, work_), hits_);
  Stopwatch watch;
  output_.next.clear();
  output_.next.depth = batch_.depth + 1;
  for (std::size_t i = 0; i < work_.size(); ++i) path_work_[batch_.states[i].sample] += work_[i];
  for (std::size_t i = 0; i < rays;) {
    const std::size_t end = std::min(rays, i + integrator.block_size());
    integrator.shade(batch_, hits_, i, end, output_);
    i = end;
    if (output_.shadows.size() < kManyShadowRays && i < rays) continue;
    stats_.shade_seconds += watch.lap();
    trace_shadows();
    watch.lap();
  }
  std::swap(batch_, output_.next);
  stats_.shade_seconds += watch.lap();
}

void TileRenderer::trace_shadows() {
  shadow_rays_.resolve(output_.shadows, path_work_);
  const glm::dvec2 size(context_.settings.width, context_.settings.height);
  for (const ShadowRay& ray : output_.shadows) {
    if (ray.is_to_camera == 0) {
      direct_light_[ray.sample] += ray.radiance;
    } else if (ray.radiance != glm::vec3(0.0f)) {  // a surface seen through a point of the lens
      const auto place = context_.camera.place_of(glm::dvec3(ray.surface), glm::dvec3(ray.target));
      if (place) splats_.push_back({*place * size, glm::dvec3(ray.radiance)});
    }
  }
  output_.shadows.clear();
}

void TileRenderer::write() {
  Stopwatch watch;
  FilmSums& kept = film_.sums;
  const bool has_albedo = !film_.albedo.empty();
  std::size_t i = 0;  // index of a path
  for (std::size_t p = 0; p < pixels_.size(); ++p) {
    const PixelSamples& pixel = pixels_[p];
    const std::size_t at = pixel.index;
    const auto count = [&](const RayWork& work) {
      if (!film_.tests.empty()) add_count(film_.tests[at], work.tests);
      if (!film_.doubts.empty()) add_count(film_.doubts[at], work.doubts);
    };
    if (pixel.first == 0) write_channels(at, i);
    std::array<ExactAccumulator, 4> color{};
    std::array<ExactAccumulator, 3> albedo{};
    if (!kept.color.empty()) color = kept.color[at];
    if (!kept.albedo.empty()) albedo = kept.albedo[at];
    double hits = 0.0;
    for (const std::size_t end = i + pixel.path_count(); i < end; ++i) {
      const FirstSurface& first = output_.first_surface[i];
      const glm::dvec3 light = glm::dvec3(output_.radiance[i]) + glm::dvec3(direct_light_[i]);
      for (int k = 0; k < 3; ++k) {
        color[k].add(light[k]);
        if (has_albedo) albedo[k].add(double{first.albedo[k]});
      }
      if (first.primitive != NearestHit::kNone) hits += 1.0;
      if (is_counting_) count(path_work_[i]);
    }
    color[3].add(hits);
    for (int k = 0; k < 3; ++k) color[k] += emitter_sums_[p][k];
    if (is_counting_) count(pixel_work_[pixel.place]);
    const int samples = pixel.end - context_.settings.first_sample;
    if (!kept.samples.empty()) kept.samples[at] = static_cast<std::uint32_t>(samples);
    if (!kept.color.empty()) kept.color[at] = color;
    if (!kept.albedo.empty()) kept.albedo[at] = albedo;
    film_.color[at] = mean_of(color, samples);
    if (has_albedo) film_.albedo[at] = mean_of(albedo, samples);
  }
  for (const PixelSamples& pixel : pixels_) {
    const bool is_first = pixel.x % kErrorBlock == 0 && pixel.y % kErrorBlock == 0;
    if (context_.settings.error > 0.0 && is_first && is_error_check(pixel.end)) {
      update_block_error(film_, pixel.x, pixel.y, context_.settings.exposure);
    }
  }
  stats_.shade_seconds += watch.lap();
}

/// Writes the channels that hold values of the first sample only.
void TileRenderer::write_channels(std::size_t pixel, std::size_t sample) {
  const FirstSurface& first = output_.first_surface[sample];
  if (first.primitive == NearestHit::kNone) return;
  const std::uint32_t triangle = context_.prepared.bvh.triangle_of(first.primitive);
  const glm::dvec3 origin(first.origin), point(first.point);
  const glm::dvec3 from_eye = origin - glm::dvec3(context_.camera.eye()) + point;
  film_.depth[pixel] = static_cast<float>(glm::dot(from_eye, context_.camera.forward()));
  film_.normal[pixel] = first.normal;
  film_.primitive[pixel] = triangle;
  if (!film_.position.empty()) {
    film_.position[pixel] = glm::vec3(context_.prepared.scene.origin + origin + point);
  }
  if (!film_.object.empty()) {
    film_.object[pixel] =
        object_at(context_.prepared.scene, context_.prepared.bvh.face_of(first.primitive));
  }
}

void TileRenderer::add_to(RenderStats& stats) const {
  const std::uint64_t shadow_rays = shadow_rays_.rays();
  stats.rays += stats_.rays + shadow_rays;
  stats.camera_rays += stats_.camera_rays;
  stats.shadow_rays += shadow_rays;
  stats.point_doubts += stats_.point_doubts + output_.point_doubts;
  stats.intersect += intersector_.counters();
  stats.shade_seconds += stats_.shade_seconds;
}

}  // namespace raygate
