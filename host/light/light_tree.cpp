#include "host/light/light_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "host/scene/bounds.h"

namespace raygate {
namespace {

/// Returns the axis; if both sides emit alike, flipped so that its largest component is positive.
glm::dvec3 on_one_side(const LightBounds& source) {
  if (source.back < 1.0) return source.axis;
  const glm::dvec3 size = glm::abs(source.axis);
  const int k = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  return source.axis[k] < 0.0 ? -source.axis : source.axis;
}

/// Sums over a group of sources, from which the group's cost is computed.
struct Sum {
  Bounds3 box;
  glm::dvec3 axes{0.0};
  double power = 0.0;

  void add(const LightBounds& source) {
    box.expand(source.middle - source.radius);
    box.expand(source.middle + source.radius);
    // A source that emits to all sides adds nothing: it has no orientation.
    axes += (0.5 + 0.5 * source.spread) * source.power * on_one_side(source);
    power += source.power;
  }
  void add(const Sum& other) {
    box.low = glm::min(box.low, other.box.low);
    box.high = glm::max(box.high, other.box.high);
    axes += other.axes;
    power += other.power;
  }
  /// Returns the error measure of Conty Estevez and Kulla: power times squared size, times the
  /// spread of the axes, from 1 (parallel) to 4 (all directions).
  [[nodiscard]] double cost() const {
    if (!(power > 0.0)) return 0.0;
    const glm::dvec3 size = box.high - box.low;
    return power * glm::dot(size, size) * (4.0 - 3.0 * std::min(glm::length(axes) / power, 1.0));
  }
};

using Group = std::span<std::uint32_t>;  // source indices

}  // namespace

class LightTree::Builder {
 public:
  Builder(std::span<const LightBounds> sources, LightTree& tree)
      : sources_(sources),
        tree_(tree),
        most_power_(std::ranges::max(sources, {}, &LightBounds::power).power) {}

  /// Adds the nodes of a group below child `place` of `parent`; returns the index of the root.
  std::uint32_t add(Group group, std::uint32_t parent, std::uint32_t place) {
    const auto number = static_cast<std::uint32_t>(tree_.nodes_.size());
    tree_.nodes_.emplace_back();
    tree_.nodes_[number].parent = parent;
    tree_.nodes_[number].place = place;
    const std::vector<CostedGroup> children = split_into_eight(group);
    for (std::uint32_t k = 0; k < children.size(); ++k) {
      const Group sources = children[k].sources;
      set(tree_.nodes_[number], k, cluster(sources));
      std::uint32_t child = sources[0] | kIsSource;
      if (sources.size() == 1) {
        tree_.place_of_[sources[0]] = number * kLanes + k;
      } else {
        child = add(sources, number, k);
      }
      tree_.nodes_[number].child[k] = child;
    }
    return number;
  }

 private:
  struct CostedGroup {
    Group sources;
    double cost;
  };
  [[nodiscard]] Sum sum_of(Group group) const {
    Sum sum;
    for (const std::uint32_t number : group) sum.add(sources_[number]);
    return sum;
  }

  /// Splits a group into up to eight groups, always splitting the one with the highest cost.
  [[nodiscard]] std::vector<CostedGroup> split_into_eight(Group group) const {
    std::vector<CostedGroup> groups = {{group, 0.0}};
    while (groups.size() < std::min<std::size_t>(kLanes, group.size())) {
      const auto worst = std::ranges::max_element(groups, {}, [](const CostedGroup& each) {
        return each.sources.size() < 2 ? -1.0 : each.cost;
      });
      const std::size_t size = split(worst->sources);
      const Group first = worst->sources.first(size), rest = worst->sources.subspan(size);
      *worst = {first, sum_of(first).cost()};
      groups.insert(worst + 1, {rest, sum_of(rest).cost()});
    }
    return groups;
  }

  /// Moves the sources that fulfil `is_first` to the front, stably, and returns their number.
  /// (Clang 14 cannot compile the library's std::ranges::stable_partition.)
  template <class IsFirst>
  static std::size_t partitioned(Group group, const IsFirst& is_first) {
    return static_cast<std::size_t>(std::stable_partition(group.begin(), group.end(), is_first) -
                                    group.begin());
  }

