// Names of a scene's objects, by index.
#pragma once

#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

namespace raygate {

/// A list of names that stores repeated sequences, such as the object names of instances, once.
class NameList {
 public:
  NameList(std::initializer_list<std::string> names = {}) : NameList(std::vector(names)) {}
  explicit NameList(std::vector<std::string> names) { append(std::move(names), 1); }

  [[nodiscard]] std::size_t size() const { return size_; }

  /// Returns a name. `index` is below size(). Takes O(log n) time for n appended sequences.
  [[nodiscard]] const std::string& operator[](std::size_t index) const {
    const auto next = std::ranges::upper_bound(runs_, index, {}, &Run::first);
    const Run& run = *std::prev(next);
    return run.names[(index - run.first) % run.names.size()];
  }

  void push_back(std::string name) {
    const bool repeats = runs_.empty() || runs_.back().names.size() < size_ - runs_.back().first;
    if (repeats) return append({std::move(name)}, 1);
    runs_.back().names.push_back(std::move(name));
    ++size_;
  }

  /// Appends all of these names, in order, `times` times.
  void append(std::vector<std::string> names, std::size_t times) {
    if (names.empty() || times == 0) return;
    const std::size_t count = names.size() * times;
    runs_.push_back({size_, std::move(names)});
    size_ += count;
  }

  /// Returns a copy of the names as strings.
  [[nodiscard]] std::vector<std::string> all() const {
    std::vector<std::string> names;
    names.reserve(size_);
    for (std::size_t i = 0; i < size_; ++i) names.push_back((*this)[i]);
    return names;
  }

 private:
  /// Names from index `first` to the next run, which repeat `names`.
  struct Run {
    std::size_t first;
    std::vector<std::string> names;
  };

  std::vector<Run> runs_;
  std::size_t size_ = 0;
};

}  // namespace raygate
