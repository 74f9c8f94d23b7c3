#include "host/cli/option_text.h"

#include <algorithm>

#include "host/scene/io/input_error.h"

namespace raygate {

std::vector<std::string> split_at_commas(const std::string& text) {
  std::vector<std::string> words;
  for (std::size_t start = 0; start <= text.size();) {
    const std::size_t comma = std::min(text.find(',', start), text.size());
    words.push_back(text.substr(start, comma - start));
    start = comma + 1;
  }
  return words;
}

void fail_value(const std::string& option, const std::string& text, const std::string& expected) {
  throw InputError(option + ": expected " + expected + ", got '" + text + "'");
}

}  // namespace raygate
