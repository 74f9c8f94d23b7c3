#include "host/ranks/launcher.h"

#include <algorithm>
#include <array>
#include <cstdlib>

namespace raygate {

bool is_launched() {
  return std::ranges::any_of(std::array{"OMPI_COMM_WORLD_SIZE", "PMI_RANK", "PMIX_RANK"},
                             [](const char* name) { return std::getenv(name) != nullptr; });
}

int launched_count() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"}) {
    if (const char* const count = std::getenv(name)) {
      return static_cast<int>(std::strtol(count, nullptr, 10));
    }
  }
  return 0;
}

}  // namespace raygate
