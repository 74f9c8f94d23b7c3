// Rows of measurements: one way to keep them, one way to print them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "host/variants/variant_table.h"

namespace raygate::lab {

/// A row: the column `table` says of which table. JSON has no infinity: null stands for it.
using Row = Json;

/// What a command has found.
class Results {
 public:
  void keep(Row row) { rows_.push_back(std::move(row)); }
  /// Keeps a row and prints its columns, but for nested ones, in a table that grows row by row.
  void add(Row row);
  [[nodiscard]] const std::vector<Row>& rows() const { return rows_; }
  /// Writes all rows, a JSON object a line: the whole file or nothing. Throws InputError where the
  /// file or its folder cannot be made.
  void write(const std::filesystem::path& file) const;

 private:
  std::vector<Row> rows_;
  std::string head_;  // of the table in the terminal
};

/// FNV-1a.
[[nodiscard]] std::uint64_t digest(std::string_view bytes);

/// The machine, as far as it decides speed: processor, the widest vectors that it has,
/// and those that the cpu engine uses (host/base/vectors.h).
[[nodiscard]] Row machine_kind();

}  // namespace raygate::lab
