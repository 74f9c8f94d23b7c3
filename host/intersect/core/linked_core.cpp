#include "host/intersect/core/linked_core.h"

#include <algorithm>
#include <cstring>

#include "host/intersect/core/core_words.h"

namespace raygate {
namespace {

void send_all(WordLink& link, std::span<const std::uint32_t> words) {
  for (const std::uint32_t word : words) {
    while (!link.send(word)) link.wait();
  }
}

}  // namespace

void LinkedCore::load(std::span<const MemoryLine> lines) {
  const auto same = [](const MemoryLine& a, const MemoryLine& b) { return a.words == b.words; };
  if (!memory_.empty() && std::ranges::equal(lines, memory_, same)) return;
  memory_.assign(lines.begin(), lines.end());
  for (std::uint32_t number = 0; number < lines.size(); ++number) {
    send_all(*link_, line_message(number, lines[number]));
  }
  const std::uint32_t changed = lines_message(static_cast<std::uint32_t>(lines.size()));
  send_all(*link_, {&changed, 1});
}

std::optional<CoreResult> LinkedCore::take_result() {
  while (const std::optional<std::uint32_t> word = link_->receive()) {
    words_.push_back(*word);
    if (words_.size() < std::tuple_size_v<ResultWords>) continue;
    const CoreResult result = unpack_result(words_);
    words_.clear();
    return result;
  }
  return std::nullopt;
}

void LinkedCore::count(const CoreResult& result) {
  switch (result.kind) {
    case CoreResult::Kind::kEnd:
      ++counters_.rays;
      counters_.triangles += result.tests;
      break;
    case CoreResult::Kind::kDoubt:
      ++counters_.doubts;
      break;
  }
}

void LinkedCore::trace(std::span<const MemoryLine> lines, std::span<const CoreRay> rays,
                       std::vector<CoreResult>& results) {
  load(lines);
  const std::uint64_t begin = link_->clocks();
  std::size_t sent = 0, ended = 0;
  std::vector<std::uint32_t> out;  // words of the ray that is being sent, the last first
  for (;;) {
    // Results first: what they make room for is sent before there is any waiting.
    while (const std::optional<CoreResult> result = take_result()) {
      count(*result);
      ended += result->kind == CoreResult::Kind::kEnd;
      results.push_back(*result);
    }
    if (ended == rays.size()) break;
    if (out.empty() && sent < rays.size() && sent - ended < most_) {
      const RayMessage message = ray_message(rays[sent++]);
      out.assign(message.rbegin(), message.rend());
    }
    if (!out.empty() && link_->send(out.back())) out.pop_back();
    link_->wait();
  }
  counters_.clocks += link_->clocks() - begin;
}

}  // namespace raygate
