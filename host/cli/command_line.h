// A command line, and what to say where it is wrong: the same of all programs.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace raygate {

/// Reads `words`, a command line without the program's name, into what was declared with `app`,
/// and --help and --version, which are declared here. Gives the text that one of these asks for,
/// and then nothing else is of use; or nothing. Throws InputError, one line: an unknown option and
/// what it may have been meant to be, an option without its value, a word too many, of which
/// `too_many` says what it is.
[[nodiscard]] std::string read_command_line(CLI::App& app, const std::vector<std::string>& words,
                                            const char* help, const std::string& too_many);

}  // namespace raygate
