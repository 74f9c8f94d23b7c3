#include "host/bvh/bvh.h"

#include <limits>

#include "host/base/threads.h"
#include "host/bvh/sah_builder.h"

// Collapsing a binary BVH to eight children per node
//
// The children of a wide node are a cut through the binary tree below it. The best tree is found
// from the leaves up (Ylitie, Karras, Laine, "Efficient incoherent ray traversal on GPUs through
// compressed wide BVHs", 2017). Let C(n, i) be the least cost of the subtree of binary node n if
// the subtree becomes at most i children of a wide node. Let A be the probability that a ray which
// meets the root's box meets the box of n: the ratio of their surface areas. Then
//   C(n, 1) is the lesser of A kNodeCost + C(n, 8) (inner node) and A kLeafCost (leaf);
//   C(n, i) is the lesser of C(n, i - 1) and C(left, k) + C(right, i - k) for the best k.

namespace raygate {
namespace {

using Ref = BinaryBvh::Ref;

constexpr std::uint32_t kTreeTask = 4096;  // maximum number of primitives in a task of one thread
constexpr std::uint32_t kLeftOut = std::numeric_limits<std::uint32_t>::max();
constexpr float kNodeCost = 1.0f;
/// [n]: cost of a leaf with n triangles, which are tested at once.
constexpr float kLeafCost[Bvh::kMaxLeafSize + 1] = {0.0f, 0.95f, 1.0f, 1.05f, 1.1f};

/// The optimal ways to replace a binary node by 1 to 8 children of a wide node.
struct Plan {
  float cost[Bvh::kWidth];  ///< [i]: C(n, i + 1); [0]: cost as one child
  std::uint8_t
      left[Bvh::kWidth];  ///< [i]: how many of i + 1 children are from the left; 0: use i children
  bool is_leaf;
};

}  // namespace

/// Collapses a binary BVH to a wide one.
class BvhWriter {
 public:
  BvhWriter(Bvh& bvh, std::span<const glm::vec3> positions, std::span<const Triangle> triangles,
            const BinaryBvh& tree, int threads)
      : bvh_(bvh),
        positions_(positions),
        triangles_(triangles),
        tree_(tree),
        threads_(threads),
        plans_(tree.size()) {}

  void write() {
    bvh_.nodes_.assign(1, {});
    clear(bvh_.nodes_[0]);
    const std::size_t primitives = tree_.size() - bvh_.instances_.size();
    bvh_.triangles_.resize(primitives);
    bvh_.places_.resize(primitives);
    bvh_.corners_.resize(9 * primitives + Bvh::kMaxLeafSize);
    if (tree_.size() == 0) return;
    number_primitives();
    unit_ = unit_of(tree_.box(tree_.root()));
    plan_all();
    if (is_leaf(tree_.root())) {
      put_child(bvh_.nodes_[0], 0, tree_.root());
    } else {
      write_all();
    }
  }

 private:
  /// If some of the tree's primitives are instances, numbers the others in first_primitives_.
  void number_primitives() {
    if (!bvh_.has_instances()) return;
    first_primitives_.reserve(tree_.size());
    std::uint32_t primitives = 0;
    for (const Primitive& primitive : tree_.primitives) {
      first_primitives_.push_back(primitives);
      primitives += is_triangle(primitive);
    }
  }
  [[nodiscard]] bool is_triangle(const Primitive& primitive) const {
    return primitive.number < triangles_.size();
  }
  [[nodiscard]] bool are_triangles(Ref ref) const {
    return !bvh_.has_instances() ||
           std::ranges::all_of(
               std::span(tree_.primitives).subspan(tree_.first(ref), tree_.count(ref)),
               [&](const Primitive& p) { return is_triangle(p); });
  }

  /// A task for one thread: writing the subtree of a binary node with at most kTreeTask primitives.
  struct Task {
    Ref ref;
    std::uint32_t parent;  ///< index of the parent in the BVH
    int child;
    std::vector<Bvh::Node> nodes;
    std::uint32_t offset;
  };

  static void clear(Bvh::Node& node) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    for (auto& lows : node.bounds[0]) std::ranges::fill(lows, kInfinity);
    for (auto& highs : node.bounds[1]) std::ranges::fill(highs, -kInfinity);
    std::ranges::fill(node.child, Bvh::Child{});
  }

  [[nodiscard]] float area(Ref ref) const { return half_area(tree_.box(ref), unit_); }
  [[nodiscard]] float cost(Ref ref, int children) const {
    return tree_.is_leaf(ref) ? kLeafCost[1] * area(ref) : plans_[ref].cost[children - 1];
  }

