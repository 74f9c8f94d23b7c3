// What the lab finds: rows. One way to keep them, one way to print them.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace raygate::lab {

/// A row: the column `table` says of which table; host/lab/report explains all columns. JSON has no
/// infinity: null stands for it.
using Row = nlohmann::ordered_json;

/// The rows of a run, in a file with a JSON object a line. What was added is in the file, all of
/// it or nothing, so that a run which is interrupted can go on.
class Results {
 public:
  /// Begins `file` anew (empty: keeps no file), or goes on with it: rows whose column `run` is the
  /// given one stay, all others go. A null `run` goes on with nothing. Throws InputError where the
  /// file or its folder cannot be made.
  explicit Results(std::filesystem::path file, const Row& run = {});

  void add(const Row& row) { add(std::vector<Row>{row}); }
  void add(const std::vector<Row>& rows);
  [[nodiscard]] const std::vector<Row>& rows() const { return rows_; }

 private:
  std::filesystem::path file_;
  Row run_;
  std::vector<Row> rows_;
  std::string text_;  // of the file
};

/// A table in the terminal that grows row by row.
class TextTable {
 public:
  struct Column {
    std::string key, head;
    int decimals = -1;  ///< of a number; -1: a whole number with commas, or text
    int width = 0;      ///< 0: the head's
  };
  explicit TextTable(std::vector<Column> columns);

  /// Prints the head first. A row without a column's key has a dash there.
  void print(const Row& row);

 private:
  std::vector<Column> columns_;
  bool begun_ = false;
};

/// `object` with the values of `usual` where it has none. Throws InputError, "WHAT has ...": an
/// unknown name, or a value that is not of the usual one's kind.
[[nodiscard]] Row with_usual(const Row& object, Row usual, const std::string& what);

/// Throws InputError, "NAME is ..., expected LOW to HIGH".
int in_range(const std::string& name, int value, int low, int high);

/// FNV-1a.
[[nodiscard]] std::uint64_t digest(std::string_view bytes);

/// The machine, as far as it decides speed: processor, the widest vectors that it has,
/// and those that the cpu engine uses (host/base/vectors.h).
[[nodiscard]] Row machine_kind();

}  // namespace raygate::lab
