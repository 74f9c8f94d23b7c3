// InputError: the exception for invalid input, which main prints before it exits with status 2.
#pragma once

#include <stdexcept>
#include <string>

namespace raygate {

/// An error in the user's input. The text is one line: file and line if there are any, what was
/// found, and what was expected. main prints the text and exits with status 2.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
  InputError(const std::string& file, std::size_t line, const std::string& what)
      : std::runtime_error(location(file, line) + what) {}

  /// Returns "file:line: ", or "file: " if `line` is 0, as for a file without lines.
  [[nodiscard]] static std::string location(const std::string& file, std::size_t line) {
    std::string place = file;
    if (line != 0) place.append(":").append(std::to_string(line));
    return place.append(": ");
  }
};

}  // namespace raygate
