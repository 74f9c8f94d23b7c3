#include "host/scene/io/clean_text.h"

namespace raygate {

void CleanText::warn_once(std::string_view keyword, const std::string& what) {
  if (warned_of_.emplace(keyword).second) warn(what);
}

CleanText::int_type CleanText::underflow() {
  statement_.clear();
  while (statement_.empty()) {
    const std::optional<std::string_view> statement = lines_.next();
    if (!statement) return traits_type::eof();
    clean(*statement, statement_);
  }
  setg(statement_.data(), statement_.data(), statement_.data() + statement_.size());
  return traits_type::to_int_type(statement_[0]);
}

}  // namespace raygate
