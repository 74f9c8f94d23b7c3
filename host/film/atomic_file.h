// Atomic files: a target is always the complete old or the complete new file.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <span>
#include <string_view>

namespace raygate {

/// A file that is written under a temporary name in the target's folder and synced to disk.
/// commit() renames it to the target, so after any failure the target is the complete old or the
/// complete new file. Several files can be staged before the first target is replaced.
///
/// Symbolic links are followed, also to missing targets; the permissions of an old file are kept.
/// Other hard links of the old file keep the old contents. Bytes for a device, a pipe or standard
/// output (/dev/stdout) are written immediately; a pipe without a reader is an error. All errors
/// are InputError, "path: cannot write: reason".
class AtomicFile {
 public:
  /// Starts an empty file for `path`.
  explicit AtomicFile(const std::filesystem::path& path);
  /// Writes `bytes` as the file for `path`.
  AtomicFile(const std::filesystem::path& path, std::string_view bytes);
  AtomicFile(AtomicFile&& other) noexcept;
  AtomicFile& operator=(AtomicFile&&) = delete;
  ~AtomicFile();  ///< removes the temporary file unless it was committed

  void append(std::string_view bytes);
  /// Syncs the file to disk; nothing can be appended after that.
  void finish();
  /// Finishes the file, renames it to the target and syncs the folder. Call it at most once.
  void commit();
  /// Returns the temporary name, or a stream's own name, for code that writes the file itself.
  [[nodiscard]] const std::filesystem::path& unnamed() const {
    return is_stream() ? name_ : temporary_;
  }
  /// Returns whether the target is a device, a pipe or standard output.
  [[nodiscard]] bool is_stream() const { return temporary_.empty(); }

 private:
  friend void require_writable(const std::filesystem::path& path);

  void fail_if(int error);

  std::filesystem::path name_;         ///< as the user wrote it, for messages
  std::filesystem::path target_;       ///< symbolic links resolved
  std::filesystem::path temporary_;    ///< empty: none
  std::optional<mode_t> permissions_;  ///< permissions of the old file
  int descriptor_ = -1;                ///< -1: closed
};

/// Throws InputError if one of `outputs` is, or will be, the same file as one of `inputs` or
/// another output, under any name: "a.png: would overwrite scene.mtl".
void require_distinct(std::span<const std::filesystem::path> outputs,
                      std::span<const std::filesystem::path> inputs);

/// Returns whether `file` is standard output.
[[nodiscard]] bool is_standard_output(const std::filesystem::path& file);

/// Throws the InputError that an AtomicFile for `path` would throw now. Changes nothing. Call it
/// before a long computation of the file's contents.
void require_writable(const std::filesystem::path& path);

}  // namespace raygate
