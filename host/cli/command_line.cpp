#include "host/cli/command_line.h"

#include <CLI/CLI.hpp>

#include "host/base/input_error.h"
#include "host/cli/option_text.h"
#include "host/cli/version.h"

namespace raygate {
namespace {

/// What `unknown` may have been meant to be: ", did you mean --size?", or nothing.
std::string meant_option(const CLI::App& app, const std::string& unknown) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return did_you_mean(unknown.substr(0, unknown.find('=')), names);
}

}  // namespace

std::string read_command_line(CLI::App& app, const std::vector<std::string>& words,
                              const char* help, const std::string& too_many) {
  app.set_help_flag("-h,--help");
  app.set_version_flag("--version", std::string(kSoftware));
  app.allow_extras();  // so that an unknown option can be answered with a known one
  try {
    std::vector<std::string> reversed(words.rbegin(), words.rend());  // as the library wants them
    app.parse(reversed);
  } catch (const CLI::CallForHelp&) {
    return help;
  } catch (const CLI::CallForVersion&) {
    return std::string(kSoftware) + "\n";
  } catch (const CLI::ArgumentMismatch& error) {  // "--size: 1 required TEXT missing"
    const std::string what = error.what();
    throw InputError(what.substr(0, what.find(':')) + ": expected a value (see --help)");
  } catch (const CLI::ParseError& error) {
    throw InputError(std::string(error.what()) + " (see --help)");
  }
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& text : option->results()) {
      if (text.empty()) throw InputError(option->get_name() + ": expected a value, got ''");
    }
  }
  if (const std::vector<std::string> extras = app.remaining(); !extras.empty()) {
    const std::string& extra = extras[0];
    if (extra.size() > 1 && extra[0] == '-') {
      throw InputError(extra + ": unknown option" + meant_option(app, extra) + " (see --help)");
    }
    throw InputError(extra + ": " + too_many);
  }
  return "";
}

}  // namespace raygate
