// Closed meshes, and the suites of hard cases.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "host/bvh/bvh.h"
#include "host/exact/test/meshes.h"
#include "host/lab/stress/cases.h"
#include "host/light/spawn_ray.h"
#include "host/scene/camera.h"

namespace raygate::lab {

glm::dvec3 Random::rounded(const glm::dvec3& p, bool to_binary64) {
  if (!to_binary64) return glm::dvec3(glm::vec3(p));
  return {on_float_grid(p.x), on_float_grid(p.y), on_float_grid(p.z)};
}

namespace {

MeshPointer placed(Mesh mesh, const Placement& placement) {
  for (Corners& triangle : mesh) {
    for (glm::dvec3& p : triangle) {
      p = Random::rounded(p * placement.scale + placement.shift, placement.binary64);
    }
  }
  return std::make_shared<const Mesh>(std::move(mesh));
}

}  // namespace

MeshPointer box(const Placement& placement) {
  return placed(test::box(glm::vec3(-1.0f), glm::vec3(1.0f)), placement);
}

MeshPointer sphere(int level, const Placement& placement) {
  return placed(test::sphere(level), placement);
}

MeshPointer random_sphere(int points, Random& random, const Placement& placement) {
  std::vector<glm::dvec3> p(static_cast<std::size_t>(points));
  for (glm::dvec3& point : p) point = random.unit();
  Mesh faces;
  for (std::size_t a = 0; a < p.size(); ++a) {
    for (std::size_t b = a + 1; b < p.size(); ++b) {
      for (std::size_t c = a + 1; c < p.size(); ++c) {
        if (c == b) continue;
        const glm::dvec3 normal = glm::cross(p[b] - p[a], p[c] - p[a]);
        const auto is_below = [&](const glm::dvec3& q) {
          return glm::dot(normal, q - p[a]) < 0.0 || &q == &p[a] || &q == &p[b] || &q == &p[c];
        };
        if (std::ranges::all_of(p, is_below)) faces.push_back({p[a], p[b], p[c]});
      }
    }
  }
  return placed(faces, placement);
}

MeshPointer wedge(double angle, const Placement& placement) {
  const double y = std::tan(angle);
  const glm::dvec3 p[] = {{0, 0, -1}, {1, 0, -1}, {1, y, -1}, {0, 0, 1}, {1, 0, 1}, {1, y, 1}};
  return placed({{p[0], p[2], p[1]},
                 {p[3], p[4], p[5]},
                 {p[0], p[1], p[4]},
                 {p[0], p[4], p[3]},
                 {p[0], p[3], p[5]},
                 {p[0], p[5], p[2]},
                 {p[1], p[2], p[5]},
                 {p[1], p[5], p[4]}},
                placement);
}

namespace {

constexpr int kRays = 8;

glm::dvec3 direction_to(const glm::dvec3& aim, const glm::dvec3& origin, const Random& random) {
  glm::dvec3 way = aim - origin;
  if (way == glm::dvec3(0.0)) way.x = 1.0;
  if (!random.binary64_rays) return glm::dvec3(scaled_direction(way));
  return Random::rounded(way * std::exp2(-std::ilogb(largest(way))), true);
}

Shot shot_at(Mesh triangles, const glm::dvec3& origin, const Random& random) {
  return {std::make_shared<const Mesh>(std::move(triangles)), random.origin(origin)};
}

glm::dvec3 inside_of(const Corners& t, Random& random) {
  double u = random.uniform(0, 1), v = random.uniform(0, 1);
  if (u + v > 1.0) u = 1.0 - u, v = 1.0 - v;
  return t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]);
}

/// Returns a point on an edge or, with probability 1/4, a vertex.
glm::dvec3 on_edge(const Corners& t, Random& random) {
  const int k = random.below(3);
  const double along = random.one_in(4) ? 0.0 : random.uniform(0, 1);
  return glm::mix(t[k], t[(k + 1) % 3], along);
}

