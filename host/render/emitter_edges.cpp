#include "host/render/emitter_edges.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "host/render/tile_frustum.h"

namespace raygate {

std::size_t find_emitter_edges(const RenderJob& job, Intersector& intersector, const Film& film,
                               const PixelRect& tile, std::span<EmitterEdge> is_edge,
                               std::span<RayWork> work) {
  // Corners of pixels, up to so many beyond the tile's own.
  const int beyond = static_cast<int>(std::ceil(filter_radius(job.options.filter) - 0.5));
  const auto may_see = [&](const AreaLight& light) {
    return may_see_box(light.low, light.high, job.camera, film, tile, beyond + 1.0);
  };
  if (std::ranges::none_of(job.lights.areas(), may_see)) {
    for (int y = tile.y0; y < tile.y1; ++y) {
      const auto row = is_edge.subspan(film.index_of(tile.x0, y), std::size_t(tile.width()));
      std::ranges::fill(row, EmitterEdge::kNo);
    }
    return 0;
  }
  const int columns = tile.width() + 1 + 2 * beyond, rows = tile.height() + 1 + 2 * beyond;
  std::vector<Ray> rays;
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      rays.push_back(job.camera.ray(double(tile.x0 - beyond + x) / film.width,
                                    double(tile.y0 - beyond + y) / film.height, {}));
    }
  }
  std::vector<NearestHit> hits(rays.size());
  std::vector<RayWork> of_rays(work.empty() ? 0 : rays.size());
  intersector.intersect(rays,
                        {.common_origin = job.camera.has_common_origin(),
                         .culling = job.options.skips.culling,
                         .work = of_rays},
                        hits);
  for (std::size_t i = 0; i < of_rays.size(); ++i) {  // to the nearest pixel
    const int x = static_cast<int>(i % std::size_t(columns)) - beyond;
    const int y = static_cast<int>(i / std::size_t(columns)) - beyond;
    const int column = std::clamp(x, 0, tile.width() - 1);
    const int row = std::clamp(y, 0, tile.height() - 1);
    work[std::size_t(row) * std::size_t(tile.width()) + std::size_t(column)] += of_rays[i];
  }
  const auto emission_at = [&](int x, int y) {
    return job.emission_of(hits[std::size_t(y) * std::size_t(columns) + std::size_t(x)].primitive);
  };
  for (int y = 0; y < tile.height(); ++y) {
    for (int x = 0; x < tile.width(); ++x) {
      const glm::vec3 first = emission_at(x, y);
      bool is_one = true;
      for (int dy = 0; dy <= 1 + 2 * beyond && is_one; ++dy) {
        for (int dx = 0; dx <= 1 + 2 * beyond && is_one; ++dx) {
          is_one = emission_at(x + dx, y + dy) == first;
        }
      }
      is_edge[film.index_of(tile.x0 + x, tile.y0 + y)] =
          is_one ? EmitterEdge::kNo : EmitterEdge::kYes;
    }
  }
  return rays.size();
}

}  // namespace raygate
