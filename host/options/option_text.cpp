#include "host/options/option_text.h"

#include <algorithm>
#include <cctype>
#include <numeric>
#include <utility>

#include "host/base/input_error.h"

namespace raygate {
namespace {

/// How many letters to add, leave out, change, or swap with their neighbour make `a` into `b`.
std::size_t changes_between(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1), last, before;
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before = std::exchange(last, row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        row[j] = std::min(row[j], before[j - 2] + 1);
      }
    }
  }
  return row[b.size()];
}

}  // namespace

std::vector<std::string> split_at_commas(const std::string& text) {
  std::vector<std::string> words;
  for (std::size_t start = 0; start <= text.size();) {
    const std::size_t comma = std::min(text.find(',', start), text.size());
    words.push_back(text.substr(start, comma - start));
    start = comma + 1;
  }
  return words;
}

std::string did_you_mean(const std::string& text, std::span<const std::string> words) {
  const auto lower = [](std::string word) {
    for (char& c : word) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return word;
  };
  const std::string typed = lower(text);
  const std::string* best = nullptr;
  std::size_t least = std::max<std::size_t>(1, typed.size() / 3) + 1;
  for (const std::string& word : words) {
    const std::string known = lower(word);
    const bool is_start = typed.size() > 2 && known.starts_with(typed);
    const std::size_t changes = is_start ? 0 : changes_between(typed, known);
    if (changes >= least) continue;
    least = changes;
    best = &word;
  }
  return best != nullptr ? "; did you mean " + *best + "?" : "";
}

void fail_value(const std::string& option, const std::string& text, const std::string& expected,
                const std::string& hint) {
  throw InputError(option + ": expected " + expected + ", got '" + text + "'" + hint);
}

std::pair<std::string, std::string> split_at_equals(const std::string& text) {
  const std::size_t equals = std::min(text.find('='), text.size());
  return {text.substr(0, equals), text.substr(std::min(equals + 1, text.size()))};
}

std::string listed(std::span<const std::string> words, const char* last) {
  std::string list;
  for (std::size_t i = 0; i < words.size(); ++i) {
    list += (i == 0 ? "" : i + 1 < words.size() ? ", " : last) + words[i];
  }
  return list;
}

std::vector<std::string> choose_some(const std::string& option, const std::string& text,
                                     std::span<const std::string> names) {
  std::vector<std::string> words = split_at_commas(text);
  for (const std::string& word : words) {
    if (std::ranges::find(names, word) == names.end()) {
      fail_value(option, text, "some of " + listed(names, ", ") + " with commas between",
                 did_you_mean(word, names));
    }
  }
  return words;
}

}  // namespace raygate
