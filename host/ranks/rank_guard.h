// How a rank other than 0 ends.
#pragma once

#include <exception>
#include <functional>

#include "host/ranks/ranks.h"

namespace raygate {

/// Runs `work` of a rank other than 0. Of what it throws, as `ending` puts it, rank 0 hears, and
/// has the last word: to the user, and about the exit status.
void run_rank(Ranks& ranks, const std::function<void()>& work,
              const std::function<Ending(std::exception_ptr)>& ending);

}  // namespace raygate
