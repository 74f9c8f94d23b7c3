// A ray exactly through the shared edge of a square's two triangles hits exactly one of them.
#include <raygate/raygate.h>

#include <cstdio>

int main() {
  using raygate::Tracer;
  const Tracer::Triangle square[] = {{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}},
                                     {{{0, 0, 0}, {1, 1, 0}, {0, 1, 0}}}};
  const Tracer tracer(square);
  const Tracer::Ray rays[] = {{{0.3f, 0.3f, 2}, {0, 0, -1}}, {{5, 5, 2}, {0, 0, -1}}};
  Tracer::Hit hits[2];
  tracer.nearest(rays, hits);
  for (const Tracer::Hit& hit : hits) {
    if (hit.triangle == Tracer::kNone) {
      std::puts("nothing");
    } else {
      std::printf("triangle %u at t %g\n", hit.triangle, hit.t);
    }
  }
}
