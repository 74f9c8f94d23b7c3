#include "host/lab/results.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <system_error>
#include <utility>

#include "host/app/console.h"
#include "host/base/input_error.h"
#include "host/base/vectors.h"
#include "host/film/atomic_file.h"

namespace raygate::lab {
namespace {

std::string text_of(const Row& value) {
  if (value.is_null()) return "-";
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number_unsigned()) return format_count(value.get<std::uint64_t>());
  if (!value.is_number_float()) return value.dump();
  char text[32];
  std::snprintf(text, sizeof text, "%.5g", value.get<double>());
  return text;
}

}  // namespace

void Results::add(Row row) {
  std::string head, line;
  for (const auto& [key, value] : row.items()) {
    if (key == "table" || value.is_structured()) continue;
    const std::size_t width = std::max<std::size_t>(key.size(), value.is_string() ? 18 : 9);
    const std::string text = text_of(value), room(width - std::min(width, text.size()), ' ');
    head += key + std::string(width - key.size() + 2, ' ');
    line += (value.is_string() ? text + room : room + text) + "  ";
  }
  if (head != head_) std::printf("%s\n", head.c_str());
  head_ = head;
  std::printf("%s\n", line.c_str());
  std::fflush(stdout);
  keep(std::move(row));
}

void Results::write(const std::filesystem::path& file) const {
  std::error_code error;
  if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path(), error);
  if (error) throw InputError(file.string() + ": cannot make the folder: " + error.message());
  std::string text;
  for (const Row& row : rows_) text += row.dump() + "\n";
  AtomicFile(file, text).commit();
}

std::uint64_t digest(std::string_view bytes) {
  std::uint64_t result = 14695981039346656037u;
  for (const char c : bytes) result = (result ^ static_cast<unsigned char>(c)) * 1099511628211u;
  return result;
}

Row machine_kind() {
  std::string processor = "unknown";
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    if (line.starts_with("model name")) processor = line.substr(line.find(": ") + 2);
  }
  return {{"processor", processor},
          {"machine_vectors", name_of(widest_vectors())},
          {"engine_vectors", name_of(vectors_in_use())}};
}

}  // namespace raygate::lab
