// Rows of measurements: storage and printing.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "host/variants/variant_table.h"

namespace raygate::lab {

/// A row; its column `table` names its table. Infinity is null, as JSON has none.
using Row = Json;

/// The rows of a command.
class Results {
 public:
  void keep(Row row) { rows_.push_back(std::move(row)); }
  /// Stores a row and prints its columns, except nested ones, in a table that grows row by row.
  void add(Row row);
  [[nodiscard]] const std::vector<Row>& rows() const { return rows_; }
  /// Atomically writes all rows, one JSON object per line. Throws InputError if the file or its
  /// folder cannot be created.
  void write(const std::filesystem::path& file) const;

 private:
  std::vector<Row> rows_;
  std::string head_;  // header of the printed table
};

/// Returns the FNV-1a hash.
[[nodiscard]] std::uint64_t digest(std::string_view bytes);

/// Returns the properties of the machine that affect speed: processor, widest vectors, and the
/// vectors used by the cpu engine (host/base/vectors.h).
[[nodiscard]] Row machine_kind();

}  // namespace raygate::lab
