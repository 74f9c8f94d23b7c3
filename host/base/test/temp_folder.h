// A folder of files for one test, gone at its end; in memory where the system has a place for it.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>

#include "host/base/input_error.h"

namespace raygate {

class TempFolder {
 public:
  TempFolder() {
    const std::filesystem::path memory = "/dev/shm";
    const std::filesystem::path parent =
        access(memory.c_str(), W_OK) == 0 ? memory : std::filesystem::temp_directory_path();
    std::string name = (parent / "raygate_test_XXXXXX").string();
    if (!mkdtemp(name.data())) throw std::runtime_error("cannot make " + name);
    path_ = name;
  }
  ~TempFolder() { std::filesystem::remove_all(path_); }
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;

  /// Writes the bytes as they are and returns the file's path.
  std::filesystem::path write(const std::string& name, std::string_view bytes) const {
    const std::filesystem::path file = path_ / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << bytes;
    return file;
  }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  /// What follows "FOLDER/" in the InputError that `work` throws; "(read)" where it throws none.
  template <class Work>
  [[nodiscard]] std::string error_of(const Work& work) const {
    try {
      work();
    } catch (const InputError& error) {
      return std::string(error.what()).substr(path_.string().size() + 1);
    }
    return "(read)";
  }

 private:
  std::filesystem::path path_;
};

}  // namespace raygate
