#include "host/lab/stress/errors.h"

#include <algorithm>
#include <bit>
#include <numeric>
#include <stdexcept>

namespace raygate::stress {
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

double end_of(std::size_t bin) {
  return bin == 0 ? 0.0 : std::bit_cast<double>((kFirst + bin) << kShift);
}

}  // namespace

Errors::Errors(const std::map<std::size_t, std::uint64_t>& bins, double max) : max_(max) {
  for (const auto& [bin, count] : bins) {
    bins_.resize(kBins);
    if (bin >= kBins) throw std::invalid_argument("no such bin");
    bins_[bin] = count;
  }
}

void Errors::add(double error) {
  bins_.resize(kBins);
  ++bins_[bin_of(error)];
  max_ = std::max(max_, error);
}

void Errors::add(const Errors& other) {
  if (other.bins_.empty()) return;
  bins_.resize(kBins);
  for (std::size_t bin = 0; bin < kBins; ++bin) bins_[bin] += other.bins_[bin];
  max_ = std::max(max_, other.max_);
}

std::map<std::size_t, std::uint64_t> Errors::bins() const {
  std::map<std::size_t, std::uint64_t> filled;
  for (std::size_t bin = 0; bin < bins_.size(); ++bin) {
    if (bins_[bin] != 0) filled[bin] = bins_[bin];
  }
  return filled;
}

Errors::Summary Errors::summary() const {
  const auto count = std::reduce(bins_.begin(), bins_.end(), std::uint64_t{0});
  if (count == 0) return {};
  const auto quantile = [&](std::uint64_t rank) {  // of the one with `rank` smaller ones
    std::size_t bin = 0;
    for (std::uint64_t seen = bins_[0]; seen <= rank; seen += bins_[bin]) ++bin;
    return bin + 1 == kBins ? max_ : std::min(end_of(bin), max_);
  };
  return {count, quantile((count - 1) / 2), quantile((count - 1) - (count - 1) / 100), max_};
}

}  // namespace raygate::stress
