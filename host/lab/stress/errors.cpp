#include "host/lab/stress/errors.h"

#include <algorithm>
#include <bit>

namespace raygate::lab {
namespace {

// A bin holds the doubles that agree in sign, exponent and six bits of the fraction. The first one
// ends with 2^-64 and holds 0, the last one begins with 2^64.
constexpr int kShift = 52 - 6;
constexpr std::uint64_t kFirst = std::bit_cast<std::uint64_t>(0x1p-64) >> kShift;
constexpr std::size_t kBins = (std::bit_cast<std::uint64_t>(0x1p64) >> kShift) - kFirst + 2;

std::size_t bin_of(double error) {
  const std::uint64_t place = std::bit_cast<std::uint64_t>(error) >> kShift;
  return place < kFirst ? 0 : std::min<std::size_t>(place - kFirst + 1, kBins - 1);
}

}  // namespace

void Errors::add(double error) {
  bins_.resize(kBins);
  ++bins_[bin_of(error)];
  max_ = std::max(max_, error);
}

std::vector<std::pair<double, std::uint64_t>> Errors::bins() const {
  std::vector<std::pair<double, std::uint64_t>> filled;
  for (std::size_t bin = 0; bin < bins_.size(); ++bin) {
    if (bins_[bin] == 0) continue;
    filled.emplace_back(std::bit_cast<double>((kFirst + bin) << kShift), bins_[bin]);
  }
  return filled;
}

}  // namespace raygate::lab
