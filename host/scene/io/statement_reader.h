// What readers of OBJ and MTL files share: the statements, and warnings about them.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "host/scene/io/text_lines.h"

namespace raygate {

class StatementReader {
 public:
  /// `warnings` must outlive this.
  StatementReader(const std::filesystem::path& file, std::vector<std::string>& warnings)
      : lines_(file), warnings_(warnings) {}

 protected:
  /// Where the reading is.
  [[nodiscard]] const TextLines& lines() const { return lines_; }
  [[nodiscard]] TextLines& lines() { return lines_; }

  void warn(const std::string& what) { warnings_.push_back(lines_.place() + what); }

  /// Warns of the first statement with this keyword alone.
  void warn_once(std::string_view keyword, const std::string& what) {
    if (warned_of_.emplace(keyword).second) warn(what);
  }

 private:
  TextLines lines_;
  std::vector<std::string>& warnings_;
  std::set<std::string, std::less<>> warned_of_;
};

}  // namespace raygate
