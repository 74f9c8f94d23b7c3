#include "host/tree/binary_tree.h"

#include <algorithm>
#include <bit>
#include <condition_variable>
#include <limits>
#include <mutex>
#include <span>

#include "host/threads.h"

namespace raygate {
namespace {

constexpr std::uint32_t kTaskSize = 4096;  // runs no longer than that are one thread's
constexpr std::uint32_t kSweptSize = 8;    // of these all splits are tried, of others those of bins
constexpr int kBins = 16;
constexpr double kNever = std::numeric_limits<double>::infinity();

/// A run of primitives that becomes a node, and whose child it is.
struct Run {
  std::uint32_t begin, end;
  int depth;
  std::uint32_t parent;
  int side;
  [[nodiscard]] std::uint32_t size() const { return end - begin; }
};

/// A box's middle in lanes 0 to 2, and turned in lanes 4 to 6: a box of no size.
RAYGATE_INLINE void middle_of(const Box& box, Box& middle) {
  const FloatLanes half = 0.5f * box;
  middle = half - __builtin_shufflevector(half, half, 4, 5, 6, 7, 0, 1, 2, 3);
}

/// What is around a run, and around the middles of what is in it.
struct Around {
  Box box, middles;
};

/// Equal slices of the middles' box on each axis.
struct Slices {
  IntLanes last;  ///< in lanes 0 to 2
  FloatLanes low, scale;

  RAYGATE_INLINE explicit Slices(const Box& middles) : low(middles), scale{} {
    for (int k = 0; k < 3; ++k) {
      const float extent = -(middles[k + 4] + middles[k]);
      constexpr float kMost = std::numeric_limits<float>::max();
      scale[k] = extent > 0.0f ? std::min(kBins / extent, kMost) : 0.0f;
    }
    low[3] = low[7] = 0.0f;
    last = IntLanes{} + (kBins - 1);
  }
  /// Of a middle; lanes 0 to 2. A primitive's lane 3 is anything: its scale is 0.
  RAYGATE_INLINE void of(const Box& box, IntLanes& slice) const {
    Box middle;
    middle_of(box, middle);
    middle[3] = middle[7] = 0.0f;
    slice = __builtin_convertvector((middle - low) * scale, IntLanes);
    slice = slice < last ? slice : last;
  }
};

/// Where to cut a run: what is in slices below `slice` goes left; or, swept, the `slice` first in
/// the order of middles.
struct Cut {
  double cost = kNever;  ///< a sum of area times count
  int axis = 0;
  int slice = 0;
};

RAYGATE_INLINE void look_at(std::span<const Primitive> run, Around& around) {
  clear(around.box);
  clear(around.middles);
  for (const Primitive& primitive : run) {
    Box middle;
    middle_of(primitive.box, middle);
    grow(around.box, primitive.box);
    grow(around.middles, middle);
  }
}

/// The cheapest cut between parts of these boxes and counts.
RAYGATE_INLINE void cheapest_cut(const Box* boxes, const std::uint32_t* counts, int parts, int axis,
                                 Cut& best) {
  double right_cost[kBins];
  Box box;
  clear(box);
  std::uint32_t count = 0;
  for (int part = parts - 1; part > 0; --part) {
    grow(box, boxes[part]);
    count += counts[part];
    right_cost[part] = count == 0 ? kNever : half_area(box) * count;
  }
  clear(box);
  count = 0;
  for (int part = 1; part < parts; ++part) {
    grow(box, boxes[part - 1]);
    count += counts[part - 1];
    if (count == 0) continue;
    const double cost = half_area(box) * count + right_cost[part];
    if (cost < best.cost) best = {cost, axis, part};
  }
}

RAYGATE_INLINE void cut_between_slices(std::span<const Primitive> run, const Slices& slices,
                                       Cut& best) {
  Box boxes[3][kBins];
  std::uint32_t counts[3][kBins] = {};
  for (auto& axis : boxes) {
    for (Box& box : axis) clear(box);
  }
  for (const Primitive& primitive : run) {
    IntLanes slice;
    slices.of(primitive.box, slice);
    for (int axis = 0; axis < 3; ++axis) {
      grow(boxes[axis][slice[axis]], primitive.box);
      ++counts[axis][slice[axis]];
    }
  }
  for (int axis = 0; axis < 3; ++axis) {
    if (slices.scale[axis] > 0.0f) cheapest_cut(boxes[axis], counts[axis], kBins, axis, best);
  }
}

/// Puts a few primitives in the order of their middles along an axis; stable.
RAYGATE_INLINE void sort_along(std::span<Primitive> run, int axis) {
  float keys[kSweptSize];
  for (std::size_t i = 0; i < run.size(); ++i) {
    const Primitive moved = run[i];
    const float key = 0.5f * moved.box[axis] - 0.5f * moved.box[axis + 4];
    std::size_t place = i;
    for (; place > 0 && keys[place - 1] > key; --place) {
      keys[place] = keys[place - 1];
      run[place] = run[place - 1];
    }
    keys[place] = key;
    run[place] = moved;
  }
}

RAYGATE_INLINE void cut_few(std::span<Primitive> run, Cut& best) {
  constexpr std::uint32_t kOnes[kSweptSize] = {1, 1, 1, 1, 1, 1, 1, 1};
  const auto size = static_cast<int>(run.size());
  for (int axis = 0; axis < 3; ++axis) {
    sort_along(run, axis);
    Box boxes[kSweptSize];
    for (int i = 0; i < size; ++i) boxes[i] = run[static_cast<std::size_t>(i)].box;
    cheapest_cut(boxes, kOnes, size, axis, best);
  }
  if (best.axis != 2) sort_along(run, best.axis);
}

}  // namespace

/// Where the run is cut in two; puts its primitives on their sides. Not far from the largest depth
/// halves are split, whatever it costs.
RAYGATE_LANES std::uint32_t cut_run(std::span<Primitive> run, int depth, Box& box) {
  const auto size = static_cast<std::uint32_t>(run.size());
  Around around;
  look_at(run, around);
  box = around.box;
  if (size == 2) return 1;
  const bool is_deep = static_cast<int>(std::bit_width(size)) >= BinaryTree::kMaxDepth - depth;
  Cut cut;
  if (size <= kSweptSize) {
    cut_few(run, cut);
    if (!is_deep && cut.cost < kNever) return static_cast<std::uint32_t>(cut.slice);
  } else {
    const Slices slices(around.middles);
    cut_between_slices(run, slices, cut);
    if (!is_deep && cut.cost < kNever) {
      const auto right = std::partition(run.begin(), run.end(), [&](const Primitive& primitive) {
        IntLanes slice;
        slices.of(primitive.box, slice);
        return slice[cut.axis] < cut.slice;
      });
      return static_cast<std::uint32_t>(right - run.begin());
    }
  }
  const std::uint32_t half = size / 2;
  const auto key = [&](const Primitive& primitive) {
    return 0.5f * primitive.box[cut.axis] - 0.5f * primitive.box[cut.axis + 4];
  };
  std::ranges::nth_element(run, run.begin() + half, {}, key);
  return half;
}

namespace {

/// Cuts runs up to the last one.
class Divider {
 public:
  explicit Divider(BinaryTree& tree) : tree_(tree) {
    waiting_.push_back({0, tree.size(), 0, 0, 0});
  }