  /// Sets the node's Plan: the least cost of its subtree as 1 to 8 children, and whether it becomes
  /// a leaf. Its children's Plans must be set.
  void plan(Ref ref) {
    const auto [left, right] = tree_.nodes[ref].child;
    Plan& plan = plans_[ref];
    float left_cost[Bvh::kWidth], right_cost[Bvh::kWidth];
    for (int i = 1; i < Bvh::kWidth; ++i) {
      left_cost[i] = cost(left, i);
      right_cost[i] = cost(right, i);
    }
    for (int i = Bvh::kWidth; i > 1; --i) {
      float best = std::numeric_limits<float>::infinity();
      for (int k = 1; k < i; ++k) {
        const float both = left_cost[k] + right_cost[i - k];
        if (both >= best) continue;
        best = both;
        plan.left[i - 1] = static_cast<std::uint8_t>(k);
      }
      plan.cost[i - 1] = best;
    }
    const std::uint32_t count = tree_.count(ref);
    const float own_area = area(ref);
    plan.cost[0] = plan.cost[Bvh::kWidth - 1] + kNodeCost * own_area;
    plan.is_leaf = count <= Bvh::kMaxLeafSize && kLeafCost[count] * own_area <= plan.cost[0] &&
                   are_triangles(ref);
    if (plan.is_leaf) plan.cost[0] = kLeafCost[count] * own_area;
    for (int i = 2; i < Bvh::kWidth; ++i) {
      if (plan.cost[i - 1] < plan.cost[i - 2]) continue;
      plan.cost[i - 1] = plan.cost[i - 2];
      plan.left[i - 1] = 0;
    }
  }

  void plan_below(Ref ref) {
    if (tree_.is_leaf(ref)) return;
    plan_below(tree_.nodes[ref].child[0]);
    plan_below(tree_.nodes[ref].child[1]);
    plan(ref);
  }

  void plan_all() {
    std::vector<Ref> large, tasks;  // parents before children
    collect_tasks(tree_.root(), large, tasks);
    for_each_on_threads(threads_, tasks.size(), [&](std::size_t i) { plan_below(tasks[i]); });
    for (auto ref = large.rbegin(); ref != large.rend(); ++ref) plan(*ref);
  }

  void collect_tasks(Ref ref, std::vector<Ref>& large, std::vector<Ref>& tasks) const {
    if (tree_.count(ref) <= kTreeTask) {
      tasks.push_back(ref);
      return;
    }
    large.push_back(ref);
    for (const Ref child : tree_.nodes[ref].child) collect_tasks(child, large, tasks);
  }

  /// Appends the nodes, at most `most`, that replace `ref` among the children of a wide node.
  void collect_children(Ref ref, int most, Ref (&children)[Bvh::kWidth], int& count) const {
    if (most > 1 && !tree_.is_leaf(ref)) {
      const Plan& plan = plans_[ref];
      int i = most;
      while (i > 1 && plan.left[i - 1] == 0) --i;
      if (i > 1) {
        const int left = plan.left[i - 1];
        collect_children(tree_.nodes[ref].child[0], left, children, count);
        collect_children(tree_.nodes[ref].child[1], i - left, children, count);
        return;
      }
    }
    children[count++] = ref;
  }

  /// Stores `ref` as child i of a node. If `ref` is an inner node, the caller sets its index.
  RAYGATE_INLINE void put_child(Bvh::Node& node, int i, Ref ref) {
    const Box box = tree_.box(ref);
    for (int k = 0; k < 3; ++k) {
      node.bounds[0][k][i] = box[k];
      node.bounds[1][k][i] = -box[k + 4];
    }
    if (!is_leaf(ref)) return;
    const std::uint32_t first = tree_.first(ref);
    const Primitive& primitive = tree_.primitives[first];
    if (!is_triangle(primitive)) {
      node.child[i] = {bvh_.instances_[primitive.number - triangles_.size()].first, 0};
      return;
    }
    node.child[i] = {first_primitives_.empty() ? first : first_primitives_[first],
                     tree_.count(ref)};
    write_primitives(node.child[i], first);
  }

  [[nodiscard]] bool is_leaf(Ref ref) const { return tree_.is_leaf(ref) || plans_[ref].is_leaf; }

  /// Writes a leaf, whose primitives begin at tree_.primitives[first].
  void write_primitives(const Bvh::Child& leaf, std::uint32_t first) {
    float* const to = &bvh_.corners_[9 * std::size_t{leaf.first}];
    for (std::uint32_t i = 0; i < leaf.count; ++i) {
      const std::uint32_t primitive = leaf.first + i, triangle = tree_.primitives[first + i].number;
      bvh_.triangles_[primitive] = triangle;
      bvh_.places_[primitive] = {static_cast<std::uint8_t>(i),
                                 static_cast<std::uint8_t>(leaf.count)};
      for (std::uint32_t v = 0; v < 3; ++v) {
        const glm::vec3& corner = positions_[triangles_[triangle].vertices[v]];
        for (std::uint32_t k = 0; k < 3; ++k) {
          to[(3 * v + k) * leaf.count + i] = corner[static_cast<int>(k)];
        }
      }
    }
  }

