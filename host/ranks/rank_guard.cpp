#include "host/ranks/rank_guard.h"

namespace raygate {

void run_rank(Ranks& ranks, const std::function<void()>& work,
              const std::function<Ending(std::exception_ptr)>& ending) {
  try {
    work();
  } catch (const RunIsOver&) {  // NOLINT(bugprone-empty-catch): nothing left to do
  } catch (...) {
    ranks.send(0, About::kFailure, RankFailure::message_of(ending(std::current_exception())));
  }
}

}  // namespace raygate
