// Atomic files: a target holds the old file or the new one, whole, whatever fails.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <span>
#include <string_view>
#include <system_error>

namespace raygate {

/// A file that is written but does not have its name yet. The bytes go to a temporary file in the
/// target's folder and reach the disk; commit() gives it the name in one step. So whoever looks at
/// the target, at whatever moment and whatever fails, finds the old file or the new one, whole;
/// and several files can be made ready before the first one is replaced.
///
/// Symbolic links are followed, to what is not there yet as well; an old file's permissions are
/// kept. Its other names (hard links) keep the old file: a file that is replaced in one step is
/// another one. A device, a pipe or standard
/// output (/dev/stdout) has nothing to keep whole: the bytes go there at once, or fail where no
/// process has the pipe open. All errors are InputError, "path: cannot write: reason".
class AtomicFile {
 public:
  /// Begins a file for `path`, to be written bit by bit.
  explicit AtomicFile(const std::filesystem::path& path);
  /// Writes `bytes`, all of the file, for `path`.
  AtomicFile(const std::filesystem::path& path, std::string_view bytes);
  AtomicFile(AtomicFile&& other) noexcept;
  AtomicFile& operator=(AtomicFile&&) = delete;
  ~AtomicFile();  ///< removes the temporary file if commit() did not use it

  /// Adds `bytes` at the end.
  void append(std::string_view bytes);
  /// Puts `bytes` over the first ones: a header that counts what came after it. Not in a stream.
  void replace_start(std::string_view bytes);
  /// Brings all of it to the disk; nothing can be added then.
  void finish();
  /// Makes the target the new file, finished, and brings its name to the disk. At most once.
  void commit();
  /// A name for code that writes all bytes by itself.
  [[nodiscard]] const std::filesystem::path& unnamed() const {
    return is_stream() ? name_ : temporary_;
  }
  /// Whether it goes to a device, a pipe or standard output.
  [[nodiscard]] bool is_stream() const { return temporary_.empty(); }

 private:
  void fail_if(int error);

  std::filesystem::path name_;         ///< as the user wrote it, for messages
  std::filesystem::path target_;       ///< symbolic links resolved
  std::filesystem::path temporary_;    ///< empty: none
  std::optional<mode_t> permissions_;  ///< of the file that is there
  int descriptor_ = -1;                ///< -1: closed
};

/// The absolute path that `name` leads to when all symbolic links are followed, also to what is not
/// there yet.
[[nodiscard]] std::filesystem::path target_of(const std::filesystem::path& name,
                                              std::error_code& error);

/// Throws InputError where one of `outputs` is, under whatever name, one of `inputs`: "a.png: would
/// overwrite scene.mtl".
void require_distinct(std::span<const std::filesystem::path> outputs,
                      std::span<const std::filesystem::path> inputs);

/// Whether writing to `file` is writing to standard output.
[[nodiscard]] bool is_standard_output(const std::filesystem::path& file);

/// Throws the InputError that an AtomicFile for `path` would throw now: the folder is missing, no
/// permission, a folder of that name, a pipe without a reader. Changes nothing. Call it before
/// hours of work whose result goes to `path`.
void require_writable(const std::filesystem::path& path);

}  // namespace raygate
