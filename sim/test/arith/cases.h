// The operands that adders and multipliers are tested with, for the tests and for sim/mutate.
#pragma once

#include <cstdint>
#include <random>
#include <vector>

namespace raygate {

/// Adder operands of up to 64 bits; each function calls check(a, b, carry).

/// Every sum of 8 bits and a carry; the bits above are random, for wider adders.
template <class Check>
void all_sums_of_8_bits(const Check& check) {
  std::mt19937_64 random(1);
  for (std::uint64_t low = 0; low < 1 << 17; ++low) {
    const std::uint64_t a = (random() << 8) | (low & 0xff);
    const std::uint64_t b = (random() << 8) | (low >> 8 & 0xff);
    check(a, b, (low >> 16) != 0);
  }
}

/// A carry born at every bit that runs to every other bit, through ones in either operand.
template <class Check>
void carry_chains(const Check& check) {
  std::mt19937_64 random(2);
  for (int first = 0; first < 64; ++first) {
    for (int last = first; last < 64; ++last) {
      const std::uint64_t above = last == 63 ? 0 : ~std::uint64_t{0} << (last + 1);
      const std::uint64_t chain = ~above & (~std::uint64_t{0} << first);
      const std::uint64_t birth = std::uint64_t{1} << first;
      const std::uint64_t split = random();
      check(chain, birth, false);
      check(chain & split, (chain & ~split) + birth, false);
      check(chain ^ birth, ~chain, first == 0);
      check(~chain, chain, true);
    }
  }
}

/// Runs of zeros and ones of random lengths, where carries are born, run and die.
template <class Check>
void random_runs(const Check& check) {
  std::mt19937_64 random(3);
  const auto runs = [&random] {
    std::uint64_t word = random();
    for (int k = random() % 4; k > 0; --k) word ^= ~std::uint64_t{0} << random() % 64;
    return random() % 2 != 0 ? word : word & random() & random();
  };
  for (int i = 0; i < 100'000; ++i) {
    const std::uint64_t a = runs();
    const std::uint64_t b = random() % 2 != 0 ? runs() : ~a ^ (std::uint64_t{1} << random() % 64);
    check(a, b, random() % 2 != 0);
  }
}

/// Multiplier operands of up to 32 bits; each function calls check(a, b).

/// Every product of 8 bits; the bits above are random, for wider multipliers.
template <class Check>
void all_products_of_8_bits(const Check& check) {
  std::mt19937 random(1);
  for (std::uint32_t low = 0; low < 1 << 16; ++low) {
    const std::uint32_t a = (random() << 8) | (low & 0xff);
    const std::uint32_t b = (random() << 8) | (low >> 8);
    check(a, b);
  }
}

/// Every Booth digit at every place, alone and among others; single bits, runs, their neighbours.
template <class Check>
void structured_products(const Check& check) {
  std::vector<std::uint32_t> words = {0,          ~0u,        0x55555555, 0xaaaaaaaa,
                                      0x33333333, 0xcccccccc, 0x92492492, 0x6db6db6d};
  for (int bit = 0; bit < 32; ++bit) {
    const std::uint32_t one = 1u << bit;
    for (std::uint32_t word : {one, one - 1, one + 1, ~one, 3 * one, 5 * one, 7 * one, 0u - one}) {
      words.push_back(word);
    }
  }
  for (std::uint32_t a : words) {
    for (std::uint32_t b : words) check(a, b);
  }
}

template <class Check>
void random_products(const Check& check) {
  std::mt19937 random(2);
  for (int i = 0; i < 100'000; ++i) {
    const std::uint32_t a = random();
    check(a, static_cast<std::uint32_t>(random()));
  }
}

}  // namespace raygate
