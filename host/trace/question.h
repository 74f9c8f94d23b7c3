// What is asked of rays: which hits, and what of them.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "host/trace/answers.h"

namespace raygate {

/// Which hits of a ray are asked for.
enum class Hits {
  kNearest,  ///< one row a ray
  kAny,      ///< one row a ray: whether there is a hit; the search ends at the first one found
  kAll,  ///< a row for each hit, near before far, in exact order; none for a ray that hits nothing
};

/// The columns of these names or, without names, the usual ones. Throws InputError,
/// "--columns: found ..., expected ...", with `dashes` in the place of "--": about a name that is
/// none, is there twice or does not go with `hits`, and where all hits are asked of another engine
/// than `cpu`.
[[nodiscard]] std::vector<Answer> columns_of(std::span<const std::string> names, Hits hits,
                                             bool is_cpu, const std::string& dashes);

}  // namespace raygate
