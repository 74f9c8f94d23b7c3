// The program `render`, run as its users run it.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "host/base/test/temp_folder.h"

namespace raygate {

/// How to run it.
struct Invocation {
  std::vector<std::string> arguments;
  std::filesystem::path folder;  ///< the current folder; also what file names are relative to
  bool terminal = false;         ///< standard error is a terminal of 80 columns, not a pipe
  int signal_when_busy = 0;      ///< with a terminal: sent when 1 % is done
  /// Called with the program's process id, one after the other, each when standard error has its
  /// text in what came since the last one's.
  std::vector<std::pair<std::string, std::function<void(int)>>> when_said{};
  std::string out_file{};       ///< standard output goes there instead
  long file_size_limit = 0;     ///< bytes that a file may grow to; 0: no limit
  unsigned most_seconds = 0;    ///< then SIGALRM; 0: no limit
  long memory_limit = 0;        ///< bytes of address space; 0: no limit
  bool without_rights = false;  ///< as a user who is not root
  int most_threads = 0;         ///< that its user may have, its first one counted; 0: no limit
  std::string program{};        ///< another one than that under test
  std::vector<std::string> environment{};  ///< "NAME=value", besides ours
};

/// What came of it.
struct Outcome {
  int status = -1;  ///< exit status; -1 if a signal ended it
  int signal = 0;   ///< that signal
  std::string out, err;
};

[[nodiscard]] Outcome run_program(const Invocation& invocation);

/// Returns whether `text` contains `part`; the message of a failure shows both.
[[nodiscard]] inline testing::AssertionResult contains(const std::string& text,
                                                       const std::string& part) {
  const bool is_there = text.find(part) != std::string::npos;
  return testing::AssertionResult(is_there) << "'" << part << "' in: " << text;
}

/// Returns `words`, followed by `more`.
[[nodiscard]] inline std::vector<std::string> joined(std::vector<std::string> words,
                                                     const std::vector<std::string>& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

}  // namespace raygate
