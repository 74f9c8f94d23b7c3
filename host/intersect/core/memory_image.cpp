#include "host/intersect/core/memory_image.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "host/bvh/sah_builder.h"
#include "host/exact/expansion.h"

namespace raygate {
namespace {

using Ref = BinaryBvh::Ref;

/// Bounds of triangles.
struct Bounds {
  glm::vec3 low, high;

  /// Returns half the surface area.
  [[nodiscard]] double area() const {
    const glm::dvec3 size = glm::dvec3(high) - glm::dvec3(low);
    return size.x * size.y + size.y * size.z + size.z * size.x;
  }
};

/// Returns the next number above x.
template <class T>
T up(T x) {
  return std::nextafter(x, std::numeric_limits<T>::infinity());
}

/// Return the difference of two floats, rounded up or down.
double above(double a, double b) {
  const auto [difference, error] = two_sum(a, -b);
  return error > 0.0 ? up(difference) : difference;
}
double below(double a, double b) { return -above(b, a); }

}  // namespace

NodeLine::NodeLine(const MemoryLine& line) {
  PackedFields fields(line.words);
  origin = fields.take_vector();
  for (int& e : exponent) e = static_cast<int>(fields.take(8));
  base = fields.take(28);
  for (Child& of : child) of.kind = fields.take(4);
  for (Child& of : child) {
    for (auto* const corner : {&of.low, &of.high}) {
      for (std::uint8_t& q : *corner) q = static_cast<std::uint8_t>(fields.take(8));
    }
  }
}

MemoryLine NodeLine::line() const {
  MemoryLine line;
  PackedFields fields(line.words);
  fields.put(origin);
  for (const int e : exponent) fields.put(static_cast<std::uint32_t>(e), 8);
  fields.put(base, 28);
  for (const Child& of : child) fields.put(of.kind, 4);
  for (const Child& of : child) {
    for (const auto& corner : {of.low, of.high}) {
      for (const std::uint8_t q : corner) fields.put(q, 8);
    }
  }
  return line;
}

TriangleLine::TriangleLine(const MemoryLine& line) {
  PackedFields fields(line.words);
  for (glm::vec3& corner : corners) corner = fields.take_vector();
  for (auto* const word : {&index, &rank, &primitive}) *word = fields.take();
}

MemoryLine TriangleLine::line() const {
  MemoryLine line;
  PackedFields fields(line.words);
  for (const glm::vec3& corner : corners) fields.put(corner);
  for (const std::uint32_t word : {index, rank, primitive}) fields.put(word);
  return line;
}

/// Collapses a binary BVH to seven children per node.
class ImageWriter {
 public:
  ImageWriter(MemoryImage& image, const Bvh& bvh, const BinaryBvh& tree)
      : image_(image), bvh_(bvh), tree_(tree), leaf_(tree.size()) {}

  void write() {
    image_.lines_.resize(1);
    image_.primitive_lines_.resize(bvh_.primitive_count(), MemoryImage::kNoTriangle);
    if (tree_.size() == 0) {
      image_.lines_[0] = NodeLine().line();
      return;
    }
    plan(tree_.root());
    write_node(MemoryImage::kRoot, tree_.root());
  }

 private:
  // Triangles share a leaf if their boxes are hardly smaller than its box: rays enter most of them.
  static constexpr std::uint32_t kMostInLeaf = 4;
  static constexpr double kSameBox = 0.8;

  [[nodiscard]] bool is_leaf(Ref ref) const { return tree_.is_leaf(ref) || leaf_[ref]; }

  /// Returns the exact bounds of a node's triangles; the binary tree's boxes are one float wider.
  [[nodiscard]] Bounds bounds(Ref ref) const {
    const Box box = tree_.box(ref);
    Bounds bounds;
    for (int k = 0; k < 3; ++k) {
      bounds.low[k] = up(box[k]) + 0.0f;  // -0 becomes 0
      bounds.high[k] = -up(box[k + 4]);
    }
    return bounds;
  }

  /// Sets leaf_ for the nodes of a subtree. Returns the sum of the areas of its triangles' boxes.
  double plan(Ref ref) {
    if (tree_.is_leaf(ref)) return bounds(ref).area();
    const double sum = plan(tree_.nodes[ref].child[0]) + plan(tree_.nodes[ref].child[1]);
    const std::uint32_t count = tree_.count(ref);
    leaf_[ref] = count <= kMostInLeaf && sum >= kSameBox * count * bounds(ref).area();
    return sum;
  }

