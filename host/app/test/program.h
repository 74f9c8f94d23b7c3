// Runs a program as its users do, with limits and signals.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "host/base/test/temp_folder.h"

namespace raygate {

/// Arguments and environment of a run.
struct Invocation {
  std::vector<std::string> arguments;
  std::filesystem::path folder;  ///< the current folder, to which file names are relative
  bool terminal = false;         ///< standard error is a terminal of 80 columns, not a pipe
  int signal_when_busy = 0;      ///< signal to send when 1 % is done; needs `terminal`
  /// Texts and functions. Waits until standard error has received the first text, calls the first
  /// function with the program's process id, waits for the second text, and so on.
  std::vector<std::pair<std::string, std::function<void(int)>>> when_said{};
  std::string out_file{};                  ///< file for standard output
  long file_size_limit = 0;                ///< largest file, in bytes; 0: no limit
  unsigned most_seconds = 0;               ///< seconds until SIGALRM; 0: no limit
  long memory_limit = 0;                   ///< bytes of address space; 0: no limit
  bool without_rights = false;             ///< run as a user who is not root
  int most_threads = 0;                    ///< threads of its user, including main's; 0: no limit
  std::string program{};                   ///< "": the program under test
  std::vector<std::string> environment{};  ///< "NAME=value", added to ours
};

/// The result of a run.
struct Outcome {
  int status = -1;  ///< exit status; -1 if a signal ended it
  int signal = 0;   ///< the signal that ended it
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