/// Adds rays to `shot` towards points in, on the border of and near its triangles.
Shot aimed(Shot shot, Random& random) {
  const Mesh& triangles = *shot.mesh;
  for (int i = 0; i < kRays; ++i) {
    const Corners& t = triangles[random.below(static_cast<int>(triangles.size()))];
    glm::dvec3 aim = random.one_in(2) ? on_edge(t, random) : inside_of(t, random);
    if (random.one_in(8)) aim += (t[1] - t[0]) * random.uniform(-1, 1);
    shot.directions.push_back(direction_to(aim, shot.origin, random));
  }
  return shot;
}

Corners random_triangle(Random& random, const glm::dvec3& scale = glm::dvec3(1),
                        const glm::dvec3& shift = glm::dvec3(0)) {
  Corners t;
  for (glm::dvec3& vertex : t) vertex = random.vertex(random.point() * scale + shift);
  return t;
}

Shot random_shot(Random& random) {
  Shot shot = shot_at({random_triangle(random)}, random.point(), random);
  for (int i = 0; i < kRays; ++i) {
    const bool at_it = random.one_in(2);
    const glm::dvec3 aim = at_it ? inside_of(shot.mesh->front(), random) : random.point();
    shot.directions.push_back(direction_to(aim, shot.origin, random));
  }
  return shot;
}

/// Makes rays at angles down to 1e-7 rad to the triangle's plane.
Shot grazing_shot(Random& random) {
  const Corners t = random_triangle(random);
  const glm::dvec3 normal = glm::normalize(glm::cross(t[1] - t[0], t[2] - t[0]));
  const glm::dvec3 aim = inside_of(t, random);
  const glm::dvec3 along = glm::normalize(glm::cross(normal, random.unit()));
  const double distance = random.uniform(0.5, 4), angle = random.log_uniform(1e-7, 1e-1);
  const glm::dvec3 origin = aim + distance * (along + angle * random.sign() * normal);
  return aimed(shot_at({t}, origin, random), random);
}

Corners needle(Random& random) {
  const glm::dvec3 a = random.point(), way = random.unit(), b = a + way;
  const double aspect = random.log_uniform(1e3, 1e6);
  const glm::dvec3 c = glm::mix(a, b, random.one_in(2) ? 0.0 : random.uniform(0, 1)) +
                       glm::cross(way, random.unit()) / aspect;
  return {random.vertex(a), random.vertex(b), random.vertex(c)};
}

Shot needle_shot(Random& random) {
  return aimed(shot_at({needle(random)}, 2.0 * random.point(), random), random);
}

/// Makes a triangle and an origin at one random scale from `least` to `most`.
Shot scaled_shot(Random& random, double least, double most) {
  const glm::dvec3 scale(random.log_uniform(least, most));
  return aimed(shot_at({random_triangle(random, scale)}, random.point() * scale, random), random);
}

/// Makes triangles of different sizes around one point.
Shot mixed_shot(Random& random) {
  Mesh triangles;
  for (int i = 0; i < 3; ++i) {
    triangles.push_back(random_triangle(random, glm::dvec3(random.log_uniform(1e-3, 1e7))));
  }
  return aimed(shot_at(std::move(triangles), random.point(), random), random);
}

/// Makes triangles and rays between nodes of a lattice: edges, vertices and planes are met exactly.
Shot lattice_shot(Random& random) {
  const double step = random.binary64_vertices ? 1.0 + 0x1p-30 : 1.0;
  const auto node = [&] {
    const int x = random.below(5) - 2, y = random.below(5) - 2, z = random.below(5) - 2;
    return step * glm::dvec3(x, y, z);
  };
  Mesh triangles;
  for (int i = 0; i < 3; ++i) {
    const glm::dvec3 a = node(), b = node();
    triangles.push_back({a, b, node()});
  }
  Shot shot = shot_at(std::move(triangles), node(), random);
  for (int i = 0; i < kRays; ++i) {
    shot.directions.push_back(direction_to(node(), shot.origin, random));
  }
  return shot;
}

