#include "sim/test/fp/oracle.h"

#define MPFR_USE_INTMAX_T  // mpfr_get_uj
#include <mpfr.h>

#include <bit>
#include <cmath>

namespace raygate {
namespace {

// Returns the number as a double, exactly: a double can represent every format of up to 32 bits.
double to_double(FloatFormat format, std::uint32_t bits) {
  const int field = static_cast<int>(bits >> format.frac_bits) & format.max_field();
  const std::uint32_t fraction = bits & format.frac_mask();
  const double sign = (bits & format.sign_bit()) != 0 ? -1.0 : 1.0;
  if (field == format.max_field()) return fraction != 0 ? NAN : sign * INFINITY;
  const double significand = field == 0 ? fraction : fraction + std::ldexp(1.0, format.frac_bits);
  const int exponent = (field == 0 ? 1 : field) - format.bias() - format.frac_bits;
  return sign * std::ldexp(significand, exponent);
}

// MPFR's precision in bits: more than two significands of binary32, and within a machine word.
constexpr mpfr_prec_t kPrecision = 62;

struct Scratch {
  mpfr_t a, b, result;
  Scratch() { mpfr_inits2(kPrecision, a, b, result, static_cast<mpfr_ptr>(nullptr)); }
  ~Scratch() { mpfr_clears(a, b, result, static_cast<mpfr_ptr>(nullptr)); }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
};

}  // namespace

ExactValue exact_result(FloatFormat format, FloatOp op, std::uint32_t a, std::uint32_t b) {
  static thread_local Scratch mp;
  ExactValue out;
  if (format.is_signaling(a) || format.is_signaling(b)) out.flags |= kInvalid;
  if (format.is_nan(a) || format.is_nan(b)) {
    out.kind = ExactValue::Kind::kNan;
    return out;
  }
  mpfr_set_d(mp.a, to_double(format, a), MPFR_RNDZ);
  mpfr_set_d(mp.b, to_double(format, b), MPFR_RNDZ);
  mpfr_clear_divby0();
  int ternary = 0;
  switch (op) {
    case FloatOp::kAdd:
      ternary = mpfr_add(mp.result, mp.a, mp.b, MPFR_RNDZ);
      break;
    case FloatOp::kSub:
      ternary = mpfr_sub(mp.result, mp.a, mp.b, MPFR_RNDZ);
      break;
    case FloatOp::kMul:
      ternary = mpfr_mul(mp.result, mp.a, mp.b, MPFR_RNDZ);
      break;
    default:
      ternary = mpfr_div(mp.result, mp.a, mp.b, MPFR_RNDZ);
      break;
  }
  if (mpfr_nan_p(mp.result)) {  // an invalid operation: no operand is a NaN
    out.kind = ExactValue::Kind::kNan;
    out.flags |= kInvalid;
    return out;
  }
  if (mpfr_divby0_p()) out.flags |= kDivideByZero;
  out.negative = mpfr_signbit(mp.result) != 0;
  if (mpfr_inf_p(mp.result)) {
    out.kind = ExactValue::Kind::kInfinity;
    return out;
  }
  if (mpfr_zero_p(mp.result)) {
    const bool b_negative = (mpfr_signbit(mp.b) != 0) != (op == FloatOp::kSub);  // as an addend
    out.exact_zero_sum = (op == FloatOp::kAdd || op == FloatOp::kSub) &&
                         (!mpfr_zero_p(mp.a) || (mpfr_signbit(mp.a) != 0) != b_negative);
    return out;
  }
  out.inexact = ternary != 0;
  long exponent = 0;
  mpfr_get_d_2exp(&exponent, mp.result, MPFR_RNDZ);  // |result| = [0.5, 1) * 2^exponent
  mpfr_mul_2si(mp.result, mp.result, kPrecision - exponent, MPFR_RNDZ);
  mpfr_abs(mp.result, mp.result, MPFR_RNDZ);
  out.significand = mpfr_get_uj(mp.result, MPFR_RNDZ);
  out.exponent = static_cast<int>(exponent - kPrecision);
  return out;
}

namespace {

struct Rounded {
  std::uint64_t units = 0;  // multiples of 2^quantum
  bool inexact = false;
};

// Returns |value| as a multiple of 2^quantum; requires quantum > value.exponent.
Rounded round_to(const ExactValue& value, int quantum, RoundingMode rounding) {
  const int shift = quantum - value.exponent;
  if (shift > 63) {  // below a quarter of a unit
    const bool up = rounding == (value.negative ? RoundingMode::kDown : RoundingMode::kUp);
    return {up ? 1u : 0u, true};
  }
  const std::uint64_t half = std::uint64_t{1} << (shift - 1);
  const std::uint64_t rest = value.significand & (2 * half - 1);
  const bool inexact = rest != 0 || value.inexact;
  const std::uint64_t floor = value.significand >> shift;
  bool up = false;
  switch (rounding) {
    case RoundingMode::kNearestEven:
      up = rest > half || (rest == half && (value.inexact || floor % 2 == 1));
      break;
    case RoundingMode::kNearestMaxMagnitude:
      up = rest >= half;
      break;
    case RoundingMode::kTowardZero:
      break;
    case RoundingMode::kDown:
      up = inexact && value.negative;
      break;
    case RoundingMode::kUp:
      up = inexact && !value.negative;
      break;
  }
  return {floor + (up ? 1 : 0), inexact};
}

}  // namespace

FloatResult round_exact(FloatFormat format, const ExactValue& value, RoundingMode rounding,
                        Tininess tininess) {
  if (value.kind == ExactValue::Kind::kNan) return {format.quiet_nan(), value.flags};
  const bool negative = value.exact_zero_sum ? rounding == RoundingMode::kDown : value.negative;
  const std::uint32_t sign = negative ? format.sign_bit() : 0;
  if (value.kind == ExactValue::Kind::kInfinity) return {sign | format.infinity(), value.flags};
  if (value.significand == 0) return {sign, value.flags};

  const int lead =
      value.exponent + static_cast<int>(std::bit_width(value.significand)) - 1;  // floor(log2)
  const int min_exponent = 1 - format.bias();
  const int free_quantum = lead - format.frac_bits;  // quantum if exponents were unbounded
  const int min_quantum = min_exponent - format.frac_bits;
  const int quantum = free_quantum > min_quantum ? free_quantum : min_quantum;

  bool tiny = lead < min_exponent;
  if (tiny && tininess == Tininess::kAfterRounding) {
    const Rounded free = round_to(value, free_quantum, rounding);
    tiny = free_quantum + static_cast<int>(std::bit_width(free.units)) - 1 < min_exponent;
  }

  const Rounded rounded = round_to(value, quantum, rounding);
  FloatResult out{0, value.flags};
  if (rounded.inexact) out.flags |= kInexact | (tiny ? kUnderflow : 0);

  // Largest finite number: all ones at the largest exponent.
  const int top = quantum + static_cast<int>(std::bit_width(rounded.units)) - 1;
  if (rounded.units != 0 && top > format.bias()) {
    out.flags |= kOverflow | kInexact;
    const bool to_infinity = rounding == RoundingMode::kNearestEven ||
                             rounding == RoundingMode::kNearestMaxMagnitude ||
                             rounding == (negative ? RoundingMode::kDown : RoundingMode::kUp);
    out.bits = sign | (format.infinity() - (to_infinity ? 0 : 1));
    return out;
  }
  // Packed words count the representable numbers from zero upwards: exponent field and fraction
  // together are the units plus 2^frac_bits for each step of the quantum.
  out.bits = sign | static_cast<std::uint32_t>(
                        rounded.units +
                        (static_cast<std::uint64_t>(quantum - min_quantum) << format.frac_bits));
  return out;
}

FloatResult oracle_compare(FloatFormat format, FloatOp op, std::uint32_t a, std::uint32_t b) {
  const double x = to_double(format, a);
  const double y = to_double(format, b);
  const bool signaling = format.is_signaling(a) || format.is_signaling(b);
  const bool unordered = std::isnan(x) || std::isnan(y);
  const std::uint8_t flags = signaling || (unordered && op != FloatOp::kEq) ? kInvalid : 0;
  const bool holds = op == FloatOp::kEq ? x == y : op == FloatOp::kLt ? x < y : x <= y;
  return {holds, flags};
}

}  // namespace raygate
