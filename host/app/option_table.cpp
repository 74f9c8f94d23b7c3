#include "host/app/option_table.h"

#include <cctype>

#include "host/app/built_in.h"
#include "host/app/console.h"
#include "host/base/input_error.h"

namespace raygate {
namespace {

constexpr std::size_t kColumn = 28, kWidth = 80;  // of the help text, in characters

/// Returns "pointError" for "point-error".
std::string camel_case(const std::string& name) {
  std::string text;
  for (std::size_t i = 0; i < name.size(); ++i) {
    text += name[i] != '-' ? name[i] : static_cast<char>(std::toupper(name[++i]));
  }
  return text;
}

}  // namespace

void OptionTable::add(const std::string& names, const char* value, const std::string& help,
                      const std::string& expected, const Read& read, const Show& show,
                      unsigned places) {
  Row row{split_at(',', names), "", value, help, group_, expected, read, show, places, {}};
  row.name = std::ranges::find_if(row.names, [](const auto& n) { return n[1] == '-'; })->substr(2);
  if (const std::size_t at = help.find("{}"); at != help.npos) row.help.replace(at, 2, show());
  rows_.push_back(std::move(row));
}

/// Returns the text of --help in two columns; the second is wrapped. Wide names extend into it.
std::string OptionTable::help() const {
  std::string text = about_ + "\n";
  const char* group = nullptr;
  std::vector<Row> rows = rows_;
  for (Row& row : rows) row.group = (row.places & kMostUsed) != 0 ? "Most used" : row.group;
  std::ranges::stable_partition(rows, [](const Row& row) { return row.places & kMostUsed; });
  for (const Row& row : rows) {
    if (group != row.group) text += std::string(group != nullptr ? "\n" : "") + row.group + "\n";
    group = row.group;
    std::string line = "  " + listed(row.names, ", ");
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

CommandLine OptionTable::split(const std::vector<std::string>& words) {
  bool asks_help = false, asks_version = false;
  flag("-h,--help", "print this text", asks_help);
  flag("--version", "print the version", asks_version);
  const auto find_row = [&](const std::string& word) {
    return std::ranges::find_if(rows_, [typed = split_at_equals(word).first](const Row& row) {
      return std::ranges::count(row.names, typed) > 0;
    });
  };
  CommandLine line;
  for (auto word = words.begin(); word != words.end(); ++word) {
    if (*word == "--") {
      line.plain.insert(line.plain.end(), word + 1, words.end());
      break;
    }
    if (word->size() < 2 || word->front() != '-') {
      line.plain.push_back(*word);
      continue;
    }
    const auto row = find_row(*word);
    if (row == rows_.end()) throw InputError(*word + ": unknown option (see --help)");
    const bool has_value = word->find('=') != word->npos;
    if (row->value == nullptr && has_value) {
      throw InputError(*word + ": --" + row->name + " takes no value (see --help)");
    }
    const bool is_last = word + 1 == words.end() || find_row(word[1]) != rows_.end();
    if (row->value != nullptr && !has_value && is_last) {
      throw InputError("--" + row->name + ": expected a value (see --help)");
    }
    line.values.push_back({row->name, row->value == nullptr ? ""
                                      : has_value           ? split_at_equals(*word).second
                                                            : *++word});
    asks_help = asks_help || row->name == "help";
    asks_version = asks_version || row->name == "version";
  }
  if (asks_version) throw Information(std::string(kSoftware) + "\n");
  if (asks_help) throw Information(help());
  return line;
}

void OptionTable::read(const std::vector<OptionValue>& values) {
  for (Row& row : rows_) {
    for (const OptionValue& value : values) {
      if (value.name != row.name) continue;
      row.given = value;
      const bool is_valid = (row.value == nullptr || !value.text.empty()) && row.read(value.text);
      if (!is_valid) fail_value(row.name, row.expected);
    }
  }
}

CommandLine OptionTable::parse(const std::vector<std::string>& words) {
  CommandLine line = split(words);
  read(line.values);
  return line;
}

const OptionTable::Row& OptionTable::row(const std::string& name) const {
  return *std::ranges::find(rows_, name, &Row::name);
}

std::string OptionTable::given(const std::string& name) const {
  const std::optional<OptionValue>& given = row(name).given;
  return given ? given->text : "";
}

void OptionTable::fail_value(const std::string& name, const std::string& expected) const {
  fail(dashes_ + name + ": found '" + given(name) + "', expected " + expected, {name.c_str()});
}

void OptionTable::fail(const std::string& message, std::initializer_list<const char*> names) const {
  const OptionValue *typed = nullptr, *elsewhere = nullptr;
  for (const char* name : names) {
    const std::optional<OptionValue>& given = row(name).given;
    if (given) (given->where.empty() ? typed : elsewhere) = &*given;
  }
  if (elsewhere == nullptr) throw InputError(message);
  if (typed == nullptr) throw InputError(elsewhere->where + ": " + message);
  throw InputError(message + " (" + elsewhere->where + " sets " + elsewhere->name + ")");
}

void OptionTable::require(const OptionValue& value, OptionPlaces place) const {
  std::vector<std::string> names;
  for (const Row& row : rows_) {
    if ((row.places & place) != 0) names.push_back(row.name);
  }
  if (std::ranges::count(names, value.name) > 0) return;
  throw InputError((value.where.empty() ? "" : value.where + ": ") + "unknown option '" +
                   value.name + "', expected some of " + listed(names, ", "));
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

std::vector<std::string> split_at(char separator, const std::string& text) {
  std::vector<std::string> words;
  for (std::size_t start = 0; start <= text.size();) {
    const std::size_t end = std::min(text.find(separator, start), text.size());
    words.push_back(text.substr(start, end - start));
    start = end + 1;
  }
  return words;
}

std::string list_text(std::initializer_list<double> values) {
  std::string text;
  for (const double value : values) text += number_text(value) + ",";
  return text.substr(0, text.rfind(','));
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

}  // namespace raygate