/// Makes triangles at 1e3 to 1e7 times their size from the world's origin.
Shot far_shot(Random& random) {
  const glm::dvec3 shift = random.unit() * random.log_uniform(1e3, 1e7);
  const Corners t = random_triangle(random, glm::dvec3(1), shift);
  return aimed(shot_at({t}, random.point() + shift, random), random);
}

/// Makes overlapping triangles in one plane, or in slightly tilted planes.
Shot coplanar_shot(Random& random) {
  const Corners base = random_triangle(random);
  const glm::dvec3 u = base[1] - base[0], v = base[2] - base[0];
  const double tilt = random.one_in(2) ? 0.0 : random.log_uniform(1e-8, 1e-4);
  Mesh triangles = {base};
  for (int i = 0; i < 3; ++i) {
    Corners t;
    for (glm::dvec3& vertex : t) {
      vertex = random.vertex(base[0] + random.uniform(0, 1) * u + random.uniform(0, 1) * v +
                             tilt * random.point());
    }
    if (random.one_in(3)) t = {base[1], base[2], base[0]};
    triangles.push_back(t);
  }
  return aimed(shot_at(std::move(triangles), 2.0 * random.point(), random), random);
}

/// Makes copies of a triangle in which a vertex is moved by up to three steps of the format.
Shot near_tie_shot(Random& random) {
  const Corners base = random_triangle(random);
  Mesh triangles;
  for (int i = 0; i < 5; ++i) {
    Corners t = base;
    std::rotate(t.begin(), t.begin() + random.below(3), t.end());
    glm::dvec3& vertex = t[random.below(3)];
    for (int steps = random.below(4); steps > 0; --steps) {
      double& x = vertex[random.below(3)];
      const double towards = 2.0 * random.sign();
      x = random.binary64_vertices
              ? std::nextafter(x, towards)
              : std::nextafter(static_cast<float>(x), static_cast<float>(towards));
    }
    triangles.push_back(t);
  }
  return aimed(shot_at(std::move(triangles), 2.0 * random.point(), random), random);
}

/// Makes triangles perpendicular to one axis, in planes that are equal or one or two steps apart.
Shot stack_shot(Random& random) {
  const int axis = random.below(3);
  Mesh triangles;
  for (int i = 0; i < 24; ++i) {
    glm::dvec3 middle = random.point();
    middle[axis] = 1.0 + (random.binary64_vertices ? 0x1p-52 : 0x1p-23) * random.below(3);
    Corners& t = triangles.emplace_back(Corners{middle, middle, middle});
    t[0][(axis + 1) % 3] -= 2.0;
    t[1][(axis + 1) % 3] += 2.0;
    for (int k = 0; k < 3; ++k) {
      t[k][(axis + 2) % 3] += k == 2 ? 2.0 : -2.0;
      t[k] = random.vertex(t[k]);
    }
  }
  return aimed(shot_at(std::move(triangles), glm::dvec3(0.0), random), random);
}

/// Makes rays (almost) parallel to axes, from points in planes of faces. No BVH may cull these.
Shot axis_shot(Random& random, const MeshPointer& mesh) {
  Shot shot{mesh};
  const Mesh& box = *mesh;
  const glm::dvec3 low = box[0][0], high = box[2][2];
  const int axis = random.below(3);
  const Corners& t = box[random.below(static_cast<int>(box.size()))];
  // Each coordinate of the origin equals a vertex's, or is random.
  for (int k = 0; k < 3; ++k) {
    const double between = std::lerp(low[k], high[k], random.uniform(0.05, 0.95));
    shot.origin[k] = random.one_in(2) ? t[0][k] : between;
  }
  shot.origin[axis] = std::lerp(low[axis], high[axis], random.uniform(-1, 2));
  shot.origin = random.origin(shot.origin);
  constexpr double kTiny[] = {0.0, -0.0, 0x1p-149, -0x1p-149, 0x1p-130, 0x1p-99, -0x1p-101};
  for (int i = 0; i < kRays; ++i) {
    glm::dvec3 direction(0.0);
    for (int k = 0; k < 3; ++k) direction[k] = kTiny[random.below(7)];
    direction[axis] = random.sign();
    if (random.one_in(4)) direction[(axis + 1) % 3] = random.sign();
    shot.directions.push_back(direction);
  }
  return shot;
}