  /// What each thread does.
  void work() {
    std::unique_lock lock(mutex_);
    for (;;) {
      changed_.wait(lock, [&] { return !waiting_.empty() || busy_ == 0; });
      if (waiting_.empty()) return;
      const Run run = waiting_.back();
      waiting_.pop_back();
      ++busy_;
      lock.unlock();
      Run sides[2];
      if (run.size() <= kTaskSize) {
        divide_all(run);
      } else {
        divide(run, sides);
      }
      lock.lock();
      --busy_;
      if (run.size() > kTaskSize) waiting_.insert(waiting_.end(), {sides[0], sides[1]});
      changed_.notify_all();
    }
  }

 private:
  void divide(const Run& run, Run (&sides)[2]) {
    if (run.size() == 1) {
      tree_.nodes[run.parent].child[run.side] = tree_.size() + run.begin;
      return;
    }
    Box box;
    const std::span<Primitive> primitives(tree_.primitives);
    const std::uint32_t middle =
        run.begin + cut_run(primitives.subspan(run.begin, run.size()), run.depth, box);
    BinaryTree::Node& node = tree_.nodes[middle];
    node.box = box;
    node.first = run.begin;
    node.count = run.size();
    tree_.nodes[run.parent].child[run.side] = middle;
    sides[0] = {run.begin, middle, run.depth + 1, middle, 0};
    sides[1] = {middle, run.end, run.depth + 1, middle, 1};
  }

  void divide_all(const Run& run) {
    Run sides[2];
    divide(run, sides);
    if (run.size() == 1) return;
    divide_all(sides[0]);
    divide_all(sides[1]);
  }

  BinaryTree& tree_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Run> waiting_;
  int busy_ = 0;
};

}  // namespace

BinaryTree::BinaryTree(const Scene& scene, int threads)
    : primitives(scene.triangles.size()), nodes(scene.triangles.size()) {
  if (primitives.empty()) return;
  const std::size_t tasks = (primitives.size() + kTaskSize - 1) / kTaskSize;
  for_each_on_threads(threads, tasks, [&](std::size_t task) {
    const std::size_t begin = task * kTaskSize;
    const std::size_t end = std::min(begin + kTaskSize, primitives.size());
    for (std::size_t i = begin; i < end; ++i) {
      const auto& [a, b, c] = scene.triangles[i].vertices;
      Box& box = primitives[i].box;
      box_around(scene.positions[a], scene.positions[b], scene.positions[c], box);
      box[3] = std::bit_cast<float>(static_cast<std::uint32_t>(i));
    }
  });
  Divider divider(*this);
  on_threads(static_cast<int>(std::min<std::size_t>(threads, tasks)), [&] { divider.work(); });
}

}  // namespace raygate
