// Ranks of which one cannot go on: `mpirun -n N rank_endings WHY RANK`.
#include <chrono>
#include <csignal>
#include <memory>
#include <string>
#include <thread>

#include "host/app/process.h"
#include "host/base/input_error.h"
#include "host/intersect/check_intersector.h"

int main(int argc, char** argv) {
  using namespace raygate;
  std::unique_ptr<Ranks> ranks;
  const auto work = [&] {
    const std::string why = argv[1];
    if (ranks->index() == std::stoi(argv[2])) {
      if (why == "difference") throw IntersectorMismatch("a ray");
      throw Interrupted(SIGTERM, "no file was changed");
    }
    while (true) {  // until somebody ends it
      (void)ranks->receive();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  };
  const auto program = [&] {
    if (argc != 3) throw InputError("expected why, and which rank");
    ranks = join_ranks();
    work_as_rank(*ranks, work);
    return 0;
  };
  return run_guarded(program, 1);
}