Shot useless_shot(Random& random) {
  Shot shot = shot_at({random_triangle(random)}, random.point(), random);
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  constexpr double kParts[] = {kNaN, kInfinity, -kInfinity, 0.0, -0.0, 1.0};
  for (int i = 0; i < kRays; ++i) {
    if (random.one_in(4)) {
      shot.directions.push_back(
          direction_to(inside_of(shot.mesh->front(), random), shot.origin, random));
      continue;
    }
    glm::dvec3 direction;
    for (int k = 0; k < 3; ++k) direction[k] = kParts[random.below(6)];
    shot.directions.push_back(direction);
  }
  return shot;
}

/// Makes triangles without area, or origins in a triangle's plane or at its vertex.
Shot degenerate_shot(Random& random) {
  const double grid = random.binary64_vertices ? 0x1p40 : 0x1p8;
  Corners t = random_triangle(random);
  glm::dvec3 origin = random.point();
  switch (random.below(5)) {
    case 0:
      t[1] = t[0];
      break;
    case 1:
      t[2] = t[1] = t[0];
      break;
    case 2:  // exactly collinear
      for (int k = 0; k < 2; ++k) t[k] = glm::round(t[k] * grid) / grid;
      t[2] = 2.0 * t[1] - t[0];
      break;
    case 3:
      origin = t[random.below(3)];
      break;
    default:  // origin exactly in the triangle's plane
      t[0].z = t[1].z = t[2].z;
      origin.z = t[0].z;
      break;
  }
  return aimed(shot_at({t}, origin, random), random);
}

enum class Aim { kEdges, kVertices };

/// Aims from inside a closed mesh at edges and vertices. Reuses a mesh for several shots.
Generator closed_mesh(const std::function<MeshPointer(Random&)>& make_mesh, Aim aim) {
  return [make_mesh, aim, mesh = MeshPointer(), left = 0](Random& random) mutable {
    if (left-- == 0) {
      mesh = make_mesh(random);
      left = 200;
    }
    const Mesh& triangles = *mesh;
    const auto any_triangle = [&]() -> const Corners& {
      return triangles[random.below(static_cast<int>(triangles.size()))];
    };
    glm::dvec3 center(0.0);
    for (const Corners& t : triangles) center += (t[0] + t[1] + t[2]) / 3.0;
    center /= static_cast<double>(triangles.size());
    Shot shot{.mesh = mesh, .inside = true};
    shot.origin = random.origin(glm::mix(center, any_triangle()[0], random.uniform(0, 0.5)));
    const Corners& target = any_triangle();
    for (int i = 0; i < kRays; ++i) {
      const int k = random.below(3);
      const double along = aim == Aim::kVertices ? 0.0 : random.uniform(0, 1);
      shot.directions.push_back(
          direction_to(glm::mix(target[k], target[(k + 1) % 3], along), shot.origin, random));
    }
    return shot;
  };
}

Placement somewhere(Random& random) {
  Placement placement{.binary64 = random.binary64_vertices};
  if (placement.binary64 || random.one_in(2)) {
    placement.shift = random.unit() * random.log_uniform(1, 1e4);
  }
  return placement;
}

MeshPointer flattened_sphere(Random& random) {
  return sphere(1, {glm::dvec3(1, random.log_uniform(1e-3, 1), random.log_uniform(1e-5, 1e-2)),
                    glm::dvec3(0), random.binary64_vertices});
}

