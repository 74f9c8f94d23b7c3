#include "host/app/option_table.h"

#include <algorithm>
#include <cctype>
#include <numeric>
#include <string_view>
#include <utility>

#include "host/app/version.h"
#include "host/base/input_error.h"

namespace raygate {
namespace {

constexpr std::size_t kColumn = 28, kWidth = 80;  // of the help text, in characters

/// "point-error": "pointError".
std::string camel_case(const std::string& name) {
  std::string text;
  for (std::size_t i = 0; i < name.size(); ++i) {
    text += name[i] != '-' ? name[i] : static_cast<char>(std::toupper(name[++i]));
  }
  return text;
}

/// Options as other programs call them, without dashes.
constexpr std::pair<std::string_view, std::string_view> kForeignNames[] = {
    {"width", "size"},         {"height", "size"},
    {"resolution", "size"},    {"samples-per-pixel", "spp"},
    {"envmap", "environment"}, {"hdri", "environment"},
    {"jobs", "threads"}};

/// "; did you mean --size?" of an unknown option, or nothing.
std::string meant_option(const std::string& typed, const std::vector<std::string>& names) {
  for (const auto& [foreign, ours] : kForeignNames) {
    const std::string name = "--" + std::string(ours);
    if (typed == "--" + std::string(foreign) && std::ranges::find(names, name) != names.end()) {
      return "; did you mean " + name + "?";
    }
  }
  return did_you_mean(typed, names);
}

}  // namespace

void OptionTable::add(const std::string& names, const char* value, std::string help, Read read,
                      Show show, unsigned places, bool repeats) {
  if (const std::size_t at = help.find("{}"); at != std::string::npos) help.replace(at, 2, show());
  std::vector<std::string> all = split_at_commas(names);
  const auto first_long = std::ranges::find_if(all, [](const auto& n) { return n[1] == '-'; });
  const std::string name = first_long->substr(2);
  rows_.push_back({std::move(all),
                   name,
                   value,
                   std::move(help),
                   group_,
                   std::move(read),
                   std::move(show),
                   places,
                   repeats,
                   {}});
}

/// Two columns, the second one wrapped; a wide name continues in the second column.
std::string OptionTable::help() const {
  std::string text = about_ + "\n";
  const char* group = nullptr;
  for (const Row& row : rows_) {
    if (group != row.group) text += std::string(group != nullptr ? "\n" : "") + row.group + "\n";
    group = row.group;
    std::string line = "  ";
    for (const std::string& name : row.names) {
      if (name != "--false-color") line += (line.size() > 2 ? ", " : "") + name;
    }
    if (row.value != nullptr) line += std::string(" ") + row.value;
    line.resize(std::max(kColumn, line.size() + 2), ' ');
    const auto end_line = [&] { text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n"; };
    for (std::size_t start = 0; start < row.help.size();) {
      const std::size_t end = std::min(row.help.find(' ', start), row.help.size());
      if (line.size() + (end - start) > kWidth) {
        end_line();
        line.assign(kColumn, ' ');
      }
      line += row.help.substr(start, end - start) + " ";
      start = end + 1;
    }
    end_line();
  }
  return text + "\n" + footer_ + "\n";
}

OptionTable::Row* OptionTable::find(const std::string& name) {
  const auto row = std::ranges::find_if(
      rows_, [&](const Row& row) { return std::ranges::count(row.names, name) > 0; });
  return row == rows_.end() ? nullptr : &*row;
}

void OptionTable::fail_unknown(const std::string& word) const {
  std::vector<std::string> names;
  for (const Row& row : rows_) {
    std::ranges::copy_if(row.names, std::back_inserter(names),
                         [](const std::string& name) { return name[1] == '-'; });
  }
  throw InputError(word + ": unknown option" + meant_option(split_at_equals(word).first, names) +
                   " (see --help)");
}

std::string OptionTable::parse(const std::vector<std::string>& words, const std::string& too_many) {
  bool asks_help = false, asks_version = false;
  flag("-h,--help", "print this text", asks_help);
  flag("--version", "print the version", asks_version);
  std::vector<std::string> plain;
  bool only_plain = false;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string& word = words[i];
    if (only_plain || word.size() < 2 || word[0] != '-') {
      plain.push_back(word);
      continue;
    }
    if (word == "--") {
      only_plain = true;
      continue;
    }
    // "--name=VALUE" or "-nVALUE".
    const std::size_t name_end =
        word[1] == '-' ? std::min(word.find('='), word.size()) : std::size_t{2};
    Row* const row = find(word.substr(0, name_end));
    if (row == nullptr) fail_unknown(word);
    const bool has_value = name_end < word.size();
    if (row->value == nullptr) {
      if (has_value) throw InputError(word + ": --" + row->name + " takes no value (see --help)");
      row->typed.emplace_back();
    } else if (has_value) {
      row->typed.push_back(word.substr(name_end + (word[1] == '-' ? 1 : 0)));
    } else if (i + 1 < words.size()) {
      row->typed.push_back(words[++i]);
    } else {
      throw InputError("--" + row->name + ": expected a value (see --help)");
    }
  }
  if (!rows_.rbegin()->typed.empty()) return std::string(kSoftware) + "\n";
  if (!std::next(rows_.rbegin())->typed.empty()) return help();
  for (std::size_t i = 0; i < plain.size(); ++i) {
    if (all_positionals_ != nullptr) {
      all_positionals_->push_back(plain[i]);
    } else if (i < positionals_.size()) {
      *positionals_[i] = plain[i];
    } else {
      throw InputError(plain[i] + ": " + too_many);
    }
  }
  for (const Row& row : rows_) {
    for (const std::string& text : row.typed) {
      if (row.value != nullptr && text.empty()) {
        throw InputError("--" + row.name + ": expected a value, got ''");
      }
    }
    const std::size_t first = row.repeats || row.typed.empty() ? 0 : row.typed.size() - 1;
    for (std::size_t i = first; i < row.typed.size(); ++i) row.read("--" + row.name, row.typed[i]);
  }
  return "";
}

void OptionTable::set(const std::string& name, const std::string& text) const {
  std::vector<std::string> names;
  for (const Row& row : rows_) {
    if ((row.places & kInPython) == 0) continue;
    if (row.name == name) return row.read(name, text);
    names.push_back(row.name);
  }
  throw InputError(name + ": unknown option" + did_you_mean(name, names));
}

void OptionTable::require(const std::string& name, OptionPlaces place,
                          const std::string& where) const {
  std::vector<std::string> names;
  for (const Row& row : rows_) {
    if ((row.places & place) == 0) continue;
    if (row.name == name) return;
    names.push_back(row.name);
  }
  throw InputError(where + ": unknown key '" + name + "', expected some of " + listed(names, ", ") +
                   did_you_mean(name, names));
}

std::string OptionTable::typed(const std::string& name) const {
  const auto& typed = std::ranges::find(rows_, name, &Row::name)->typed;
  return typed.empty() ? "" : typed.back();
}

std::vector<std::pair<std::string, std::string>> OptionTable::values(OptionPlaces place) const {
  std::vector<std::pair<std::string, std::string>> found;
  for (const Row& row : rows_) {
    if ((row.places & place) == 0) continue;
    if (std::string value = row.show(); !value.empty()) {
      found.emplace_back(place == kInExr ? camel_case(row.name) : row.name, std::move(value));
    }
  }
  return found;
}

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
