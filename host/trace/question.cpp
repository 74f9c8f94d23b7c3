#include "host/trace/question.h"

#include <algorithm>

#include "host/base/input_error.h"

namespace raygate {

std::vector<Answer> columns_of(std::span<const std::string> names, Hits hits, bool is_cpu,
                               const std::string& dashes) {
  using enum Answer;
  // Units keep nearest hits alone.
  if (hits == Hits::kAll && !is_cpu) {
    throw InputError(dashes + "engine: expected cpu with " + dashes + "hits all");
  }
  if (names.empty()) {
    if (hits == Hits::kAny) return {kRay, kHit};
    return {kRay, kHit, kTriangle, kObject, kT, kPoint, kUv, kNormal, kDoubts};
  }
  std::vector<Answer> columns;
  const auto fail = [&](const std::string& name, const std::string& expected) {
    throw InputError(dashes + "columns: found '" + name + "', expected " + expected);
  };
  for (const std::string& name : names) {
    const auto* const at = std::ranges::find(kAnswerNames, name);
    if (at == std::end(kAnswerNames)) {
      std::string list;
      for (const std::string_view word : kAnswerNames) {
        list.append(list.empty() ? "" : ", ").append(word);
      }
      fail(name, "some of " + list);
    }
    const auto answer = static_cast<Answer>(at - std::begin(kAnswerNames));
    if (std::ranges::find(columns, answer) != columns.end()) fail(name, "each name once");
    // Which hit is found first is the engine's affair; that there is one is not.
    if (hits == Hits::kAny && answer != kRay && answer != kHit && answer != kDoubts) {
      fail(name, "ray, hit or doubts with " + dashes + "hits any");
    }
    if (hits == Hits::kAll && (answer == kUnitPoint || answer == kUnitError)) {
      fail(name, "none of the unit's with " + dashes + "hits all");
    }
    columns.push_back(answer);
  }
  return columns;
}

}  // namespace raygate
