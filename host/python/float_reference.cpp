#include "host/python/float_reference.h"

#include <nanobind/stl/pair.h>

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "host/base/threads.h"
#include "sim/fp/float_format.h"
#include "sim/test/fp/oracle.h"

namespace nb = nanobind;

namespace raygate {
namespace {

template <class T>
using Column = nb::ndarray<const T, nb::ndim<1>, nb::device::cpu, nb::c_contig>;

template <class T>
using Owned = nb::ndarray<nb::numpy, T, nb::ndim<1>>;
using Columns = std::pair<Owned<std::uint32_t>, Owned<std::uint8_t>>;

/// Returns the bits and the flags of compute(0), compute(1) and so on.
template <class Compute>
Columns columns_of(std::size_t count, const Compute& compute) {
  constexpr std::size_t kCheckpointOperations = 1 << 12;
  const auto bits = std::make_shared<std::vector<std::uint32_t>>(count);
  const auto flags = std::make_shared<std::vector<std::uint8_t>>(count);
  {
    const nb::gil_scoped_release release;
    for (std::size_t i = 0; i < count; ++i) {
      if (i % kCheckpointOperations == 0) checkpoint();
      const FloatResult result = compute(i);
      (*bits)[i] = result.bits;
      (*flags)[i] = result.flags;
    }
  }
  return {Owned<std::uint32_t>(array_of<std::uint32_t>(bits, bits->data(), {count})),
          Owned<std::uint8_t>(array_of<std::uint8_t>(flags, flags->data(), {count}))};
}

Tininess tininess(bool before) {
  return before ? Tininess::kBeforeRounding : Tininess::kAfterRounding;
}

/// Both columns have the same length, and all words fit the format; float.py checks that.
Columns run(int op, const Column<std::uint32_t>& a, const Column<std::uint32_t>& b, int exp_bits,
            int frac_bits, int rounding, bool before) {
  const FloatFormat format{exp_bits, frac_bits};
  const auto operation = static_cast<FloatOp>(op);
  return columns_of(a.shape(0), [&](std::size_t i) {
    const std::uint32_t x = a.data()[i], y = b.data()[i];
    return is_comparison(operation) ? oracle_compare(format, operation, x, y)
                                    : round_exact(format, exact_result(format, operation, x, y),
                                                  rounding_of(rounding), tininess(before));
  });
}

/// Returns x in the form of exact_result.
ExactValue exact_value(double x) {
  constexpr int kBits = 62;  // of a significand, as in the oracle
  ExactValue value;
  value.negative = std::signbit(x);
  if (std::isnan(x)) {
    value.kind = ExactValue::Kind::kNan;
  } else if (std::isinf(x)) {
    value.kind = ExactValue::Kind::kInfinity;
  } else if (x != 0.0) {
    int exponent = 0;
    value.significand =
        static_cast<std::uint64_t>(std::ldexp(std::frexp(std::abs(x), &exponent), kBits));
    value.exponent = exponent - kBits;
  }
  return value;
}

Columns encode(const Column<double>& values, int exp_bits, int frac_bits, int rounding,
               bool before) {
  return columns_of(values.shape(0), [&](std::size_t i) {
    return round_exact({exp_bits, frac_bits}, exact_value(values.data()[i]), rounding_of(rounding),
                       tininess(before));
  });
}

}  // namespace

void add_float_reference(nb::module_& m) {
  m.def("float_run", &run);
  m.def("float_encode", &encode);
}

}  // namespace raygate
