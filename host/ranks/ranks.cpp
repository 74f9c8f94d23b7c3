#include "host/ranks/ranks.h"

#include <unistd.h>

#include <array>
#include <cstdlib>
#include <initializer_list>
#include <string_view>
#include <vector>

#include "host/base/input_error.h"

namespace raygate {
namespace {

/// Returns the number in the first of these variables that is set, or 0.
int number_in(std::initializer_list<const char*> names) {
  for (const char* name : names) {
    if (const char* const text = std::getenv(name)) {
      return static_cast<int>(std::strtol(text, nullptr, 10));
    }
  }
  return 0;
}

}  // namespace

void throw_short_message(std::size_t found, std::size_t expected) {
  throw InputError("message of another rank: found " + std::to_string(found) +
                   " bytes, expected at least " + std::to_string(expected) +
                   "; is it the same program everywhere?");
}

void run_rank(Ranks& ranks, const std::function<void()>& work,
              const std::function<Ending(std::exception_ptr)>& ending) {
  try {
    work();
  } catch (const RunIsOver&) {  // NOLINT(bugprone-empty-catch): nothing left to do
  } catch (...) {
    ranks.send(0, About::kFailure, RankFailure::message_of(ending(std::current_exception())));
  }
}

bool is_launched() {
  return std::ranges::any_of(std::array{"OMPI_COMM_WORLD_SIZE", "PMI_RANK", "PMIX_RANK"},
                             [](const char* name) { return std::getenv(name) != nullptr; });
}

int launched_count() { return number_in({"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"}); }

int launched_index() { return number_in({"OMPI_COMM_WORLD_RANK", "PMI_RANK"}); }

void forget_launcher() {
  std::vector<std::string> names;
  for (char** variable = environ; *variable != nullptr; ++variable) {
    const std::string_view text = *variable;
    for (const std::string_view prefix : {"OMPI_", "PMI_", "PMIX_"}) {
      if (text.starts_with(prefix)) names.emplace_back(text.substr(0, text.find('=')));
    }
  }
  for (const std::string& name : names) ::unsetenv(name.c_str());
}

}  // namespace raygate
