#include "host/bvh/sah_builder.h"

#include <bit>
#include <memory>
#include <span>
#include <utility>

#include "host/base/threads.h"

namespace raygate {
namespace {

constexpr std::uint32_t kTaskSize = 4096;  // ranges up to this size are built by one thread
constexpr int kRunsOfThread = 64;          // ranges per thread, to balance the load
// In ranges up to this size all splits are tried, in larger ones only splits between bins.
constexpr std::uint32_t kFew = 4;
constexpr int kBins = 16;  // number of bins per axis; half of it for ranges smaller than kMany
constexpr std::uint32_t kMany = 64;
constexpr float kNever = std::numeric_limits<float>::infinity();

/// A range of primitives that becomes a node, and its parent.
struct Run {
  std::uint32_t begin, end;
  int depth;
  std::uint32_t parent;
  int side;
  [[nodiscard]] std::uint32_t size() const { return end - begin; }
};

/// Returns a box's centre in lanes 0 to 2, and its negation in lanes 4 to 6: a box of size 0.
RAYGATE_INLINE Box middle_of(const Box& box) {
  const FloatLanes half = 0.5f * box;
  return half - __builtin_shufflevector(half, half, 4, 5, 6, 7, 0, 1, 2, 3);
}

/// Bins of equal size along each axis of the box around the centres of a range's primitives.
struct Slices {
  int count;
  FloatLanes low, scale;  ///< by axis, in lanes 0 to 2

  RAYGATE_INLINE Slices(const Box& middles, std::uint32_t size)
      : count(size < kMany ? kBins / 2 : kBins), low(middles), scale{} {
    for (int k = 0; k < 3; ++k) {
      const float extent = -(middles[k + 4] + middles[k]);
      constexpr float kMost = std::numeric_limits<float>::max();
      scale[k] = extent > 0.0f ? std::min(static_cast<float>(count) / extent, kMost) : 0.0f;
    }
  }
  /// Returns, by axis in lanes 0 to 2, the index of the bin that contains a box's centre.
  [[nodiscard]] RAYGATE_INLINE IntLanes of(const Box& box) const {
    Box middle = (middle_of(box) - low) * scale;
    middle[3] = 0.0f;
    return minimum(whole(middle), IntLanes{} + (count - 1));
  }
};

/// A split: bins below `part` go left or, in a range of up to kFew, the first `part` primitives.
struct Cut {
  float cost = kNever;  ///< area times count, summed over both sides
  int axis = 0;
  int part = 0;
};

/// Replaces `best` if a split between two of these parts (bins or single primitives) is cheaper.
RAYGATE_INLINE void find_cut(const Box* boxes, const std::uint32_t* counts, int parts, int axis,
                             float unit, Cut& best) {
  float right_cost[kBins];
  Box box = empty_box();
  std::uint32_t count = 0;
  for (int part = parts - 1; part > 0; --part) {
    grow(box, boxes[part]);
    count += counts[part];
    right_cost[part] = count == 0 ? kNever : half_area(box, unit) * static_cast<float>(count);
  }
  box = empty_box();
  count = 0;
  for (int part = 1; part < parts; ++part) {
    grow(box, boxes[part - 1]);
    count += counts[part - 1];
    if (count == 0) continue;
    const float cost = half_area(box, unit) * static_cast<float>(count) + right_cost[part];
    if (cost < best.cost) best = {cost, axis, part};
  }
}

RAYGATE_INLINE void cut_between_slices(std::span<const Primitive> run, const Slices& slices,
                                       float unit, Cut& best) {
  Box boxes[3][kBins];
  std::uint32_t counts[3][kBins] = {};
  for (auto& axis : boxes) {
    for (int i = 0; i < slices.count; ++i) axis[i] = empty_box();
  }
  const auto put = [&](const Primitive& primitive) __attribute__((always_inline)) {
    const Box box = primitive.box();
    const IntLanes slice = slices.of(box);
    for (int axis = 0; axis < 3; ++axis) {
      grow(boxes[axis][slice[axis]], box);
      ++counts[axis][slice[axis]];
    }
  };
  // Successive primitives are often in the same bins. Alternating between the halves of the range
  // avoids waiting for a bin's last update.
  const std::size_t half = run.size() / 2;
  for (std::size_t i = 0; i < half; ++i) {
    put(run[i]);
    put(run[half + i]);
  }
  if (run.size() % 2 != 0) put(run.back());
  for (int axis = 0; axis < 3; ++axis) {
    if (slices.scale[axis] > 0.0f) {
      find_cut(boxes[axis], counts[axis], slices.count, axis, unit, best);
    }
  }
}

/// Moves the primitives in bins below the split to the front, stably, and returns their number.
/// `room` is a buffer as large as the range.
RAYGATE_INLINE std::uint32_t part_at(const Cut& cut, const Slices& slices, std::span<Primitive> run,
                                     Primitive* room) {
  const float low = slices.low[cut.axis], scale = slices.scale[cut.axis];
  const auto limit = static_cast<float>(cut.part);
  std::uint32_t left = 0, right = 0;
  for (const Primitive& primitive : run) {
    const bool is_left = (primitive.middle(cut.axis) - low) * scale < limit;
    room[right] = primitive;
    run[left] = primitive;  // replaces itself, or a primitive that has been copied
    left += is_left;
    right += !is_left;
  }
  std::copy_n(room, right, run.begin() + left);
  return left;
}

/// Sorts a few primitives by their centres along an axis; stable.
RAYGATE_INLINE void sort_along(std::span<Primitive> run, int axis) {
  for (std::size_t i = 1; i < run.size(); ++i) {
    const Primitive moved = run[i];
    std::size_t place = i;
    for (; place > 0 && run[place - 1].middle(axis) > moved.middle(axis); --place) {
      run[place] = run[place - 1];
    }
    run[place] = moved;
  }
}

RAYGATE_INLINE void cut_few(std::span<Primitive> run, float unit, Cut& best) {
  constexpr std::uint32_t kOnes[kFew] = {1, 1, 1, 1};
  for (int axis = 0; axis < 3; ++axis) {
    sort_along(run, axis);
    Box boxes[kFew];
    for (std::size_t i = 0; i < run.size(); ++i) boxes[i] = run[i].box();
    find_cut(boxes, kOnes, static_cast<int>(run.size()), axis, unit, best);
  }
  if (best.axis != 2) sort_along(run, best.axis);
}

/// Splits a range in two, returns the size of the first part, and sets `box` to the range's bounds.
/// Splits in halves if no split is found, or near the maximum depth (`depths_left` levels away).
/// `room` is a buffer as large as the range.
std::uint32_t cut_run(std::span<Primitive> run, Primitive* room, int depths_left, Box& box) {
  return in_vectors([&](auto) RAYGATE_BODY -> std::uint32_t {
    const auto size = static_cast<std::uint32_t>(run.size());
    Box bounds = empty_box(), middles = empty_box();  // around primitives, around their centres
    for (const Primitive& primitive : run) {
      grow(bounds, primitive.box());
      grow(middles, middle_of(primitive.box()));
    }
    box = bounds;
    if (size == 2) return 1;
    Cut cut;
    const bool is_deep = static_cast<int>(std::bit_width(size)) >= depths_left;
    if (is_deep) {
      std::ranges::stable_sort(run, {},
                               [](const Primitive& primitive) { return primitive.middle(0); });
    } else if (size <= kFew) {
      cut_few(run, unit_of(box), cut);
      if (cut.part > 0) return static_cast<std::uint32_t>(cut.part);
    } else {
      const Slices slices(middles, size);
      cut_between_slices(run, slices, unit_of(box), cut);
      if (cut.cost < kNever) return part_at(cut, slices, run, room);
    }
    return size / 2;
  });
}

/// Splits ranges until each has one primitive.
class SahBuilder {
 public:
  SahBuilder(BinaryBvh& tree, int max_depth)
      : tree_(tree),
        max_depth_(max_depth),
        room_(std::make_unique_for_overwrite<Primitive[]>(tree.size())) {}

