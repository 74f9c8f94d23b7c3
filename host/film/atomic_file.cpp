#include "host/film/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <system_error>
#include <tuple>
#include <utility>
#include <vector>

#include "host/base/input_error.h"

namespace raygate {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, int error) {
  throw InputError(path.string() + ": cannot write: " + std::generic_category().message(error));
}

/// Returns the absolute path of `name` with all symbolic links resolved, even to missing files.
fs::path target_of(const fs::path& name, std::error_code& error) {
  constexpr int kMostLinks = 40;  // the limit of Linux
  fs::path end = fs::absolute(name, error);
  std::error_code ignored;
  for (int i = 0; i < kMostLinks && fs::is_symlink(end, ignored); ++i) {
    end = end.parent_path() / fs::read_symlink(end, ignored);
  }
  return error ? fs::path() : fs::weakly_canonical(end, error);
}

/// Opens the stream `name` and returns its descriptor.
int open_stream(const fs::path& name) {
  if (is_standard_output(name)) return ::dup(STDOUT_FILENO);
  // Opening a pipe would block until a reader comes; O_NONBLOCK makes it fail instead.
  const int fd = ::open(name.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC);
  if (fd < 0 && errno == ENXIO) throw InputError(name.string() + ": cannot write: nobody reads it");
  if (fd < 0) fail(name, errno);
  ::fcntl(fd, F_SETFL, ::fcntl(fd, F_GETFL) & ~O_NONBLOCK);
  return fd;
}

/// Creates a file next to `target`, and returns its path and descriptor.
std::pair<fs::path, int> create_beside(const fs::path& target, const fs::path& name) {
  // open() applies the user's umask, mkstemp() does not. A short name always fits, even if the
  // target's name has the maximum length.
  for (int attempt = 0;; ++attempt) {
    fs::path path = target.parent_path() /
                    (".raygate-" + std::to_string(::getpid()) + "-" + std::to_string(attempt));
    const int fd = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (fd >= 0) return {std::move(path), fd};
    if (errno != EEXIST) fail(name, errno);
  }
}

/// Syncs a new name in the target's folder to disk. Returns 0 or an error number. Folders that
/// cannot be opened, and file systems without this operation, count as success.
int sync_folder_of(const fs::path& target) {
  const fs::path parent = target.has_parent_path() ? target.parent_path() : ".";
  const int folder = ::open(parent.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return 0;
  const int error = ::fsync(folder) != 0 && errno != EINVAL && errno != EROFS ? errno : 0;
  ::close(folder);
  return error;
}

/// Writes all bytes. Returns 0 or an error number.
int write_all(int fd, std::string_view bytes) {
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

}  // namespace

AtomicFile::AtomicFile(const fs::path& path) : name_(path) {
  struct stat status {};
  const bool exists = ::stat(name_.c_str(), &status) == 0;
  if (!exists && errno != ENOENT) fail(name_, errno);
  if (exists && S_ISDIR(status.st_mode)) fail(name_, EISDIR);
  if (exists && ::access(name_.c_str(), W_OK) != 0) fail(name_, errno);
  if (exists && (!S_ISREG(status.st_mode) || is_standard_output(name_))) {
    descriptor_ = open_stream(name_);  // streams such as /dev/stdout may have no resolvable path
    return;
  }
  if (exists) permissions_ = status.st_mode & 07777;
  std::error_code error;
  target_ = target_of(name_, error);
  if (error) fail(name_, error.value());
  std::tie(temporary_, descriptor_) = create_beside(target_, name_);
}

AtomicFile::AtomicFile(const fs::path& path, std::string_view bytes) : AtomicFile(path) {
  append(bytes);
  finish();
}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : name_(std::move(other.name_)),
      target_(std::move(other.target_)),
      temporary_(std::exchange(other.temporary_, {})),
      permissions_(other.permissions_),
      descriptor_(std::exchange(other.descriptor_, -1)) {}

AtomicFile::~AtomicFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void AtomicFile::fail_if(int error) {
  if (error != 0) fail(name_, error);
}

void AtomicFile::append(std::string_view bytes) { fail_if(write_all(descriptor_, bytes)); }

void AtomicFile::finish() {
  if (descriptor_ < 0) return;
  int error = 0;
  if (permissions_ && ::fchmod(descriptor_, *permissions_) != 0) error = errno;
  // Some file systems report a full disk only here.
  if (error == 0 && !is_stream() && ::fsync(descriptor_) != 0) error = errno;
  if (::close(std::exchange(descriptor_, -1)) != 0 && error == 0) error = errno;
  fail_if(error);
}

void AtomicFile::commit() {
  finish();
  if (temporary_.empty()) return;
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) fail(name_, errno);
  temporary_.clear();
  fail_if(sync_folder_of(target_));
}

bool is_standard_output(const fs::path& file) {
  struct stat named {
  }, standard{};
  return ::stat(file.c_str(), &named) == 0 && ::fstat(STDOUT_FILENO, &standard) == 0 &&
         named.st_dev == standard.st_dev && named.st_ino == standard.st_ino;
}

void require_distinct(std::span<const fs::path> outputs, std::span<const fs::path> inputs) {
  std::error_code ignored;  // such paths are refused when they are read or written
  std::vector<fs::path> others(inputs.begin(), inputs.end());
  for (const fs::path& output : outputs) {
    const fs::path target = target_of(output, ignored);
    for (const fs::path& other : others) {
      if (fs::equivalent(output, other, ignored) ||
          (!target.empty() && target == target_of(other, ignored))) {
        throw InputError(output.string() + ": would overwrite " + other.string());
      }
    }
    others.push_back(output);
  }
}

void require_writable(const fs::path& path) {
  AtomicFile probe(path);
  // A pipe stays open until the program exits: its reader would take closing for the end of file.
  if (probe.is_stream() && fs::is_fifo(path)) probe.descriptor_ = -1;
}

}  // namespace raygate
