// Random damage to files, for the tests of all readers.
#pragma once

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <random>
#include <span>
#include <string>
#include <vector>

namespace raygate::test {

/// Damages files at random. The same seed gives the same damage.
class Damage {
 public:
  /// Inserted text is chosen from `splinters` (words of the format) and from numbers hard to parse.
  explicit Damage(std::uint64_t seed, std::span<const char* const> splinters = {})
      : random_(seed), splinters_(std::begin(kNumbers), std::end(kNumbers)) {
    splinters_.insert(splinters_.end(), splinters.begin(), splinters.end());
  }

  /// Returns `bytes` with one to four damages. If `front` is not 0, about half of the damages are
  /// in the first `front` bytes, such as a header.
  std::string operator()(std::string bytes, std::size_t front = 0) {
    for (std::size_t times = 1 + below(4); times > 0 && !bytes.empty(); --times) {
      const bool is_front = front > 0 && below(2) == 0;
      do_one(bytes, below(is_front ? std::min(bytes.size(), front) : bytes.size()));
    }
    return bytes;
  }

  std::size_t below(std::size_t limit) { return random_() % limit; }

 private:
  static constexpr const char* kNumbers[] = {"nan",        "-inf",        "1e999",
                                             "1e-999",     "0",           "-1",
                                             "4294967297", "-2147483648", "99999999999999999999",
                                             "1.5e"};

  void do_one(std::string& bytes, std::size_t at) {
    switch (below(9)) {
      case 0:
        bytes[at] = static_cast<char>(below(256));
        break;
      case 1:
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
        break;
      case 2:
      case 3:
        bytes.insert(at, splinters_[below(splinters_.size())]);
        break;
      case 4:
        bytes.erase(at, 1 + below(8));
        break;
      case 5:
        replace_number(bytes, at);
        break;
      case 6:
        repeat_line(bytes, at);
        break;
      case 7:  // a length, or an index, of a binary file
        bytes.replace(at, std::min<std::size_t>(4, bytes.size() - at), "\xFF\xFF\xFF\x7F", 4);
        break;
      case 8:
        if (below(4) == 0) bytes.resize(at);
        break;
    }
  }
  void replace_number(std::string& text, std::size_t at) {
    const std::size_t begin = text.find_first_of("0123456789-", at);
    if (begin == std::string::npos) return;
    const std::size_t end = text.find_first_not_of("0123456789-.e", begin);
    text.replace(begin, std::min(end, text.size()) - begin, kNumbers[below(std::size(kNumbers))]);
  }
  static void repeat_line(std::string& text, std::size_t at) {
    const std::size_t begin = text.rfind('\n', at) + 1;  // npos + 1 is 0
    const std::size_t end = text.find('\n', at);
    text.insert(begin, text.substr(begin, end - begin) + "\n");
  }

  std::mt19937_64 random_;
  std::vector<const char*> splinters_;
};

}  // namespace raygate::test
