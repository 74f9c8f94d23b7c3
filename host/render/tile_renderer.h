// Tile renderer: renders the samples of a tile, batch by batch, on one thread. The tile's light
// paths add splats anywhere in the film.
#pragma once

#include <array>
#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "host/film/film.h"
#include "host/intersect/intersector.h"
#include "host/light/integrator.h"
#include "host/light/ray_batch.h"
#include "host/light/shadow_rays.h"
#include "host/render/adaptive_sampling.h"
#include "host/render/emitter_supersampler.h"
#include "host/render/render_context.h"

namespace raygate {

/// A contribution at a position of the frame, in pixels from its upper left corner.
struct Splat {
  glm::dvec2 place{0.0};
  glm::dvec3 light{0.0};
};

/// Exact sums of splats, one sum per pixel of a film's window. Each splat is weighted by the
/// density of the pixel's filter. The sums do not depend on the order of the splats.
class SplatLayer {
 public:
  SplatLayer() = default;  ///< a layer without pixels
  SplatLayer(const PixelRect& window, ReconstructionFilter filter);

  void add(std::span<const Splat> splats);

  /// Adds the splats to the sums of a film, and recomputes its means.
  void add_to(Film& film) const;

 private:
  PixelRect window_;
  ReconstructionFilter filter_ = ReconstructionFilter::kBox;
  std::vector<std::array<ExactAccumulator, 3>> sums_;
};

/// Renders tiles into a film. All rays of one depth form a batch, and their shadow rays form
/// another. The light of each path is summed separately, depth by depth, so a pixel does not depend
/// on the choice of tiles.
class TileRenderer {
 public:
  /// `emitter_histories`: by pixel of the film, shared by all tiles; empty: no supersampling.
  TileRenderer(const RenderContext& context, Intersector& intersector, Film& film,
               std::span<HistoryMask> emitter_histories);

  /// Traces the samples of samples_to_trace(). `keep_going` is polled between batches. If it
  /// returns false, this function returns false and the samples are incomplete.
  [[nodiscard]] bool trace(const PixelRect& tile, int end, const std::function<bool()>& keep_going);

  /// Adds the samples of the last trace() to the film.
  void write();
  /// Returns the splats of the last trace(), anywhere in the frame.
  [[nodiscard]] std::span<const Splat> splats() const { return splats_; }

  void add_to(RenderStats& stats) const;

 private:
  void make_camera_rays();
  bool trace_camera_rays(const std::function<bool()>& keep_going);
  bool trace_light_paths(const std::function<bool()>& keep_going);
  bool trace_batch(Integrator& integrator, const std::function<bool()>& keep_going);
  void trace_wave(Integrator& integrator);
  void trace_shadows();
  void write_channels(std::size_t pixel, std::size_t path);

  RenderContext context_;
  Intersector& intersector_;
  Film& film_;
  std::span<HistoryMask> emitter_histories_;
  RenderStats stats_;
  std::optional<EmitterSupersampler> emitter_supersampler_;  // adds to stats_
  Integrator integrator_;
  std::optional<Integrator> light_integrator_;  // for light paths
  ShadowRays shadow_rays_;
  // The samples that were traced last, by pixel.
  std::vector<PixelSamples> pixels_;
  std::size_t paths_ = 0;           // number of paths of all pixels
  std::vector<RayWork> path_work_;  // by path, if counted: work of its rays
  bool is_counting_;
  ShadingOutput output_;
  std::vector<glm::vec3> direct_light_;  // by path: light found by shadow rays
  // Emission added by emitter_supersampler_, by pixel.
  std::vector<std::array<ExactAccumulator, 3>> emitter_sums_;
  PixelRect tile_;
  std::vector<RayWork> pixel_work_;  // by pixel of the tile: work of rays that belong to no path
  RayBatch batch_;
  std::vector<NearestHit> hits_;  // of the batch
  std::vector<RayWork> work_;     // of the batch, if counted
  std::vector<Splat> splats_;
};

}  // namespace raygate
