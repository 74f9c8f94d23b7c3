// A cache of polygon records behind the ray core's set-up unit: what it would hold again.
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace raygate::lab {

/// The records that were used last, each of a triangle as it is seen from an origin.
class RecordCache {
 public:
  explicit RecordCache(std::size_t records) : records_(records) {}

  /// A test asks for a record.
  void use(const glm::vec3& origin, std::uint32_t triangle) {
    ++uses_;
    const Key key{origin, triangle};
    auto found = std::ranges::find(keys_, key);
    if (found != keys_.end()) {
      ++hits_;
    } else {
      if (keys_.size() < records_) keys_.emplace_back();
      found = keys_.end() - 1;
      *found = key;
    }
    std::rotate(keys_.begin(), found, found + 1);
  }

  [[nodiscard]] std::size_t records() const { return records_; }
  [[nodiscard]] std::uint64_t uses() const { return uses_; }
  /// Of all uses those whose record was here, in percent; 0 where there was none.
  [[nodiscard]] double hits_percent() const {
    return uses_ == 0 ? 0.0 : 100.0 * static_cast<double>(hits_) / static_cast<double>(uses_);
  }

 private:
  struct Key {
    glm::vec3 origin{0.0f};
    std::uint32_t triangle = 0;
    friend bool operator==(const Key&, const Key&) = default;
  };

  std::size_t records_;
  std::vector<Key> keys_;  // the last used first
  std::uint64_t uses_ = 0, hits_ = 0;
};

}  // namespace raygate::lab
