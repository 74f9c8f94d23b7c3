// Names of a scene's objects, by index.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

namespace raygate {

/// A list of names that stores repeated sequences, such as the object names of instances, once.
class NameList {
 public:
  NameList() = default;
  NameList(std::initializer_list<std::string> names) : NameList(std::vector(names)) {}
  explicit NameList(std::vector<std::string> names) : texts_(std::move(names)) {
    size_ = texts_.size();
    if (size_ > 0) runs_.push_back({0, 0, size_});
  }

  [[nodiscard]] std::size_t size() const { return size_; }

  /// Returns a name. `index` is below size(). Takes O(log n) time for n appended sequences.
  [[nodiscard]] const std::string& operator[](std::size_t index) const {
    const Run& run =
        *std::prev(std::upper_bound(runs_.begin(), runs_.end(), index,
                                    [](std::size_t i, const Run& r) { return i < r.first; }));
    return texts_[run.text + (index - run.first) % run.period];
  }

  void push_back(std::string name) {
    if (runs_.empty() || size_ - runs_.back().first != runs_.back().period) {
      runs_.push_back({size_, texts_.size(), 0});
    }
    texts_.push_back(std::move(name));
    ++runs_.back().period;
    ++size_;
  }

  /// Appends all names of `names`, in order, `times` times.
  void append(const NameList& names, std::size_t times) {
    if (names.size() == 0 || times == 0) return;
    runs_.push_back({size_, texts_.size(), names.size()});
    for (std::size_t i = 0; i < names.size(); ++i) texts_.push_back(names[i]);
    size_ += names.size() * times;
  }

  /// Returns a copy of the names as strings.
  [[nodiscard]] std::vector<std::string> all() const {
    std::vector<std::string> names;
    names.reserve(size_);
    for (std::size_t i = 0; i < size_; ++i) names.push_back((*this)[i]);
    return names;
  }

 private:
  // Names from index `first` to the next run repeat `period` texts from index `text` on.
  struct Run {
    std::size_t first, text, period;
  };

  std::vector<std::string> texts_;
  std::vector<Run> runs_;
  std::size_t size_ = 0;
};

}  // namespace raygate
