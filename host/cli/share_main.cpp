// The program `share`: commands, a line each, that ranks take one after the other.
#include <sys/wait.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "host/base/input_error.h"
#include "host/cli/process.h"
#include "host/ranks/ranks.h"

namespace {

using namespace raygate;

std::vector<std::string> read_lines(const std::string& file) {
  std::ifstream in(file);
  if (!in) throw InputError(file + ": cannot read, expected commands, one a line");
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

void run_shared(const std::vector<std::string>& commands, Ranks& ranks) {
  JobQueue jobs(ranks, static_cast<int>(commands.size()));
  while (const auto job = jobs.next()) {
    const std::string& command = commands[static_cast<std::size_t>(*job)];
    const int status = std::system(command.c_str());  // NOLINT(bugprone-command-processor)
    if (status != 0) throw InputError("this command failed: " + command);
  }
}

}  // namespace

int main(int argc, char** argv) {
  std::unique_ptr<Ranks> ranks;
  const auto program = [&] {
    if (argc != 2 || std::string(argv[1]) == "--help") {
      print(
          "share FILE: runs the commands in FILE, a line each, one after the other.\n"
          "mpirun -n N share FILE: each of N ranks takes the next one when it is free.\n");
      return argc == 2 ? 0 : 2;
    }
    ranks = join_ranks();
    forget_launcher();
    const auto work = [&] { run_shared(read_lines(argv[1]), *ranks); };
    work_as_rank(*ranks, work);
    return 0;
  };
  return run_guarded(program, 1);
}