  /// Returns the children of wide node `ref`: repeatedly splits the child with the largest box.
  [[nodiscard]] std::vector<Ref> children(Ref ref) const {
    std::vector<Ref> refs = {ref};
    while (refs.size() < NodeLine::kChildren) {
      const auto largest = std::ranges::max_element(
          refs, {}, [&](Ref each) { return is_leaf(each) ? -1.0 : bounds(each).area(); });
      if (is_leaf(*largest)) break;
      const Ref opened = *largest;
      *largest = tree_.nodes[opened].child[0];
      refs.insert(largest + 1, tree_.nodes[opened].child[1]);
    }
    return refs;
  }

  /// Sets the grid of a node, on which its box extends from 0 to at most 255. Cells of an axis
  /// without extent are much smaller than those of the other axes.
  static void set_grid(const Bounds& bounds, NodeLine& node) {
    constexpr int kFinest = 24;  // cells are at most 2^24 times smaller than on the coarsest axis
    node.origin = bounds.low;
    int coarsest = 1;
    for (int k = 0; k < 3; ++k) {
      const double cell = above(bounds.high[k], bounds.low[k]) / 255.0;
      node.exponent[k] = cell > 0.0 ? std::clamp(std::ilogb(up(cell)) + 128, 1, 254) : 1;
      coarsest = std::max(coarsest, node.exponent[k]);
    }
    for (int& exponent : node.exponent) exponent = std::max({exponent, coarsest - kFinest, 1});
  }

  static void set_box(const Bounds& bounds, const NodeLine& node, NodeLine::Child& child) {
    for (int k = 0; k < 3; ++k) {
      const double cell = std::ldexp(1.0, node.exponent[k] - 127);
      const double low = below(bounds.low[k], node.origin[k]) / cell;
      const double high = above(bounds.high[k], node.origin[k]) / cell;
      child.low[k] = static_cast<std::uint8_t>(std::floor(low));
      child.high[k] = static_cast<std::uint8_t>(std::ceil(high));
    }
  }

  void write_node(std::uint32_t number, Ref ref) {
    NodeLine node;
    set_grid(bounds(ref), node);
    node.base = static_cast<std::uint32_t>(image_.lines_.size());
    const std::vector<Ref> refs = children(ref);
    std::uint32_t size = 0;
    for (std::size_t i = 0; i < refs.size(); ++i) {
      node.child[i].kind = is_leaf(refs[i]) ? tree_.count(refs[i]) : NodeLine::kInner;
      set_box(bounds(refs[i]), node, node.child[i]);
      size += node.child[i].size();
    }
    image_.lines_[number] = node.line();
    image_.lines_.resize(image_.lines_.size() + size);
    std::uint32_t next = node.base;
    for (std::size_t i = 0; i < refs.size(); ++i) {
      if (node.child[i].kind == NodeLine::kInner) {
        write_node(next, refs[i]);
      } else {
        for (std::uint32_t k = 0; k < node.child[i].kind; ++k) {
          TriangleLine triangle;
          triangle.primitive = tree_.primitives[tree_.first(refs[i]) + k].number;
          triangle.corners = bvh_.float_corners_of(triangle.primitive);
          triangle.rank = bvh_.triangle_of(triangle.primitive);
          triangle.index = next + k;
          image_.lines_[next + k] = triangle.line();
          image_.primitive_lines_[triangle.primitive] = next + k;
        }
      }
      next += node.child[i].size();
    }
  }

  MemoryImage& image_;
  const Bvh& bvh_;
  const BinaryBvh& tree_;
  std::vector<char> leaf_;
};

MemoryImage::MemoryImage(const Bvh& bvh, int threads) {
  if (bvh.has_instances()) throw std::invalid_argument("instances, expected them written out");
  if (!bvh.is_binary32()) throw std::invalid_argument("binary64 vertices, expected binary32");
  std::vector<Primitive> primitives(bvh.primitive_count());
  for (std::uint32_t i = 0; i < primitives.size(); ++i) {
    const auto [a, b, c] = bvh.float_corners_of(i);
    primitives[i] = Primitive(box_around(a, b, c), i);
  }
  const BinaryBvh tree(std::move(primitives), Bvh::kMaxDepth, threads);
  ImageWriter(*this, bvh, tree).write();
}

std::string_view MemoryImage::bytes() const {
  static_assert(std::endian::native == std::endian::little, "the lowest bits come first");
  return {reinterpret_cast<const char*>(lines_.data()), lines_.size() * sizeof(MemoryLine)};
}

}  // namespace raygate
