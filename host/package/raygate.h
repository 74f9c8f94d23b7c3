// C++ interface of raygate: exact ray-triangle intersection. This is the only installed header. See
// host/docs/python.md for its use, and host/EMBEDDING.md for guarantees about threads, signals,
// memory, exceptions and fork.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

namespace raygate {

/// A set of triangles in a BVH, for ray queries. Which triangles are hit, and in which order, is
/// decided exactly on the given numbers (except for underflow, see below). A ray through an edge or
/// a corner counts as tilted by an infinitesimal angle towards +x, a smaller one towards +y and +z.
/// So where it crosses a closed mesh it hits one triangle; where it touches it, none or two; of the
/// border of an open mesh, one side is hit. Of two hits at equal distance, the hit with the lower
/// triangle index comes first. Queries are thread-safe. They set IEEE 754 arithmetic and restore
/// the caller's mode when they return.
class Tracer {
 public:
  using Point = std::array<double, 3>;
  using Triangle = std::array<Point, 3>;
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  /// A ray. Its hits are points P = origin + t direction with 0 < t < limit.
  struct Ray {
    Point origin{}, direction{};  ///< direction of any length; a zero direction hits nothing
    double limit = std::numeric_limits<double>::infinity();  ///< positive
  };
  struct Hit {
    std::uint32_t triangle = kNone;                      ///< triangle index; kNone: a miss
    double t = std::numeric_limits<double>::infinity();  ///< relative error at most 2^-33
    /// P = (1 - u - v) A + u B + v C for the triangle's corners A, B, C. The errors of u and v are
    /// at most 2^-34. None of the three weights is negative.
    double u = 0.0, v = 0.0;
  };

  /// Builds the BVH on `threads` threads. Coordinates must be finite, with a magnitude of at most
  /// 2^126. Triangles without area are allowed, but are never hit. `triangles` can be freed after
  /// the constructor returns. Throws std::invalid_argument for other coordinates, and
  /// std::runtime_error if the machine's arithmetic does not conform to IEEE 754.
  explicit Tracer(std::span<const Triangle> triangles, int threads = 1);
  ~Tracer();
  Tracer(Tracer&&) noexcept;
  Tracer& operator=(Tracer&&) noexcept;

  // All queries throw std::invalid_argument, "ray 3: found ..., expected ...", for a ray that is
  // not finite, starts farther away than 2^126, or has a limit that is not positive.
  //
  // Rays are traced with the direction scaled by a power of two, so that its largest component is
  // in [1, 2), and with the limit divided by that power. All coordinates are rounded to multiples
  // of 2^-149; magnitudes of at least 2^-97 stay exact. If the triangles' coordinates are not all
  // floats, origins are rounded to binary64 relative to a point near the middle of the triangles.

  /// Sets hits[i] to the nearest hit of rays[i]. Both spans must have the same size.
  void nearest(std::span<const Ray> rays, std::span<Hit> hits) const;

  /// Sets is_hit[i] to 1 if rays[i] hits anything, and to 0 otherwise. Faster than nearest().
  void any(std::span<const Ray> rays, std::span<std::uint8_t> is_hit) const;

  /// Returns all hits of a ray, nearest first.
  [[nodiscard]] std::vector<Hit> all(const Ray& ray) const;

 private:
  struct Tree;
  std::unique_ptr<const Tree> tree_;
};

}  // namespace raygate
