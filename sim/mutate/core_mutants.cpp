// Which single faults of a core the vectors of `make test` catch.
//
//   core_mutants CORE FAULTS [ONE_IN]
//
// FAULTS: the list that sim/mutate/netlist.py wrote, or "-": numbers of faults on standard input.
// ONE_IN: only every so many of the vectors, all (1) unless said. Prints the numbers of the faults
// that survive, one a line.
#include <cstdlib>
#include <cstring>
#include <exception>
#include <fstream>
#include <iostream>
#include <iterator>
#include <numeric>
#include <string>

#include "Vadder_graded_mutants.h"
#include "Vadder_ripple_mutants.h"
#include "Vadder_uniform_mutants.h"
#include "Vbooth_multiplier_mutants.h"
#include "Vfp_adder_mutants.h"
#include "Vfp_divider_mutants.h"
#include "Vfp_multiplier_mutants.h"
#include "sim/fp/vectors.h"
#include "sim/mutate/array_mutants.h"
#include "sim/mutate/faults.h"
#include "sim/test/arith/cases.h"
#include "sim/test/fp/oracle.h"

namespace raygate {
namespace {

using Numbers = std::vector<std::uint32_t>;

/// Lets every one_in-th through.
class Sieve {
 public:
  explicit Sieve(std::uint64_t one_in) : one_in_(one_in) {}
  bool operator()() { return count_++ % one_in_ == 0; }

