#include "host/image/replace_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <optional>
#include <string>
#include <system_error>

#include "host/scene/input_error.h"

namespace raygate {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, int error) {
  throw InputError(path.string() + ": cannot write: " + std::generic_category().message(error));
}

/// An open file that is closed on the way out.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  [[nodiscard]] int get() const { return fd_; }
  /// 0, or the error that only closing brought to light (network file systems, quotas).
  [[nodiscard]] int close() {
    const int result = ::close(fd_);
    fd_ = -1;
    return result == 0 ? 0 : errno;
  }

 private:
  int fd_;
};

/// 0, or the error that stopped the writing.
[[nodiscard]] int write_all(int fd, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(fd, bytes.data(), bytes.size());
    if (written >= 0) {
      bytes.remove_prefix(static_cast<std::size_t>(written));
    } else if (errno != EINTR) {
      return errno;
    }
  }
  return 0;
}

/// A new empty file in `folder`, removed again unless it was given a lasting name.
class TemporaryFile {
 public:
  /// Throws InputError in the name of `target` where the folder takes no new file.
  TemporaryFile(const fs::path& folder, const fs::path& target) : file_(-1) {
    // Created with open, not mkstemp, so that the user's umask decides the permissions.
    int fd = -1;
    for (int attempt = 0; fd < 0; ++attempt) {
      path_ = folder / (".raygate-" + std::to_string(::getpid()) + "-" + std::to_string(attempt));
      fd = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
      if (fd < 0 && errno != EEXIST) fail(target, errno);
    }
    file_.emplace(fd);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    if (!path_.empty()) ::unlink(path_.c_str());
  }

  /// Fills the file and gives it the name `target`; 0 or the error.
  [[nodiscard]] int become(const fs::path& target, std::string_view bytes,
                           std::optional<mode_t> permissions) {
    if (const int error = write_all(file_->get(), bytes)) return error;
    if (permissions && ::fchmod(file_->get(), *permissions) != 0) return errno;
    if (::fsync(file_->get()) != 0) return errno;
    if (const int error = file_->close()) return error;
    if (::rename(path_.c_str(), target.c_str()) != 0) return errno;
    path_.clear();
    return 0;
  }

 private:
  fs::path path_;
  std::optional<Descriptor> file_;
};

/// Where the bytes will really go, and what is there now.
struct Target {
  fs::path path;                      ///< symbolic links resolved
  bool is_stream = false;             ///< a device, pipe or socket: nothing to keep whole
  std::optional<mode_t> permissions;  ///< of the file that is there
};

Target inspect(const fs::path& path) {
  std::error_code error;
  Target target;
  target.path = fs::weakly_canonical(path, error);
  if (error) fail(path, error.value());
  struct stat status;
  if (::stat(path.c_str(), &status) != 0) {
    if (errno != ENOENT) fail(path, errno);
    return target;
  }
  if (S_ISDIR(status.st_mode)) fail(path, EISDIR);
  if (::access(path.c_str(), W_OK) != 0) fail(path, errno);
  target.is_stream = !S_ISREG(status.st_mode);
  if (!target.is_stream) target.permissions = status.st_mode & 07777;
  return target;
}

}  // namespace

void replace_file(const fs::path& path, std::string_view bytes) {
  const Target target = inspect(path);
  int error = 0;
  if (target.is_stream) {
    Descriptor stream(::open(path.c_str(), O_WRONLY | O_CLOEXEC));
    error = stream.get() < 0 ? errno : write_all(stream.get(), bytes);
    if (error == 0) error = stream.close();
  } else {
    TemporaryFile file(target.path.parent_path(), path);
    error = file.become(target.path, bytes, target.permissions);
  }
  if (error != 0) fail(path, error);
}

void require_replaceable(const fs::path& path) {
  const Target target = inspect(path);
  if (!target.is_stream) TemporaryFile probe(target.path.parent_path(), path);
}

}  // namespace raygate
