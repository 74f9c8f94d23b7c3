#include "host/scene/io/find_file.h"

#include <algorithm>
#include <set>

#include "host/scene/io/text.h"

namespace raygate {
namespace {

/// Returns the name with '/' in place of '\', and without the quotes around it, if any.
std::string with_slashes(std::string_view name) {
  if (name.size() > 2 && name.front() == '"' && name.back() == '"') {
    name = name.substr(1, name.size() - 2);
  }
  std::string slashed(name);
  std::ranges::replace(slashed, '\\', '/');
  return slashed;
}

/// Returns the name without the backslashes that some exporters put before spaces.
std::string with_plain_blanks(std::string_view name) {
  std::string plain(name);
  for (std::size_t at = 0; (at = plain.find("\\ ", at)) != plain.npos;) plain.erase(at, 1);
  return plain;
}

}  // namespace

std::optional<std::filesystem::path> find_file(const std::filesystem::path& folder,
                                               std::string_view name, const std::string& place,
                                               std::vector<std::string>& warnings) {
  for (const std::string& spelling :
       {std::string(name), with_slashes(name), with_plain_blanks(name)}) {
    std::error_code ignored;
    std::filesystem::path file = folder / spelling;
    if (std::filesystem::is_regular_file(file, ignored)) return file;
  }
  const std::filesystem::path asked(with_slashes(name));
  const std::string wanted = in_lower_case(asked.filename().string());
  if (wanted.empty()) return std::nullopt;
  for (const std::filesystem::path& where : {folder / asked.parent_path(), folder}) {
    std::set<std::filesystem::path> found;
    std::error_code error;
    for (std::filesystem::directory_iterator entry(where.empty() ? "." : where, error), end;
         !error && entry != end; entry.increment(error)) {
      const std::filesystem::path file = entry->path().filename();
      if (in_lower_case(file.string()) == wanted && entry->is_regular_file(error)) {
        found.insert(where / file);
      }
    }
    if (found.empty()) continue;
    const std::filesystem::path& first = *found.begin();
    warnings.push_back(place + in_quotes(name) + " is missing, " + first.string() + " instead");
    return first;
  }
  return std::nullopt;
}

}  // namespace raygate
