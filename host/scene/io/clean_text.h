// A file on its way to the loader library: each statement is checked and put into plain words.
#pragma once

#include <set>
#include <streambuf>
#include <string>
#include <string_view>
#include <vector>

#include "host/scene/io/text_lines.h"

namespace raygate {

/// A stream buffer that hands out one cleaned statement at a time, so that while the library deals
/// with it, lines() still knows where it stands in the file.
///
/// Set std::ios::badbit in the exceptions() of the stream that reads from it: else the stream
/// swallows the InputError.
class CleanText : public std::streambuf {
 public:
  /// `warnings` must outlive this.
  CleanText(const std::filesystem::path& file, std::vector<std::string>& warnings)
      : lines_(file), warnings_(warnings) {}

  [[nodiscard]] const TextLines& lines() const { return lines_; }

 protected:
  /// Appends to `clean` what the library shall read for `statement`, with newlines; or nothing.
  /// Throws InputError for what is not a valid statement.
  virtual void clean(std::string_view statement, std::string& clean) = 0;

  void warn(const std::string& what) { warnings_.push_back(lines_.place() + what); }

  /// Warns of the first statement with this keyword alone.
  void warn_once(std::string_view keyword, const std::string& what);

  int_type underflow() override;

 private:
  TextLines lines_;
  std::vector<std::string>& warnings_;
  std::set<std::string, std::less<>> warned_of_;
  std::string statement_;  // what the library reads just now
};

}  // namespace raygate
