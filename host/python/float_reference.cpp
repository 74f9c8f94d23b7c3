#include "host/python/float_reference.h"

#include <nanobind/ndarray.h>
#include <nanobind/stl/pair.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
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

constexpr std::size_t kCheckpointOperations = 1 << 12;

/// Arrays of results and their flags.
class Results {
 public:
  explicit Results(std::size_t count) : bits_(count), flags_(count) {}

  void put(std::size_t i, FloatResult result) {
    bits_[i] = result.bits;
    flags_[i] = result.flags;
  }
  /// Returns the bits and the flags, arrays that own their elements.
  Columns release() { return {array_of(std::move(bits_)), array_of(std::move(flags_))}; }

 private:
  template <class T>
  static Owned<T> array_of(std::vector<T> values) {
    auto owner = std::make_unique<std::vector<T>>(std::move(values));
    std::vector<T>& kept = *owner;
    const nb::capsule capsule(owner.release(),
                              [](void* p) noexcept { delete static_cast<std::vector<T>*>(p); });
    return Owned<T>(kept.data(), {kept.size()}, capsule);
  }

  std::vector<std::uint32_t> bits_;
  std::vector<std::uint8_t> flags_;
};

/// Both columns have the same length, and all words fit the format; float.py checks that.
Columns run(int op, const Column<std::uint32_t>& a, const Column<std::uint32_t>& b, int exp_bits,
            int frac_bits, int rounding, bool before) {
  const FloatFormat format{exp_bits, frac_bits};
  const auto operation = static_cast<FloatOp>(op);
  const Tininess tininess = before ? Tininess::kBeforeRounding : Tininess::kAfterRounding;
  Results results(a.shape(0));
  {
    const nb::gil_scoped_release release;
    for (std::size_t i = 0; i < a.shape(0); ++i) {
      if (i % kCheckpointOperations == 0) checkpoint();
      const std::uint32_t x = a.data()[i], y = b.data()[i];
      results.put(i, is_comparison(operation)
                         ? oracle_compare(format, operation, x, y)
                         : round_exact(format, exact_result(format, operation, x, y),
                                       rounding_of(rounding), tininess));
    }
  }
  return results.release();
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
  Results results(values.shape(0));
  {
    const nb::gil_scoped_release release;
    for (std::size_t i = 0; i < values.shape(0); ++i) {
      if (i % kCheckpointOperations == 0) checkpoint();
      results.put(i, round_exact({exp_bits, frac_bits}, exact_value(values.data()[i]),
                                 rounding_of(rounding),
                                 before ? Tininess::kBeforeRounding : Tininess::kAfterRounding));
    }
  }
  return results.release();
}

}  // namespace

void add_float_reference(nb::module_& m) {
  m.def("float_run", &run);
  m.def("float_encode", &encode);
}

}  // namespace raygate
