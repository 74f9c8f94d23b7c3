// libFuzzer target: arbitrary bytes as a table of rays.
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <string>

#include "host/base/input_error.h"
#include "host/trace/ray_table.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const int file = memfd_create("rays", 0);
  static const std::string path = "/proc/self/fd/" + std::to_string(file);
  if (file < 0 || ftruncate(file, 0) != 0 ||
      pwrite(file, data, size, 0) != static_cast<ssize_t>(size)) {
    std::abort();
  }
  try {
    raygate::RayTableReader rays(path, glm::dvec3(1.0, -2.0, 1e6));
    raygate::RayTable block;
    while (rays.read(7, block)) {
      for (const raygate::Ray& ray : block.rays) {
        // Rays that intersectors refuse must not be returned.
        if (raygate::is_usable(ray.direction) && !raygate::is_scaled(ray.direction)) std::abort();
      }
    }
  } catch (const raygate::InputError&) {
    // Expected for invalid tables.
  }
  return 0;
}
