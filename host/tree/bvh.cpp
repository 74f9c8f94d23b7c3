#include "host/tree/bvh.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "host/tree/wide_bvh.h"

namespace raygate {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

struct Box {
  glm::vec3 low{kInfinity}, high{-kInfinity};

  void grow(const Box& other) {
    low = glm::min(low, other.low);
    high = glm::max(high, other.high);
  }
  /// Half the surface, in double: a float would overflow at 1e19.
  [[nodiscard]] double half_area() const {
    const glm::dvec3 size = glm::dvec3(high) - glm::dvec3(low);
    return size.x * size.y + size.y * size.z + size.z * size.x;
  }
};

/// The triangle's box, one float wider on every side: packet_traversal.h says what for.
Box box_of(const Bvh::Corners& t) {
  Box box;
  for (int k = 0; k < 3; ++k) {
    const auto [low, high] = std::minmax({t[0][k], t[1][k], t[2][k]});
    box.low[k] = std::nextafter(low, -kInfinity);
    box.high[k] = std::nextafter(high, kInfinity);
  }
  return box;
}

struct Primitive {
  Box box;
  std::uint32_t triangle;

  /// Twice the centre.
  [[nodiscard]] double center(int axis) const {
    return static_cast<double>(box.low[axis]) + box.high[axis];
  }
};

}  // namespace

/// Top-down, with the splits between a few equal bins tried on each axis (Wald, "On fast
/// construction of SAH-based bounding volume hierarchies", 2007).
class BvhBuilder {
 public:
  BvhBuilder(Bvh& bvh, std::vector<Primitive> primitives)
      : bvh_(bvh), primitives_(std::move(primitives)) {
    bvh_.nodes_.reserve(primitives_.size());
    bvh_.nodes_.emplace_back();
    const auto count = static_cast<std::uint32_t>(primitives_.size());
    if (count <= Bvh::kMaxLeafSize) {
      Box box;
      for (const Primitive& p : primitives_) box.grow(p.box);
      set_child(0, 0, box, {0, static_cast<std::uint16_t>(count), 0});
      set_child(0, 1, Box{}, {});
    } else {
      bvh_.root_.axis = fill(0, 0, count, 0);
    }
  }

  [[nodiscard]] const std::vector<Primitive>& order() const { return primitives_; }

 private:
  static constexpr int kBins = 16;
  // A node visit tests two boxes; a hit test costs about as much as both.
  static constexpr double kVisitCost = 1.0, kTestCost = 1.0;

  struct Split {
    double cost = std::numeric_limits<double>::infinity();
    int axis = 0;
    int bin = 0;  // bins below it go left
  };

  struct Centers {
    glm::dvec3 low{std::numeric_limits<double>::infinity()};
    glm::dvec3 scale{0.0};  // bins per unit; 0 where all centres are one

    [[nodiscard]] int bin_of(const Primitive& p, int axis) const {
      const auto bin = static_cast<int>((p.center(axis) - low[axis]) * scale[axis]);
      return std::min(bin, kBins - 1);
    }
  };

