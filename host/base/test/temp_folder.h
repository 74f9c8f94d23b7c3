// A folder of files for one test, removed at its end.
#pragma once

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "host/base/input_error.h"

namespace raygate {

/// Returns the text of the InputError that `work` throws, or "(read)" if it throws none.
template <class Work>
std::string input_error_of(const Work& work) {
  try {
    work();
  } catch (const InputError& error) {
    return error.what();
  }
  return "(read)";
}

/// A new folder, which the destructor removes.
class TempFolder {
 public:
  static std::filesystem::path on_disk() { return std::filesystem::temp_directory_path(); }

  /// Makes a folder in memory (/dev/shm) if possible, otherwise on disk.
  TempFolder() : TempFolder(access("/dev/shm", W_OK) == 0 ? "/dev/shm" : on_disk()) {}
  /// Makes a folder in `parent` that other users may read.
  explicit TempFolder(const std::filesystem::path& parent) {
    std::string name = (parent / "raygate_test_XXXXXX").string();
    if (!mkdtemp(name.data())) throw std::runtime_error("cannot make " + name);
    path_ = name;
    std::filesystem::permissions(path_, std::filesystem::perms(0755));
  }
  ~TempFolder() {
    std::error_code ignored;
    std::filesystem::permissions(path_, std::filesystem::perms::owner_all, ignored);
    std::filesystem::remove_all(path_, ignored);
  }
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;

  /// Writes the bytes as they are and returns the file's path.
  std::filesystem::path write(const std::string& name, std::string_view bytes) const {
    const std::filesystem::path file = path_ / name;
    std::filesystem::create_directories(file.parent_path());
    if (!(std::ofstream(file, std::ios::binary) << bytes).flush()) {
      throw std::runtime_error("cannot write " + file.string());
    }
    return file;
  }
  /// Returns the bytes of a file, or an empty string if there is no such file.
  [[nodiscard]] std::string read(const std::string& name) const {
    std::ifstream file(path_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  /// Returns the sorted names of all files.
  [[nodiscard]] std::vector<std::string> list() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(path_)) {
      names.push_back(entry.path().filename().string());
    }
    std::ranges::sort(names);
    return names;
  }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  /// Returns input_error_of(work). If the text begins with the folder's path, removes the path.
  template <class Work>
  [[nodiscard]] std::string error_of(const Work& work) const {
    const std::string error = input_error_of(work), folder = path_.string() + "/";
    return error.starts_with(folder) ? error.substr(folder.size()) : error;
  }

 private:
  std::filesystem::path path_;
};

}  // namespace raygate
