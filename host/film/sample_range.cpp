#include "host/film/sample_range.h"

#include <algorithm>
#include <charconv>
#include <utility>

namespace raygate {
namespace {

const std::string* option_of(const ExrMetadata& metadata, const std::string& name) {
  const auto at =
      std::ranges::find(metadata.options, name, &std::pair<std::string, std::string>::first);
  return at == metadata.options.end() ? nullptr : &at->second;
}

}  // namespace

std::optional<SampleRange> parse_sample_range(const std::string& text) {
  SampleRange range;
  const char *at = text.data(), *const end = at + text.size();
  const auto first = std::from_chars(at, end, range.first);
  if (first.ec != std::errc() || first.ptr == end || *first.ptr != ':') return std::nullopt;
  const auto last = std::from_chars(first.ptr + 1, end, range.end);
  if (last.ec != std::errc() || last.ptr != end) return std::nullopt;
  if (range.first < 0 || range.first >= range.end) return std::nullopt;
  return range;
}

std::string to_string(const SampleRange& range) {
  return std::to_string(range.first) + ":" + std::to_string(range.end);
}

SampleRange samples_of(const ExrMetadata& metadata) {
  const std::string* const range = option_of(metadata, kSamplesAttribute);
  const std::string* const all = option_of(metadata, "spp");
  if (range != nullptr) return parse_sample_range(*range).value_or(SampleRange{});
  return all == nullptr ? SampleRange{} : parse_sample_range("0:" + *all).value_or(SampleRange{});
}

void set_samples(ExrMetadata& metadata, const SampleRange& range) {
  std::erase_if(metadata.options,
                [](const auto& option) { return option.first == kSamplesAttribute; });
  const SampleRange all = samples_of(metadata);
  if (range.first == all.first && range.end == all.end) return;
  metadata.options.emplace_back(kSamplesAttribute, to_string(range));
}

}  // namespace raygate
