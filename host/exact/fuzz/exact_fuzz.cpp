// libFuzzer target: compares the predicates with rationals, for any bytes as ray and triangle.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "host/exact/test/bit_patterns.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  raygate::test::Patterns words{};
  std::memcpy(words.data(), data, std::min(size, sizeof words));
  const std::string wrong = raygate::test::disagreement(words);
  if (wrong.empty()) return 0;
  std::fprintf(stderr, "%s is wrong\n", wrong.c_str());
  std::abort();
}
