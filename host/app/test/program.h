// The program `render`, run as its users run it.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

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

/// A new empty folder that is removed with all that is in it.
class ScratchFolder {
 public:
  ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder();

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Names of all files in it, in order.
  [[nodiscard]] std::vector<std::string> list() const;
  void write(const std::string& name, const std::string& bytes) const;
  /// The file's bytes; none if there is no such file.
  [[nodiscard]] std::string read(const std::string& name) const;

 private:
  std::filesystem::path path_;
};

}  // namespace raygate