  /// Splits large ranges level by level until there are enough for all threads. Then each range is
  /// split by one thread, depth first.
  void build(int threads) {
    const auto enough = static_cast<std::size_t>(kRunsOfThread) * static_cast<std::size_t>(threads);
    std::vector<Run> large = {{0, tree_.size(), 0, 0, 0}}, small;
    while (!large.empty() && large.size() < enough) {
      std::vector<Run> parts(2 * large.size());
      for_each_on_threads(threads, large.size(),
                          [&](std::size_t i) { split(large[i], &parts[2 * i]); });
      large.clear();
      for (const Run& run : parts) {
        if (run.size() != 0) (run.size() > kTaskSize ? large : small).push_back(run);
      }
    }
    large.insert(large.end(), small.begin(), small.end());
    for_each_on_threads(threads, large.size(), [&](std::size_t i) { split_all(large[i]); });
  }

 private:
  /// Splits a range into parts[0] and parts[1]. A range of one primitive becomes a leaf instead.
  void split(const Run& run, Run* parts) {
    if (run.size() == 1) {
      tree_.nodes[run.parent].child[run.side] = tree_.size() + run.begin;
      return;
    }
    Box box;
    const std::span<Primitive> primitives(tree_.primitives);
    const std::uint32_t middle =
        run.begin + cut_run(primitives.subspan(run.begin, run.size()), &room_[run.begin],
                            max_depth_ - run.depth, box);
    BinaryBvh::Node& node = tree_.nodes[middle];
    node.box = box;
    node.first = run.begin;
    node.count = run.size();
    tree_.nodes[run.parent].child[run.side] = middle;
    parts[0] = {run.begin, middle, run.depth + 1, middle, 0};
    parts[1] = {middle, run.end, run.depth + 1, middle, 1};
  }

  void split_all(const Run& run) {
    Run parts[2];
    split(run, parts);
    if (run.size() == 1) return;
    split_all(parts[0]);
    split_all(parts[1]);
  }

  BinaryBvh& tree_;
  int max_depth_;
  std::unique_ptr<Primitive[]> room_;
};

}  // namespace

BinaryBvh::BinaryBvh(std::vector<Primitive> boxes, int max_depth, int threads)
    : primitives(std::move(boxes)), nodes(primitives.size()) {
  if (!primitives.empty()) SahBuilder(*this, max_depth).build(threads);
}

}  // namespace raygate
