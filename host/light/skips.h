// What is left out because the picture does not need it.
#pragma once

#include <cstdint>

namespace raygate {

/// Which work to leave out. The picture is the same, bit for bit, with any of them off.
struct Skips {
  bool culling = true;         ///< polygons in boxes that a ray does not enter
  bool records = true;         ///< records of polygons that no ray from the origin comes near
  bool light_behind = true;    ///< shadow rays to lights that bring nothing: from behind
  bool weightless = true;      ///< reflected and refracted rays that bring nothing
  bool empty_tiles = true;     ///< camera rays of tiles in which no polygon can be
  bool first_occluder = true;  ///< the search for a nearer occluder than the first one found
  bool divisions = true;       ///< serial unit: planes of polygons that the edges rule out
};

/// What was left out.
struct SkipCounters {
  std::uint64_t culled_tests = 0;   ///< ray against polygon
  std::uint64_t records = 0;        ///< not made of those that the caches have room for
  std::uint64_t lights_behind = 0;  ///< shadow rays
  std::uint64_t weightless = 0;     ///< secondary rays
  std::uint64_t dim = 0;            ///< secondary rays below the threshold: they do count, a little
  std::uint64_t empty_tile_rays = 0;  ///< camera rays
  std::uint64_t first_occluders = 0;  ///< searches ended early

  SkipCounters& operator+=(const SkipCounters& other) {
    culled_tests += other.culled_tests;
    records += other.records;
    lights_behind += other.lights_behind;
    weightless += other.weightless;
    dim += other.dim;
    empty_tile_rays += other.empty_tile_rays;
    first_occluders += other.first_occluders;
    return *this;
  }
};

}  // namespace raygate
