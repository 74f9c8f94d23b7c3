#include "host/options/option_table.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <numeric>
#include <string_view>
#include <utility>

#include "host/base/input_error.h"
#include "host/options/version.h"

namespace raygate {
namespace {

constexpr std::size_t kColumn = 28, kWidth = 80;  // of the help texts, of a terminal

/// Two columns, the second one wrapped; a wide name goes on in the second column.
class HelpFormatter : public CLI::Formatter {
 public:
  [[nodiscard]] std::string make_description(const CLI::App* app) const override {
    return app->get_description() + "\n";
  }
  [[nodiscard]] std::string make_usage(const CLI::App* /*app*/, std::string) const override {
    return "";
  }
  [[nodiscard]] std::string make_positionals(const CLI::App* /*app*/) const override { return ""; }
  [[nodiscard]] std::string make_group(std::string title, bool /*is_positional*/,
                                       std::vector<const CLI::Option*> options) const override {
    for (const CLI::Option* option : options) title += "\n" + make_option(option, false);
    return title + "\n";
  }
  [[nodiscard]] std::string make_option(const CLI::Option* option,
                                        bool /*is_positional*/) const override {
    std::string line = "  ";
    for (const char c : option->get_name(false, true)) line += c == ',' ? ", " : std::string(1, c);
    if (const std::size_t at = line.find(", --false-color"); at != std::string::npos)
      line.resize(at);
    if (option->get_type_size() > 0) line += " " + option->get_type_name();
    line.resize(std::max(kColumn, line.size() + 2), ' ');
    std::string text;
    for (const std::string& word : CLI::detail::split(option->get_description(), ' ')) {
      if (line.size() + word.size() > kWidth) {
        text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
        line.assign(kColumn, ' ');
      }
      line += word + " ";
    }
    return text + line.substr(0, line.find_last_not_of(' ') + 1);
  }
};

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

struct OptionTable::Row {
  std::string name;
  Read read;
  Show show;
  unsigned places;
  CLI::Option* option;
};

struct OptionTable::CommandLine {
  CLI::App app;
  std::vector<std::string*> positionals;
  std::vector<std::string>* all_positionals = nullptr;
};

OptionTable::OptionTable(const char* about, const char* footer)
    : line_(new CommandLine{CLI::App(about == nullptr ? "" : about), {}}) {
  line_->app.formatter(std::make_shared<HelpFormatter>());
  line_->app.footer(footer);
  line_->app.allow_extras();  // so that an unknown option can be answered with a known one
}

OptionTable::~OptionTable() = default;

void OptionTable::add(const std::string& names, const char* value, std::string help, Read read,
                      Show show, unsigned places, bool repeats) {
  if (const std::size_t at = help.find("{}"); at != std::string::npos) help.replace(at, 2, show());
  CLI::Option* const option = line_->app.add_option(
      names, [](const CLI::results_t&) { return true; }, help);
  option->type_name(value)->group(group_)->allow_extra_args(false);
  if (repeats) {
    option->expected(1, CLI::detail::expected_max_vector_size)->allow_extra_args(false);
  } else {
    option->take_last();
  }
  rows_.push_back({option->get_lnames().at(0), std::move(read), std::move(show), places, option});
}

void OptionTable::flag(const std::string& names, const char* help, bool& on) {
  line_->app.add_flag(names, on, help)->disable_flag_override()->group(group_);
}

void OptionTable::positional(std::string& target) { line_->positionals.push_back(&target); }
void OptionTable::positionals(std::vector<std::string>& targets) {
  line_->all_positionals = &targets;
}

std::string OptionTable::parse(const std::vector<std::string>& words, const std::string& too_many) {
  CLI::App& app = line_->app;
  app.set_help_flag("-h,--help", "print this text")->group(group_);
  app.set_version_flag("--version", std::string(kSoftware), "print the version")->group(group_);
  try {
    std::vector<std::string> reversed(words.rbegin(), words.rend());  // as the library wants them
    app.parse(reversed);
  } catch (const CLI::CallForHelp&) {
    return app.help();
  } catch (const CLI::CallForVersion&) {
    return std::string(kSoftware) + "\n";
  } catch (const CLI::ArgumentMismatch& error) {  // "--size: 1 required TEXT missing"
    const std::string what = error.what();
    throw InputError(what.substr(0, what.find(':')) + ": expected a value (see --help)");
  } catch (const CLI::ParseError& error) {
    throw InputError(std::string(error.what()) + " (see --help)");
  }
  std::size_t place = 0;
  for (const std::string& extra : app.remaining()) {
    if (extra.size() > 1 && extra[0] == '-') {
      std::vector<std::string> names;
      for (const CLI::Option* option : app.get_options()) {
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
      }
      throw InputError(extra + ": unknown option" +
                       meant_option(split_at_equals(extra).first, names) + " (see --help)");
    }
    if (line_->all_positionals != nullptr) {
      line_->all_positionals->push_back(extra);
    } else if (place < line_->positionals.size()) {
      *line_->positionals[place++] = extra;
    } else {
      throw InputError(std::string(extra).append(": ").append(too_many));
    }
  }
  for (const Row& row : rows_) {
    for (const std::string& text : row.option->results()) {
      if (text.empty()) throw InputError("--" + row.name + ": expected a value, got ''");
    }
    for (const std::string& text : row.option->reduced_results()) row.read("--" + row.name, text);
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

std::string OptionTable::typed(const std::string& name) const {
  // CLI11's own search promises to throw nothing, and takes memory.
  const CLI::results_t& results = std::ranges::find(rows_, name, &Row::name)->option->results();
  return results.empty() ? "" : results.back();
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
