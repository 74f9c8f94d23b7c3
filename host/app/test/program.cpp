#include "host/app/test/program.h"

#include <fcntl.h>
#include <poll.h>
#include <pty.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <stdexcept>

namespace raygate {
namespace {

void require(bool success, const char* what) {
  if (!success) throw std::runtime_error(std::string(what) + " failed");
}

/// Both ends of a pipe or of a terminal.
struct Stream {
  int read_end = -1, write_end = -1;
};

Stream make_pipe() {
  int ends[2];
  require(::pipe2(ends, O_CLOEXEC) == 0, "pipe");
  return {ends[0], ends[1]};
}

Stream make_terminal() {
  Stream terminal;
  const winsize size{24, 80, 0, 0};
  require(::openpty(&terminal.read_end, &terminal.write_end, nullptr, nullptr, &size) == 0,
          "openpty");
  return terminal;
}

/// Executes the program in the child process. Never returns.
[[noreturn]] void become_program(const Invocation& invocation, int out, int err) {
  const std::string program = invocation.program.empty() ? RAYGATE_PROGRAM : invocation.program;
  std::vector<char*> argv{const_cast<char*>(program.c_str())};
  for (const std::string& argument : invocation.arguments) {
    argv.push_back(const_cast<char*>(argument.c_str()));
  }
  argv.push_back(nullptr);
  const int in = ::open("/dev/null", O_RDONLY);
  // Opened before setuid, as another user may have no access to the folder.
  const int code = ::open(program.c_str(), O_RDONLY | O_CLOEXEC);
  bool ready = ::chdir(invocation.folder.c_str()) == 0 && ::dup2(in, STDIN_FILENO) >= 0 &&
               ::dup2(out, STDOUT_FILENO) >= 0 && ::dup2(err, STDERR_FILENO) >= 0;
  if (invocation.file_size_limit > 0) {
    const auto bytes = static_cast<rlim_t>(invocation.file_size_limit);
    const rlimit limit{bytes, bytes};
    ready = ready && ::setrlimit(RLIMIT_FSIZE, &limit) == 0;
  }
  ::alarm(invocation.most_seconds);
  if (invocation.memory_limit > 0) {
    const auto bytes = static_cast<rlim_t>(invocation.memory_limit);
    const rlimit limit{bytes, bytes};
    ready = ready && ::setrlimit(RLIMIT_AS, &limit) == 0;
  }
  if (!invocation.out_file.empty()) {
    const int file = ::open(invocation.out_file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    ready = ready && ::dup2(file, STDOUT_FILENO) >= 0;
  }
  if (invocation.without_rights && ::geteuid() == 0) ready = ready && ::setuid(65534) == 0;
  if (invocation.most_threads > 0) {
    const auto threads = static_cast<rlim_t>(invocation.most_threads);
    const rlimit limit{threads, threads};
    ready = ready && ::setrlimit(RLIMIT_NPROC, &limit) == 0;
  }
  for (const std::string& setting : invocation.environment) {
    ready = ready && ::putenv(const_cast<char*>(setting.c_str())) == 0;
  }
  if (ready) ::fexecve(code, argv.data(), environ);
  ::_exit(127);
}

/// Appends the available text. Returns false at the end.
bool read_some(int fd, std::string& text) {
  char buffer[4096];
  const ssize_t count = ::read(fd, buffer, sizeof buffer);
  if (count < 0 && errno == EINTR) return true;
  if (count <= 0) return false;  // EIO: the terminal's program has ended
  text.append(buffer, static_cast<std::size_t>(count));
  return true;
}

}  // namespace

Outcome run_program(const Invocation& invocation) {
  const Stream out = make_pipe();
  const Stream err = invocation.terminal ? make_terminal() : make_pipe();
  const pid_t child = ::fork();
  require(child >= 0, "fork");
  if (child == 0) become_program(invocation, out.write_end, err.write_end);
  ::close(out.write_end);
  ::close(err.write_end);

  Outcome outcome;
  bool signalled = invocation.signal_when_busy == 0;
  std::size_t said = 0, heard = 0;  // when_said functions called; bytes of standard error checked
  pollfd waits[] = {{out.read_end, POLLIN, 0}, {err.read_end, POLLIN, 0}};
  std::string* texts[] = {&outcome.out, &outcome.err};
  while (waits[0].fd >= 0 || waits[1].fd >= 0) {
    if (::poll(waits, 2, -1) < 0) continue;
    for (int i = 0; i < 2; ++i) {
      if (waits[i].revents == 0) continue;
      if (!read_some(waits[i].fd, *texts[i])) {
        ::close(waits[i].fd);
        waits[i].fd = -1;  // poll ignores it
      }
    }
    while (said < invocation.when_said.size()) {
      const auto& [text, react] = invocation.when_said[said];
      const std::size_t found = outcome.err.find(text, heard);
      if (found == std::string::npos) break;
      heard = found + text.size();
      ++said;
      react(child);
    }
    if (!signalled && outcome.err.find(" left") != std::string::npos) {
      ::kill(child, invocation.signal_when_busy);
      signalled = true;
    }
  }
  int status = 0;
  require(::waitpid(child, &status, 0) == child, "waitpid");
  if (WIFEXITED(status)) outcome.status = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) outcome.signal = WTERMSIG(status);
  return outcome;
}

}  // namespace raygate
