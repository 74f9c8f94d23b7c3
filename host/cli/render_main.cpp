// The program `render`.
#include <cstdlib>
#include <memory>

#include "host/cli/options.h"
#include "host/cli/process.h"
#include "host/cli/run.h"
#include "host/exact/ieee_floats.h"
#include "host/ranks/ranks.h"

int main(int argc, char** argv) {
  using namespace raygate;
  std::unique_ptr<Ranks> ranks;  // until the last word is said: a launcher ends us when one is gone
  const auto work = [&] {
    const Options options = parse_options(argc, argv, ranks->processors());
    if (options.information.empty()) {
      run(options, *ranks);
    } else if (ranks->index() == 0) {
      print(options.information);
    }
  };
  const auto program = [&] {
    require_ieee_floats();
    choose_vectors();
    ranks = join_ranks();
    work_as_rank(*ranks, work);
    return 0;
  };
  const int status = run_guarded(program, 1);
  // Nobody waits for ranks that may be dead.
  if (ranks && ranks->count() > 1 && interruption() != 0) std::_Exit(status);
  return status;
}