constexpr int kBounces = 12;

glm::vec3 mirrored(const glm::vec3& direction, const Corners& t) {
  const glm::dvec3 n = glm::normalize(triangle_normal(t)), d(direction);
  return scaled_direction(d - 2.0 * glm::dot(d, n) * n);
}

/// Returns the primitive that the ray hits first.
std::optional<std::uint32_t> first_hit(const Bvh& bvh, const Ray& ray) {
  std::optional<std::uint32_t> best;
  for (std::uint32_t primitive = 0; primitive < bvh.primitive_count(); ++primitive) {
    const Corners t = bvh.corners_of(primitive);
    if (!hits_triangle(ray, t)) continue;
    if (!best || compare_hits(ray, t, bvh.corners_of(*best)) < 0) best = primitive;
  }
  return best;
}

/// A generator whose shots are successive reflections: eight rays from a point in a wedge or a box.
/// The next shot starts where one of these rays is reflected, at the renderer's spawn origin. All
/// shots claim to start inside, so the oracle detects wrong spawn origins.
class Bounces {
 public:
  Shot operator()(Random& random) {
    if (bounces_left_-- <= 0) {
      start_anew(random);
    } else {
      bounce(random);
    }
    directions_.clear();
    if (mirrored_ != glm::vec3(0.0f)) directions_.push_back(mirrored_);
    while (directions_.size() < kRays) {
      // Aims at edges and points near them, such as the edge between the first two side faces.
      const Corners& t = (*mesh_)[random.below(static_cast<int>(mesh_->size()))];
      const glm::dvec3 aim = glm::mix(t[0], t[random.below(3)], random.uniform(0, 1)) +
                             random.point() * random.log_uniform(1e-9, 1e-1);
      const glm::dvec3 way = aim - glm::dvec3(origin_);
      if (way != glm::dvec3(0.0)) directions_.push_back(scaled_direction(way));
    }
    return {mesh_, glm::dvec3(origin_), {directions_.begin(), directions_.end()}, true};
  }

 private:
  void start_anew(Random& random) {
    const double angle = random.log_uniform(1e-6, 1);
    Placement placement;
    if (angle > 1e-2 && random.one_in(2)) placement.shift = random.point() * 1e3;
    const bool boxed = random.one_in(4);
    mesh_ = boxed ? box(placement) : wedge(angle, placement);
    bvh_ = std::make_shared<Bvh>(test::scene_of(*mesh_));
    const glm::dvec3 start =
        boxed ? 0.8 * random.point()
              : glm::dvec3(0.7, 0.7 * std::tan(angle) * random.uniform(0.3, 0.7), 0.2);
    origin_ = glm::vec3(start + placement.shift);
    mirrored_ = glm::vec3(0.0f);
    bounces_left_ = kBounces;
  }

  /// Reflects one of the last kRays rays at its hit. If that is not possible, starts in a new mesh.
  void bounce(Random& random) {
    const Ray ray = {origin_, directions_[random.below(kRays)]};
    const auto primitive = first_hit(*bvh_, ray);
    const NeighborClearances clearances(*bvh_);
    RaySpawner spawner(clearances);
    const SpawnOrigin point =
        primitive ? spawner.find(ray, *primitive, SpawnSide::kIncident) : SpawnOrigin{};
    if (!point) return start_anew(random);
    mirrored_ = mirrored(ray.direction, bvh_->corners_of(*primitive));
    if (!spawner.leaves(ray, *primitive, SpawnSide::kIncident, mirrored_))
      mirrored_ = glm::vec3(0.0f);
    origin_ = *point;
  }

  MeshPointer mesh_;
  std::shared_ptr<const Bvh> bvh_;
  glm::vec3 origin_{0.0f};
  std::vector<glm::vec3> directions_;  // directions of the last shot
  glm::vec3 mirrored_{0.0f};           // reflected direction of the ray followed; 0: none
  int bounces_left_ = 0;
};

