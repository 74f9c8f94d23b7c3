// One thread's share of a render: the samples of a tile, wave by wave.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "host/film/film.h"
#include "host/find/finder.h"
#include "host/light/integrator.h"
#include "host/light/shadow_rays.h"
#include "host/light/wave.h"
#include "host/picture/render_job.h"

namespace raygate {

/// What passes over a pixel leave for the next: what its samples add up to, where there are
/// several.
struct FilmSums {
  std::vector<glm::dvec4> color;
  std::vector<glm::dvec3> albedo;  ///< if the film has it
  std::vector<std::uint8_t>
      lamp_edges;  ///< not 0: find_lamp_edges() says so, from the first pass on
};

/// Renders tiles into a film. All rays of one depth are one wave, and all shadow rays of a depth
/// another: finders like many at once. What a pixel gets does not depend on
/// the tile: each sample's light is added up by itself, depth by depth.
class TileRenderer {
 public:
  TileRenderer(const RenderJob& job, Finder& finder, Film& film, FilmSums& sums);

  /// Traces samples first_sample .. first_sample + count of each pixel. `keep_going` is asked
  /// between waves; when it says no, what was traced is not worth writing, and false is returned.
  [[nodiscard]] bool trace(const PixelRect& tile, int first_sample, int count,
                           const std::function<bool()>& keep_going);

  /// Adds the samples that were traced last to the film.
  void write();

  void add_to(RenderStats& stats) const;

 private:
  /// What a camera ray saw.
  struct Seen {
    std::uint32_t slot = NearestHit::kNone;
    glm::vec3 point{0.0f};  // relative to the eye
    RayWork work;           // of all rays of the sample
  };

  void list_pixels(const PixelRect& tile);
  [[nodiscard]] Ray camera_ray(int x, int y, const Sampler& sampler, std::uint32_t index,
                               std::uint32_t stream) const;
  void make_camera_rays();
  void sharpen_lamps(const PixelRect& tile);
  void trace_wave();
  void trace_shadows();
  void see();
  void count_work(const RayWork& work, std::uint32_t sample);
  void write_channels(std::size_t pixel, std::size_t sample);

  RenderJob job_;
  Finder& finder_;
  Film& film_;
  FilmSums& sums_;
  std::unique_ptr<Integrator> integrator_;
  ShadowRays shadow_rays_;
  RenderStats stats_;
  // Of the samples that were traced last, pixel by pixel.
  struct Pixel {
    int x, y;
    std::size_t index;  // in the film
  };
  std::vector<Pixel> pixels_;
  std::vector<Seen> seen_;  // by sample
  int first_sample_ = 0, count_ = 0;
  bool is_counting_;
  WaveOutput output_;
  std::vector<glm::vec3> from_lamps_;  // by sample: what shadow rays have brought
  std::vector<glm::dvec3> sharpened_;  // by pixel: see sharpen_lamps()
  Wave wave_;
  std::vector<NearestHit> hits_;  // of the wave
  std::vector<RayWork> work_;     // of the wave, if it is counted
};

}  // namespace raygate