  /// Writes `ref` to nodes[index] and appends its descendants to `nodes`. If `tasks` is not null,
  /// subtrees of up to kTreeTask primitives are appended to `tasks` instead.
  void write_below(std::vector<Bvh::Node>& nodes, std::uint32_t index, Ref ref,
                   std::vector<Task>* tasks) {
    Ref children[Bvh::kWidth];
    int count = 0;
    collect_children(ref, Bvh::kWidth, children, count);
    clear(nodes[index]);
    for (int i = 0; i < count; ++i) {
      put_child(nodes[index], i, children[i]);
      if (is_leaf(children[i])) continue;
      if (tasks != nullptr && tree_.count(children[i]) <= kTreeTask) {
        tasks->push_back({children[i], index, i, {}, 0});
        continue;
      }
      const auto next = static_cast<std::uint32_t>(nodes.size());
      nodes[index].child[i] = {next, 0};
      nodes.emplace_back();
      write_below(nodes, next, children[i], tasks);
    }
  }

  void write_all() {
    std::vector<Bvh::Node>& nodes = bvh_.nodes_;
    std::vector<Task> tasks;
    write_below(nodes, 0, tree_.root(), &tasks);
    for_each_on_threads(threads_, tasks.size(), [&](std::size_t i) {
      tasks[i].nodes.reserve(tree_.count(tasks[i].ref) / 4 + 1);
      tasks[i].nodes.emplace_back();
      write_below(tasks[i].nodes, 0, tasks[i].ref, nullptr);
    });
    std::size_t size = nodes.size();
    for (Task& task : tasks) {
      task.offset = static_cast<std::uint32_t>(size);
      nodes[task.parent].child[task.child] = {task.offset, 0};
      size += task.nodes.size();
    }
    nodes.resize(size);
    for_each_on_threads(threads_, tasks.size(), [&](std::size_t i) {
      Bvh::Node* to = &nodes[tasks[i].offset];
      for (Bvh::Node& node : tasks[i].nodes) {
        for (Bvh::Child& child : node.child) {
          if (child.count == 0 && !bvh_.is_instanced(child.first)) child.first += tasks[i].offset;
        }
        *to++ = node;
      }
    });
  }

  Bvh& bvh_;
  std::span<const glm::vec3> positions_;
  std::span<const Triangle> triangles_;
  const BinaryBvh& tree_;
  int threads_;
  float unit_ = 0.0f;
  std::vector<Plan> plans_;
  std::vector<std::uint32_t> first_primitives_;  // index in the BVH by index in tree_; empty: same
};

void Bvh::build(std::span<const glm::vec3> positions, std::span<const Triangle> triangles,
                int most_levels, int threads) {
  std::vector<Primitive> primitives(triangles.size());
  const std::size_t tasks = (primitives.size() + kTreeTask - 1) / kTreeTask;
  for_each_on_threads(threads, tasks, [&](std::size_t task) {
    const std::size_t end = std::min((task + 1) * kTreeTask, primitives.size());
    for (std::size_t i = task * kTreeTask; i < end; ++i) {
      const auto& [a, b, c] = triangles[i].vertices;
      Box box = box_around(positions[a], positions[b], positions[c]);
      // Widens bounds near 0: rays from 0 would have subnormal distances to them, which some
      // processors multiply slowly.
      box = absolute(box) < 0x1p-120f ? Box{} - 0x1p-120f : box;
      primitives[i] =
          Primitive(box, is_left_out(triangles[i]) ? kLeftOut : static_cast<std::uint32_t>(i));
    }
  });
  std::erase_if(primitives, [](const Primitive& one) { return one.number == kLeftOut; });
  auto number = static_cast<std::uint32_t>(triangles.size());
  for (const InstanceBvh& at : instances_) {
    Node root;
    make_instance_node(at.first, root);
    const auto [low, high] = root.box();
    const Box box = {low.x, low.y, low.z, 0.0f, -high.x, -high.y, -high.z, 0.0f};
    primitives.push_back(Primitive(box, number++));
  }
  const BinaryBvh tree(std::move(primitives), most_levels, threads);
  BvhWriter(*this, positions, triangles, tree, threads).write();
}

Bvh::Bvh(const Scene& scene, int threads) {
  const int levels = scene.instances.empty() ? 0 : add_instances(scene, threads);
  build(scene.positions, scene.triangles, kMaxDepth - levels, threads);
  rests_ = scene.rests;
  faces_ = scene.triangles;
}

void Bvh::add_rests(std::uint32_t triangle, Corners& corners) const {
  for (std::size_t v = 0; v < 3; ++v) {
    const std::uint32_t vertex = faces_[triangle].vertices[v];
    if (vertex >= rests_.size()) continue;
    for (int k = 0; k < 3; ++k) {
      corners[v][k] = with_rest(static_cast<float>(corners[v][k]), rests_[vertex][k]);
    }
  }
}

}  // namespace raygate
