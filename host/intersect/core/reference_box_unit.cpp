#include "host/intersect/core/reference_box_unit.h"

#include <algorithm>
#include <bit>
#include <cstdlib>

// Names and steps are those of hw/ray_core/box_unit.sv, which has the proof.

namespace raygate {
namespace {

constexpr int kFracBits = 22, kEnterBits = 12;
constexpr std::int64_t kWhole = std::int64_t{1} << kFracBits;  // 2^E, in units

int field(float x) { return static_cast<int>(std::bit_cast<std::uint32_t>(x) >> 23 & 0xFF); }

/// Returns the significand with its integer bit, also for zeros and subnormals (below all units).
std::int64_t significand(float x) {
  return (std::bit_cast<std::uint32_t>(x) & 0x7FFFFF) | 0x800000;
}

/// Returns x >> amount for any amount: 0 beyond the word size, x if negative.
std::int64_t shift_right(std::int64_t x, int amount) {
  if (amount <= 0) return x;
  return amount > 63 ? 0 : x >> amount;
}

/// An axis, seen from the ray. Planes of the grid are at a +- q s / 256, in units.
struct Axis {
  bool back;               // the ray goes towards smaller q
  std::int64_t near, far;  // a without and with the error margin
  std::int64_t step;       // s
};

}  // namespace

BoxGroup enter_boxes(const NodeLine& node, const BoxRay& ray) {
  // The ray surely leaves the node before 2^E.
  float distance[3];
  int exponent = field(ray.t_max) == 0xFF ? 511 : field(ray.t_max) + 1;
  for (int k = 0; k < 3; ++k) {
    distance[k] = node.origin[k] - ray.origin[k];
    const int inverse = field(ray.inverse[k]);
    if (inverse == 0xFF) continue;
    const int reach = std::max(field(distance[k]) + 1, node.exponent[k] + 8);
    exponent = std::min(exponent, reach + inverse - 125);
  }
  exponent = std::clamp(exponent, 27, 511);

  Axis axes[3];
  for (int k = 0; k < 3; ++k) {
    const bool back = std::signbit(ray.inverse[k]);
    const int cap = exponent - node.exponent[k] + 129;  // exponent field of the largest inverse
    const bool capped = field(ray.inverse[k]) >= cap || field(ray.inverse[k]) == 0xFF;
    float inverse = ray.inverse[k];
    if (capped) {
      inverse = std::bit_cast<float>(static_cast<std::uint32_t>(cap & 0xFF) << 23 |
                                     (back ? 0x80000000u : 0u));
    }
    const float product = distance[k] * inverse;
    const bool open = (capped && (cap < 1 || cap > 254)) || field(product) == 0xFF;
    const int amount = exponent + 11 - field(product);
    const std::int64_t size =
        amount <= 0 ? std::int64_t{1} << 33 : shift_right(significand(product) << 10, amount);
    const std::int64_t a = std::signbit(product) ? -size : size;
    std::int64_t step = shift_right(significand(inverse) << 9, cap - field(inverse));
    std::int64_t room = (size >> 22) + (step >> 24) + 6;
    if (capped) room += kWhole;
    axes[k] = {back, a - room, a + room, step};
    if (open) axes[k] = {back, -(std::int64_t{1} << 33), std::int64_t{1} << 33, 0};
  }

  // The limit, rounded up.
  const int amount = exponent + 1 - field(ray.t_max);
  const std::int64_t limit = amount <= 1 ? kWhole : shift_right(significand(ray.t_max), amount) + 1;

  std::array<std::int64_t, NodeLine::kChildren> keys;  // {skipped, enter, number}
  std::array<std::uint32_t, NodeLine::kChildren> offset;
  std::uint32_t next = 0;
  int size = 0;
  for (std::size_t i = 0; i < NodeLine::kChildren; ++i) {
    const NodeLine::Child& child = node.child[i];
    offset[i] = next;
    next += child.size();
    std::int64_t enter = 0, leave = limit;
    for (std::size_t k = 0; k < 3; ++k) {
      const Axis& axis = axes[k];
      const auto at = [&](std::int64_t from, std::uint8_t q) {
        const std::int64_t way = (q * axis.step) >> 8;
        return axis.back ? from - way : from + way;
      };
      enter = std::max(enter, at(axis.near, axis.back ? child.high[k] : child.low[k]));
      leave = std::min(leave, at(axis.far, axis.back ? child.low[k] : child.high[k]));
    }
    if (ray.no_cull) enter = leave = 0;
    const bool met = child.kind != NodeLine::kAbsent && enter <= leave;
    size += met ? 1 : 0;
    keys[i] = (std::int64_t{!met} << 26) | (met ? enter << 3 : 0) | static_cast<std::int64_t>(i);
  }
  std::ranges::sort(keys);

  BoxGroup group{.base = node.base, .exponent = static_cast<std::uint32_t>(exponent), .size = size};
  for (int n = 0; n < size; ++n) {
    const auto i = static_cast<std::size_t>(keys[static_cast<std::size_t>(n)] & 7);
    const auto enter = static_cast<std::uint32_t>(keys[static_cast<std::size_t>(n)] >> 3);
    const std::uint32_t kind = node.child[i].kind;
    group.entry[static_cast<std::size_t>(n)] = {
        std::min(enter >> (kFracBits - kEnterBits), (1u << kEnterBits) - 1), offset[i],
        kind == NodeLine::kInner ? 0 : kind};
  }
  return group;
}

bool is_beyond(const BoxGroup& group, const BoxGroup::Entry& entry, float limit) {
  // The limit in the entry's units, rounded down.
  const int amount = static_cast<int>(group.exponent) + 23 - kEnterBits - field(limit);
  if (amount <= 0) return false;  // at least 2^23 units
  return entry.enter > shift_right(significand(limit), amount);
}

}  // namespace raygate