 private:
  std::uint64_t one_in_, count_ = 0;
};

struct FloatCase {
  FloatOp op = FloatOp::kAdd;
  OperandPair operands;
  RoundingMode rounding = RoundingMode::kNearestEven;
  Tininess tininess = Tininess::kBeforeRounding;
  FloatResult expected;
};

/// The pairs of FormatTest in binary32, in all modes, against the oracle.
template <class Top>
Numbers float_survivors(const Numbers& faults, std::uint64_t one_in,
                        const std::vector<FloatOp>& ops) {
  Faults<Top> alive(faults);
  Blocks<FloatCase> blocks([&](const std::vector<FloatCase>& cases) {
    alive.run(cases, [](Model<Top>& model, const FloatCase& one) {
      model->a_i = one.operands.a;
      model->b_i = one.operands.b;
      model->rounding_mode_i = static_cast<std::uint8_t>(one.rounding);
      model->tininess_after_i = static_cast<std::uint8_t>(one.tininess);
      if constexpr (requires { model->subtract_i; }) model->subtract_i = one.op == FloatOp::kSub;
      model.eval();
      return model->result_o != one.expected.bits || model->flags_o != one.expected.flags;
    });
  });
  const auto pair = [&](FloatOp op, OperandPair operands) {
    const ExactValue exact = exact_result(kBinary32, op, operands.a, operands.b);
    for (const RoundingMode rounding :
         {RoundingMode::kNearestEven, RoundingMode::kTowardZero, RoundingMode::kDown,
          RoundingMode::kUp, RoundingMode::kNearestMaxMagnitude}) {
      for (const Tininess tininess : {Tininess::kBeforeRounding, Tininess::kAfterRounding}) {
        blocks.add(
            {op, operands, rounding, tininess, round_exact(kBinary32, exact, rounding, tininess)});
      }
    }
  };
  Sieve wanted(one_in);
  for (const FloatOp op : ops) {
    PairSource source(kBinary32, op, 1);
    for (int i = 0; i < 1'000'000; ++i) {
      const OperandPair operands = source.next();
      if (wanted()) pair(op, operands);
    }
    for (const OperandPair& operands : crossed_edges(kBinary32)) {
      if (wanted()) pair(op, operands);
    }
  }
  blocks.flush();
  return alive.survivors();
}

struct SumCase {
  std::uint64_t a, b;
  bool carry;
};

template <class Top>
Numbers adder_survivors(const Numbers& faults, std::uint64_t one_in) {
  constexpr std::uint64_t kMask = (std::uint64_t{1} << 48) - 1;
  Faults<Top> alive(faults);
  Blocks<SumCase> blocks([&](const std::vector<SumCase>& cases) {
    alive.run(cases, [](Model<Top>& model, const SumCase& one) {
      model->a_i = one.a & kMask;
      model->b_i = one.b & kMask;
      model->carry_i = one.carry;
      model.eval();
      const std::uint64_t sum = (one.a & kMask) + (one.b & kMask) + (one.carry ? 1 : 0);
      return model->sum_o != (sum & kMask) || model->carry_o != sum >> 48;
    });
  });
  Sieve wanted(one_in);
  const auto add = [&](std::uint64_t a, std::uint64_t b, bool carry) {
    if (wanted()) blocks.add({a, b, carry});
  };
  random_runs(add);
  carry_chains(add);
  all_sums_of_8_bits(add);
  blocks.flush();
  return alive.survivors();
}

Numbers multiplier_survivors(const Numbers& faults, std::uint64_t one_in) {
  using Top = Vbooth_multiplier_mutants;
  struct Factors {
    std::uint32_t a, b;
  };
  Faults<Top> alive(faults);
  Blocks<Factors> blocks([&](const std::vector<Factors>& cases) {
    alive.run(cases, [](Model<Top>& model, const Factors& one) {
      model->a_i = one.a;
      model->b_i = one.b;
      model.eval();
      return model->product_o != std::uint64_t{one.a} * one.b;
    });
  });
  Sieve wanted(one_in);
  const auto multiply = [&](std::uint32_t a, std::uint32_t b) {
    if (wanted()) blocks.add({a & 0xffffff, b & 0xffffff});
  };
  random_products(multiply);
  structured_products(multiply);
  all_products_of_8_bits(multiply);
  blocks.flush();
  return alive.survivors();
}

Numbers survivors(const std::string& core, const Numbers& faults, std::uint64_t one_in) {
  if (core == "fp_adder") {
    return float_survivors<Vfp_adder_mutants>(faults, one_in, {FloatOp::kAdd, FloatOp::kSub});
  }
  if (core == "fp_multiplier") {
    return float_survivors<Vfp_multiplier_mutants>(faults, one_in, {FloatOp::kMul});
  }
  if (core == "fp_divider") {
    return float_survivors<Vfp_divider_mutants>(faults, one_in, {FloatOp::kDiv});
  }
  if (core == "booth_multiplier") return multiplier_survivors(faults, one_in);
  if (core == "adder_ripple") return adder_survivors<Vadder_ripple_mutants>(faults, one_in);
  if (core == "adder_uniform") return adder_survivors<Vadder_uniform_mutants>(faults, one_in);
  if (core == "adder_graded") return adder_survivors<Vadder_graded_mutants>(faults, one_in);
  if (core == "hit_test_array") return array_survivors(faults, one_in);
  throw std::invalid_argument("no core " + core);
}

/// As many faults as the list has lines; or those whose numbers standard input gives.
Numbers read_faults(const std::string& list) {
  if (list == "-") return {std::istream_iterator<std::uint32_t>(std::cin), {}};
  std::ifstream file(list);
  Numbers faults(static_cast<std::size_t>(
      std::count(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>(), '\n')));
  std::iota(faults.begin(), faults.end(), 1u);
  if (faults.empty()) throw std::invalid_argument(list + ": no faults");
  return faults;
}

}  // namespace
}  // namespace raygate

int main(int argc, char** argv) {
  if (argc != 3 && argc != 4) {
    std::cerr << "usage: core_mutants CORE FAULTS|- [ONE_IN]\n";
    return 2;
  }
  try {
    const std::uint64_t one_in = argc == 4 ? std::strtoull(argv[3], nullptr, 10) : 1;
    if (one_in == 0) throw std::invalid_argument("ONE_IN is 0, expected 1 or more");
    for (const std::uint32_t fault :
         raygate::survivors(argv[1], raygate::read_faults(argv[2]), one_in)) {
      std::cout << fault << '\n';
    }
  } catch (const std::invalid_argument& error) {
    std::cerr << "core_mutants: " << error.what() << '\n';
    return 2;
  } catch (const std::exception& error) {
    std::cerr << "core_mutants: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
