#include "host/lab/variants/rtl_variant_units.h"

#include <array>
#include <cstring>
#include <string_view>
#include <utility>

#include "host/lab/variants/variant_models.h"
#include "host/variants/variant_hit_tester.h"
#include "sim/array_model.h"
#include "sim/plane_model.h"
#include "sim/rtl_plane_unit.h"

namespace raygate {
namespace {

/// Numbers of any format in a port of one lane, the first in the lowest bits.
class PackedNumbers {
 public:
  explicit PackedNumbers(const Arithmetic& math) : math_(math) {}

  template <class Port>
  void write(Port& port, int, const float* x, int count) const {
    Bits bits{};
    for (int i = 0; i < count; ++i) {
      const std::uint64_t word = math_.to_word(x[i]);
      const std::size_t at = place(i) / 64, shift = place(i) % 64;
      bits[at] |= word << shift;
      if (shift != 0) bits[at + 1] |= word >> (64 - shift);
    }
    static_assert(sizeof port <= sizeof bits);
    std::memcpy(&port, bits.data(), sizeof port);
  }

  template <class Port>
  void read(const Port& port, int, float* x, int count) const {
    Bits bits{};
    std::memcpy(bits.data(), &port, sizeof port);
    for (int i = 0; i < count; ++i) {
      const std::size_t at = place(i) / 64, shift = place(i) % 64;
      const std::uint64_t above = shift != 0 ? bits[at + 1] << (64 - shift) : 0;
      const std::uint64_t mask = (std::uint64_t{1} << math_.word_bits()) - 1;
      x[i] = math_.from_word(static_cast<std::uint32_t>((bits[at] >> shift | above) & mask));
    }
  }

  [[nodiscard]] std::uint32_t to_word(float x) const { return math_.to_word(math_.read(x)); }
  [[nodiscard]] float from_word(std::uint32_t word) const { return math_.from_word(word); }

 private:
  using Bits = std::array<std::uint64_t, 9>;  // sixteen 32-bit words, and one for overflow
  [[nodiscard]] std::size_t place(int i) const {
    return static_cast<std::size_t>(i * math_.word_bits());
  }

  Arithmetic math_;
};

/// Returns whether a model with these parameters implements the variant.
bool matches(const Variant& variant, int exponent_bits, int digits, int rounding,
             int quotient_digits, std::string_view brought) {
  const Arithmetic& math = variant.math;
  return variant.has_hardware() && variant.brought == brought &&
         math.exponent_bits == exponent_bits && math.digits == digits &&
         math.rounding == static_cast<Rounding>(rounding) &&
         math.quotient_digits == quotient_digits;
}

}  // namespace

std::unique_ptr<BurstUnit> make_rtl_burst_unit([[maybe_unused]] const Variant& variant) {
#define RAYGATE_MODEL(top, ...)                                                                \
  if (matches(variant, __VA_ARGS__))                                                           \
    return std::make_unique<RtlBurstUnit>(std::make_unique<ArrayModel<top, 1, PackedNumbers>>( \
        1, BurstStalls{}, PackedNumbers(variant.math)));
  RAYGATE_PIPELINE_MODELS
#undef RAYGATE_MODEL
  return nullptr;
}

std::unique_ptr<PlaneUnit> make_rtl_plane_unit([[maybe_unused]] const Variant& variant) {
#define RAYGATE_MODEL(top, ...)            \
  if (matches(variant, __VA_ARGS__))       \
    return std::make_unique<RtlPlaneUnit>( \
        std::make_unique<PlaneModelOf<top, PackedNumbers>>(PackedNumbers(variant.math)));
  RAYGATE_SERIAL_MODELS
#undef RAYGATE_MODEL
  return nullptr;
}

std::unique_ptr<HitTester> make_rtl_variant_tester(const Variant& variant) {
  if (variant.unit == Variant::Unit::kSerial) {
    auto unit = make_rtl_plane_unit(variant);
    return unit ? make_variant_tester(variant, std::move(unit)) : nullptr;
  }
  auto unit = make_rtl_burst_unit(variant);
  return unit ? make_variant_tester(variant, std::move(unit)) : nullptr;
}

}  // namespace raygate