  /// Splits a group of two or more in two, and returns the size of the first part.
  [[nodiscard]] std::size_t split(Group group) const {
    const std::size_t far_size =
        partitioned(group, [&](std::uint32_t number) { return sources_[number].is_far; });
    if (far_size != 0 && far_size != group.size()) return far_size;

    constexpr int kBins = 12;
    Bounds3 middles;
    for (const std::uint32_t number : group) middles.expand(sources_[number].middle);
    const glm::dvec3 &low = middles.low, size = middles.high - middles.low;
    double least = std::numeric_limits<double>::infinity();
    int best_axis = -1, best_bin = 0;
    const auto bin_of = [&](std::uint32_t number, int axis) {
      const double share = (sources_[number].middle[axis] - low[axis]) / size[axis];
      return std::min(static_cast<int>(share * kBins), kBins - 1);
    };
    for (int axis = 0; axis < 3; ++axis) {
      if (!(size[axis] > 0.0)) continue;
      std::array<Sum, kBins> bins;
      for (const std::uint32_t number : group) {
        bins[static_cast<std::size_t>(bin_of(number, axis))].add(sources_[number]);
      }
      std::array<double, kBins> above{};
      Sum sum;
      for (std::size_t i = kBins; i-- > 1;) {
        sum.add(bins[i]);
        above[i] = sum.cost();
      }
      sum = {};
      for (int i = 1; i < kBins; ++i) {
        sum.add(bins[static_cast<std::size_t>(i) - 1]);
        const double cost = sum.cost() + above[static_cast<std::size_t>(i)];
        if (cost < least) {
          least = cost;
          best_axis = axis;
          best_bin = i;
        }
      }
    }
    if (best_axis < 0) return group.size() / 2;  // all positions are equal
    return partitioned(group,
                       [&](std::uint32_t number) { return bin_of(number, best_axis) < best_bin; });
  }

  [[nodiscard]] LightBounds cluster(Group group) const {
    LightBounds all = sources_[group[0]];
    if (group.size() == 1) return all;
    const Sum sum = sum_of(group);
    all.power = sum.power;
    if (all.is_far) {
      all.middle = glm::dvec3(0.0);
      all.radius = 1.0;
      return all;
    }
    all.middle = sum.box.middle();
    all.radius = 0.0;
    for (const std::uint32_t number : group) {
      const LightBounds& one = sources_[number];
      all.radius = std::max(all.radius, glm::distance(all.middle, one.middle) + one.radius);
      all.back = std::max(all.back, one.back);
      all.reach = std::min(all.reach, one.reach);
    }
    const double length = glm::length(sum.axes);
    if (length > 0.0) all.axis = sum.axes / length;
    // Cosine of the widest angle from the axis with full emission; -1: all directions.
    all.spread = length > 0.0 ? 1.0 : -1.0;
    for (const std::uint32_t number : group) {
      const LightBounds& one = sources_[number];
      double cosine = glm::dot(all.axis, one.axis);
      if (one.back >= 1.0) cosine = std::abs(cosine);
      cosine = std::clamp(cosine, -1.0, 1.0);
      const double sine = std::sqrt(1.0 - cosine * cosine);
      const double own = std::sqrt(std::max(0.0, 1.0 - one.spread * one.spread));
      // Cosine of the sum of the angles to one.axis and of one.spread; -1 beyond 180 degrees.
      const bool is_all = one.spread < -cosine;
      all.spread = std::min(all.spread, is_all ? -1.0 : cosine * one.spread - sine * own);
    }
    return all;
  }

  void set(Node& node, std::uint32_t place, const LightBounds& source) const {
    // Clamped to the range of float, so that every contributing source has a positive weight.
    constexpr double kLeastPower = 0x1p-60;
    const double relative = source.power / most_power_;
    node.power[place] = static_cast<float>(std::max(relative, kLeastPower));
    node.x[place] = static_cast<float>(source.middle.x);
    node.y[place] = static_cast<float>(source.middle.y);
    node.z[place] = static_cast<float>(source.middle.z);
    node.nearness[place] = source.is_far ? 0.0f : 1.0f;
    constexpr double kRounding = 1.0 + 0x1p-20;
    const double radius = source.radius * kRounding + glm::length(source.middle) * 0x1p-22;
    node.squared_radius[place] =
        static_cast<float>(source.is_far ? source.radius : radius * radius);
    node.axis_x[place] = static_cast<float>(source.axis.x);
    node.axis_y[place] = static_cast<float>(source.axis.y);
    node.axis_z[place] = static_cast<float>(source.axis.z);
    node.spread[place] = static_cast<float>(source.spread);
    node.spread_sine[place] =
        static_cast<float>(std::sqrt(std::max(0.0, 1.0 - source.spread * source.spread)));
    node.reach[place] = static_cast<float>(source.reach);
    node.back[place] = static_cast<float>(source.back);
  }

  std::span<const LightBounds> sources_;
  LightTree& tree_;
  double most_power_;
};

LightTree::LightTree(std::span<const LightBounds> sources) {
  place_of_.assign(sources.size(), kNoIndex);
  std::vector<std::uint32_t> numbers;
  for (std::uint32_t i = 0; i < sources.size(); ++i) {
    if (sources[i].power > 0.0) numbers.push_back(i);
  }
  if (!numbers.empty()) Builder(sources, *this).add(numbers, kNoIndex, 0);
}

}  // namespace raygate
