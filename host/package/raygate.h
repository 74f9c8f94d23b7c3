// raygate's C++ interface: triangles and rays in, exact hits out. The only header that is
// installed; host/docs/python.md explains how to use it, host/EMBEDDING.md what it promises about
// threads, signals, memory, exceptions and fork.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

namespace raygate {

/// Triangles in a tree of boxes, and what rays hit of them. Which triangles are hit, and in which
/// order, is decided exactly on the floats that are given (but for what underflows, see below): a
/// ray through an edge or a corner of a closed mesh hits exactly one of the triangles that meet
/// there, none leaks through. Of two hits that are equally far the lower triangle comes first. All
/// questions may be asked by several threads at once, in whatever rounding mode: each call sets
/// IEEE 754's arithmetic and leaves the thread's as it was.
class Tracer {
 public:
  using Point = std::array<float, 3>;
  using Triangle = std::array<Point, 3>;
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  /// Its hits are P = origin + t direction with 0 < t < limit.
  struct Ray {
    Point origin{}, direction{};  ///< of any length; a direction of 0 hits nothing
    float limit = std::numeric_limits<float>::infinity();  ///< positive
  };
  struct Hit {
    std::uint32_t triangle = kNone;                      ///< its index; kNone: nothing is hit
    double t = std::numeric_limits<double>::infinity();  ///< off by at most 2^-33 of itself
    /// P = (1 - u - v) A + u B + v C, each off by at most 2^-34, none of the three negative.
    double u = 0.0, v = 0.0;
  };

  /// Builds the tree, on so many threads. Coordinates are finite and of magnitude at most 2^126;
  /// triangles without area are allowed, and never hit. Throws std::invalid_argument where they
  /// are not, and std::runtime_error where this machine's arithmetic is not IEEE 754's. The
  /// triangles are not needed afterwards.
  explicit Tracer(std::span<const Triangle> triangles, int threads = 1);
  ~Tracer();
  Tracer(Tracer&&) noexcept;
  Tracer& operator=(Tracer&&) noexcept;

  // Each of these throws std::invalid_argument, "ray 3: found ..., expected ...", at a ray that is
  // not finite, begins farther away than 2^126, or has a limit that is not above 0.
  //
  // A ray is traced with its direction times a power of two that brings the largest component into
  // [1, 2), and its limit divided by that. What is below 2^-126 then is rounded to a multiple of
  // 2^-149, a limit to 2^-149 at least. Nothing else is rounded: no component of 2^-126 of the
  // largest one or more, no limit that lies 2^-125 or more away.

  /// hits[i] becomes the nearest hit of rays[i]; as many hits as rays.
  void nearest(std::span<const Ray> rays, std::span<Hit> hits) const;

  /// Whether anything is hit: sooner known than what is nearest. 1 or 0 for each ray.
  void any(std::span<const Ray> rays, std::span<std::uint8_t> is_hit) const;

  /// All hits of a ray, near before far.
  [[nodiscard]] std::vector<Hit> all(const Ray& ray) const;

 private:
  struct Tree;
  std::unique_ptr<const Tree> tree_;
};

}  // namespace raygate
