#include "sim/model_loader.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <mutex>
#include <string>

#include "host/base/input_error.h"
#include "sim/simulation.h"

namespace raygate {
namespace {

constexpr const char* kBuildFolder = RAYGATE_BUILD_FOLDER;
constexpr const char* kModels = RAYGATE_BUILD_FOLDER "/sim/models/";

[[noreturn]] void fail(const ModelFile& file, const std::string& what) {
  throw InputError(std::string(file.what) + " is not built yet, and " + what + "; to build it: " +
                   "cmake --build " + std::string(kBuildFolder) + " --target " + file.name + ".so");
}

/// A lock, held until destruction, that keeps other processes from building in the same folder.
class BuildLock {
 public:
  explicit BuildLock(const ModelFile& file)
      : descriptor_(
            ::open((std::string(kModels) + "lock").c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0666)) {
    if (descriptor_ < 0 || ::access(kBuildFolder, W_OK) != 0) {
      const int why = errno;
      if (descriptor_ >= 0) ::close(descriptor_);
      fail(file, std::string(kBuildFolder) + " cannot be written: " + std::strerror(why));
    }
    while (::flock(descriptor_, LOCK_EX) != 0 && errno == EINTR) continue;
  }
  BuildLock(const BuildLock&) = delete;
  BuildLock& operator=(const BuildLock&) = delete;
  ~BuildLock() { ::close(descriptor_); }

 private:
  int descriptor_;
};

/// Quotes `text` for a shell.
std::string quoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

void build(const ModelFile& file) {
  const std::string log = std::string(kModels) + file.name + ".log";
  std::fprintf(stderr, "building %s once (about %d s)\n", file.what, file.seconds);
  const std::string command = quoted(RAYGATE_CMAKE) + " --build " + quoted(kBuildFolder) +
                              " --target " + file.name + ".so >" + quoted(log) + " 2>&1";
  const int status = std::system(command.c_str());  // NOLINT(bugprone-command-processor): ours
  if (WIFSIGNALED(status)) std::raise(WTERMSIG(status));  // Ctrl-C ends this program, too
  if (status != 0) fail(file, "building it failed (" + log + ")");
}

/// Opens a model's file. Returns null if the file is missing or incomplete.
void* open_file(const ModelFile& file) {
  return ::dlopen((std::string(kModels) + file.name + ".so").c_str(), RTLD_NOW | RTLD_LOCAL);
}

void* make_model_of(const ModelFile& file) {
  void* library = open_file(file);
  if (library == nullptr) {
    const BuildLock lock(file);
    library = open_file(file);  // built by another process meanwhile
    if (library == nullptr) build(file);
    if (library == nullptr) library = open_file(file);
  }
  void* const factory = library != nullptr ? ::dlsym(library, "make_model") : nullptr;
  if (factory == nullptr) fail(file, std::string("what was built is no model: ") + ::dlerror());
  return factory;
}

}  // namespace

bool has_simulation() { return true; }

void* load_model(const ModelFile& file) {
  static std::mutex mutex;
  static std::map<std::string, void*> loaded;  // never unloaded, because models use the code
  const std::lock_guard lock(mutex);
  void*& factory = loaded[file.name];
  if (factory == nullptr) factory = make_model_of(file);
  return factory;
}

}  // namespace raygate