std::function<Generator()> plain(Shot (*make)(Random&)) {
  return [make] { return Generator(make); };
}

std::function<Generator()> in_binary64(const std::function<Generator()>& make) {
  return [make] {
    return [generate = make()](Random& random) {
      random.binary64_vertices = true;
      random.binary64_rays = random.one_in(2);
      return generate(random);
    };
  };
}

std::vector<Suite> make_suites() {
  std::vector<Suite> suites = {{"random",
                                "random triangles and rays, half of them aimed at the triangle",
                                plain(random_shot)}};
  const std::pair<const char*, std::function<MeshPointer(Random&)>> meshes[] = {
      {"sphere", [](Random& random) { return sphere(1, somewhere(random)); }},
      {"box", [](Random& random) { return box(somewhere(random)); }},
      {"slivers", flattened_sphere},
      {"delaunay", [](Random& random) { return random_sphere(42, random, somewhere(random)); }}};
  for (const auto& [name, mesh] : meshes) {
    for (const Aim aim : {Aim::kEdges, Aim::kVertices}) {
      const std::string target = aim == Aim::kEdges ? "edges" : "vertices";
      suites.push_back({std::string(name) + " " + target,
                        "from inside a closed mesh at its " + target,
                        [mesh = mesh, aim] { return closed_mesh(mesh, aim); }});
    }
  }
  const std::vector<Suite> rest = {
      {"grazing", "1e-1 to 1e-7 rad between ray and plane", plain(grazing_shot)},
      {"needles", "triangles 1e3 to 1e6 times as long as wide", plain(needle_shot)},
      {"sizes", "triangles from 1e-18 to 1e18",
       plain([](Random& random) { return scaled_shot(random, 1e-18, 1e18); })},
      {"mixed sizes", "triangles from 1e-3 to 1e7 around one point", plain(mixed_shot)},
      {"lattice", "vertices, origins and aims on few points: exact ties", plain(lattice_shot)},
      {"far away", "1e3 to 1e7 sizes from the world's origin", plain(far_shot)},
      {"coplanar", "parts of one plane, or of nearly parallel ones, over one another",
       plain(coplanar_shot)},
      {"near ties", "copies of a triangle, moved by up to three floats", plain(near_tie_shot)},
      {"stacks", "triangles that fill their boxes, in planes a few steps apart", plain(stack_shot)},
      {"extremes", "sizes from 2^-149 to 2^125: subnormal and overflowing intermediates",
       plain([](Random& random) { return scaled_shot(random, 0x1p-149, 0x1p125); })},
      {"axes", "along axes, with zero and subnormal components, from the planes of faces",
       [] {
         return [mesh = MeshPointer()](Random& random) mutable {
           if (!mesh) mesh = box(random.binary64_vertices ? somewhere(random) : Placement{});
           return axis_shot(random, mesh);
         };
       }},
      {"useless", "directions of NaN, infinity and zero, among good ones", plain(useless_shot)},
      {"degenerate", "polygons without area; origins in their plane", plain(degenerate_shot)},
      {"corners", "rays mirrored into concave corners of 1 to 1e-6 rad",
       [] { return Generator(Bounces()); }}};
  suites.insert(suites.end(), rest.begin(), rest.end());
  for (std::size_t i = 0, count = suites.size(); i < count; ++i) {
    // Unusable rays, and the renderer's rays of "corners", exist in binary32 only.
    if (suites[i].name == "useless" || suites[i].name == "corners") continue;
    suites.push_back({suites[i].name + " 64", suites[i].what, in_binary64(suites[i].make), true});
  }
  return suites;
}

}  // namespace

const std::vector<Suite>& all_suites() {
  static const std::vector<Suite> suites = make_suites();
  return suites;
}

}  // namespace raygate::lab