  [[nodiscard]] Centers centers_of(std::uint32_t begin, std::uint32_t end) const {
    Centers centers;
    glm::dvec3 high(-std::numeric_limits<double>::infinity());
    for (std::uint32_t i = begin; i < end; ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        const double center = primitives_[i].center(axis);
        centers.low[axis] = std::min(centers.low[axis], center);
        high[axis] = std::max(high[axis], center);
      }
    }
    for (int axis = 0; axis < 3; ++axis) {
      const double extent = high[axis] - centers.low[axis];
      centers.scale[axis] = extent > 0.0 ? kBins / extent : 0.0;
    }
    return centers;
  }

  /// The cheapest split, its cost as a sum of area times count.
  [[nodiscard]] Split best_split(std::uint32_t begin, std::uint32_t end,
                                 const Centers& centers) const {
    Box boxes[3][kBins];
    std::uint32_t counts[3][kBins] = {};
    for (std::uint32_t i = begin; i < end; ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        const int bin = centers.bin_of(primitives_[i], axis);
        boxes[axis][bin].grow(primitives_[i].box);
        ++counts[axis][bin];
      }
    }
    Split best;
    for (int axis = 0; axis < 3; ++axis) {
      if (centers.scale[axis] == 0.0) continue;
      double right_cost[kBins];
      Box box;
      std::uint32_t count = 0;
      for (int bin = kBins - 1; bin > 0; --bin) {
        box.grow(boxes[axis][bin]);
        count += counts[axis][bin];
        right_cost[bin] = count == 0 ? 0.0 : box.half_area() * count;
      }
      box = {};
      count = 0;
      for (int bin = 1; bin < kBins; ++bin) {
        box.grow(boxes[axis][bin - 1]);
        count += counts[axis][bin - 1];
        if (count == 0 || count == end - begin) continue;
        const double cost = box.half_area() * count + right_cost[bin];
        if (cost < best.cost) best = {cost, axis, bin};
      }
    }
    return best;
  }

  /// Makes node `index` out of primitives [begin, end), more than fit a leaf or worth a split;
  /// returns its axis. A path never gets longer than kMaxDepth: close to it, halves are split.
  std::uint16_t fill(std::uint32_t index, std::uint32_t begin, std::uint32_t end, int depth) {
    const Centers centers = centers_of(begin, end);
    return split_at(index, begin, end, depth, centers, best_split(begin, end, centers));
  }

  std::uint16_t split_at(std::uint32_t index, std::uint32_t begin, std::uint32_t end, int depth,
                         const Centers& centers, const Split& split) {
    std::uint32_t middle = begin + (end - begin) / 2;
    const int levels_left = Bvh::kMaxDepth - depth;
    if (std::isfinite(split.cost) && static_cast<int>(std::bit_width(end - begin)) < levels_left) {
      const auto left = std::partition(
          primitives_.begin() + begin, primitives_.begin() + end,
          [&](const Primitive& p) { return centers.bin_of(p, split.axis) < split.bin; });
      middle = static_cast<std::uint32_t>(left - primitives_.begin());
    } else {
      std::nth_element(primitives_.begin() + begin, primitives_.begin() + middle,
                       primitives_.begin() + end, [&](const Primitive& p, const Primitive& q) {
                         return p.center(split.axis) < q.center(split.axis);
                       });
    }
    make_child(index, 0, begin, middle, depth + 1);
    make_child(index, 1, middle, end, depth + 1);
    return static_cast<std::uint16_t>(split.axis);
  }

  void make_child(std::uint32_t parent, int side, std::uint32_t begin, std::uint32_t end,
                  int depth) {
    Box box;
    for (std::uint32_t i = begin; i < end; ++i) box.grow(primitives_[i].box);
    const std::uint32_t count = end - begin;
    const Bvh::Ref leaf = {begin, static_cast<std::uint16_t>(count), 0};
    if (count == 1) return set_child(parent, side, box, leaf);
    const Centers centers = centers_of(begin, end);
    const Split split = best_split(begin, end, centers);
    const double area = box.half_area();
    if (count <= Bvh::kMaxLeafSize &&
        !(kVisitCost * area + kTestCost * split.cost < kTestCost * area * count)) {
      return set_child(parent, side, box, leaf);
    }
    const auto index = static_cast<std::uint32_t>(bvh_.nodes_.size());
    bvh_.nodes_.emplace_back();
    const std::uint16_t axis = split_at(index, begin, end, depth, centers, split);
    set_child(parent, side, box, {index, 0, axis});
  }

  void set_child(std::uint32_t parent, int side, const Box& box, Bvh::Ref ref) {
    Bvh::Node& node = bvh_.nodes_[parent];
    node.bounds[0][side] = box.low;
    node.bounds[1][side] = box.high;
    node.child[side] = ref;
  }

  Bvh& bvh_;
  std::vector<Primitive> primitives_;
};

Bvh::Bvh(const Scene& scene) {
  std::vector<Primitive> primitives;
  primitives.reserve(scene.triangles.size());
  std::vector<Corners> corners;
  corners.reserve(scene.triangles.size());
  for (const Triangle& triangle : scene.triangles) {
    corners.push_back({scene.positions[triangle.vertices[0]], scene.positions[triangle.vertices[1]],
                       scene.positions[triangle.vertices[2]]});
    primitives.push_back({box_of(corners.back()), static_cast<std::uint32_t>(primitives.size())});
  }
  const BvhBuilder builder(*this, std::move(primitives));
  triangles_.reserve(corners.size());
  corners_.reserve(corners.size());
  for (const Primitive& primitive : builder.order()) {
    triangles_.push_back(primitive.triangle);
    corners_.push_back(corners[primitive.triangle]);
  }
  wide_ = std::make_shared<const WideBvh>(*this);
}

}  // namespace raygate
