#include "host/ranks/helper_guard.h"

#include <exception>

namespace raygate {

void run_helper(Ranks& ranks, const std::function<void()>& work) {
  try {
    work();
  } catch (const RunIsOver&) {  // NOLINT(bugprone-empty-catch): nothing left to do
  } catch (const std::exception& error) {
    ranks.send(0, About::kTrouble, error.what());
  }
}

}  // namespace raygate
