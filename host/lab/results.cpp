#include "host/lab/results.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <system_error>
#include <utility>

#include "host/base/input_error.h"
#include "host/base/vectors.h"
#include "host/cli/format.h"
#include "host/film/atomic_file.h"

namespace raygate::lab {
namespace {

/// The rows of `file` that are of that run; a line that is damaged is none.
std::vector<Row> rows_of(const std::filesystem::path& file, const Row& run) {
  std::vector<Row> rows;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    Row row = Row::parse(line, nullptr, false);
    if (row.is_object() && row.contains("run") && row["run"] == run) rows.push_back(std::move(row));
  }
  return rows;
}

std::string cell(const TextTable::Column& column, const Row& row) {
  const auto value = row.find(column.key);
  if (value == row.end() || value->is_null()) return "-";
  if (value->is_string()) return value->get<std::string>();
  if (column.decimals >= 0) return format_fixed(value->get<double>(), column.decimals);
  return format_count(value->get<std::uint64_t>());
}

}  // namespace

Results::Results(std::filesystem::path file, const Row& run) : file_(std::move(file)), run_(run) {
  if (file_.empty()) return;
  std::error_code error;
  if (file_.has_parent_path()) std::filesystem::create_directories(file_.parent_path(), error);
  if (error) throw InputError(file_.string() + ": cannot make the folder: " + error.message());
  add(run_.is_null() ? std::vector<Row>{} : rows_of(file_, run_));
}

void Results::add(const std::vector<Row>& rows) {
  for (const Row& row : rows) {
    Row& added = rows_.emplace_back(row);
    if (!run_.is_null()) added["run"] = run_;
    text_ += added.dump() + "\n";
  }
  if (!file_.empty()) AtomicFile(file_, text_).commit();
}

TextTable::TextTable(std::vector<Column> columns) : columns_(std::move(columns)) {
  for (Column& column : columns_) {
    column.width = std::max(column.width, static_cast<int>(column.head.size()));
  }
}

void TextTable::print(const Row& row) {
  const auto print_line = [&](const auto& text_of) {
    for (const Column& column : columns_) {
      const bool is_text = row.contains(column.key) && row[column.key].is_string();
      std::printf("%s%*s", &column == columns_.data() ? "" : "  ",
                  is_text ? -column.width : column.width, text_of(column).c_str());
    }
    std::printf("\n");
  };
  if (!begun_) print_line([](const Column& column) { return column.head; });
  begun_ = true;
  print_line([&](const Column& column) { return cell(column, row); });
  std::fflush(stdout);
}

Row with_usual(const Row& object, Row usual, const std::string& what) {
  if (!object.is_object()) throw InputError(what + " is " + object.dump() + ", not an object");
  for (const auto& [name, value] : object.items()) {
    if (!usual.contains(name)) {
      std::string text = what;
      text.append(" has ").append(name).append(", expected");
      for (const auto& item : usual.items()) text.append(" ").append(item.key());
      throw InputError(text);
    }
    const Row& like = usual[name];
    const bool same_kind = like.is_number_float() ? value.is_number()
                           : like.is_number()     ? value.is_number_integer()
                                                  : value.type() == like.type();
    if (!same_kind) {
      throw InputError(name + " is " + value.dump() + ", expected a value like " + like.dump());
    }
  }
  usual.update(object);
  return usual;
}

int in_range(const std::string& name, int value, int low, int high) {
  if (low <= value && value <= high) return value;
  throw InputError(name + " is " + std::to_string(value) + ", expected " + std::to_string(low) +
                   " to " + std::to_string(high));
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
