// Ranks of a program built without MPI.
#include <cstdlib>
#include <string>

#include "host/base/input_error.h"
#include "host/ranks/ranks.h"

namespace raygate {

std::unique_ptr<Ranks> join_ranks() {
  const int count = launched_count();
  if (count > 1) {
    if (launched_index() > 0) std::_Exit(2);  // rank 0 reports the error
    throw InputError("found " + std::to_string(count) +
                     " ranks, expected one: this program was built without MPI; "
                     "`make verilate MPI=1` builds it with it");
  }
  return std::make_unique<Ranks>();
}

}  // namespace raygate
