// A library to preload into a program (LD_PRELOAD). It makes chosen calls to the C library fail.
//
//   RAYGATE_FAULT=KIND:N        call number N of this kind since the start of main() fails. KIND is
//                               memory (malloc and the like: ENOMEM), large (allocations of 4 KiB
//                               and more; all from call N on), write (ENOSPC), sync (fsync: EIO)
//                               or rename (EIO).
//   RAYGATE_FAULT_COUNT=FILE    FILE gets the numbers of calls, by kind in this order, at the end
//
// The method is that of SQLite's tests ("How SQLite Is Tested", section 3).
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>

extern "C" {
// glibc's own functions, which the library does not replace.
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* old, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
}

namespace {

enum Kind { kMemory, kLarge, kWrite, kSync, kRename, kKinds };
constexpr std::array<const char*, kKinds> kNames = {"memory", "large", "write", "sync", "rename"};
constexpr std::size_t kLargeBytes = 4096;

std::array<std::atomic<long>, kKinds> calls;
std::atomic<bool> counts = false;
int failing_kind = -1;
long first_failing = 0;

/// Counts a call of this kind. Returns whether it must fail; if so, sets errno.
bool fails(Kind kind, int error) {
  if (!counts) return false;
  const long call = ++calls[kind];
  if (kind != failing_kind || call < first_failing || (call > first_failing && kind != kLarge)) {
    return false;
  }
  errno = error;
  return true;
}

bool no_memory(std::size_t size) {
  const bool is_large = size >= kLargeBytes && fails(kLarge, ENOMEM);
  return fails(kMemory, ENOMEM) || is_large;
}

void read_wish() {
  const char* const wish = std::getenv("RAYGATE_FAULT");
  if (wish == nullptr) return;
  const std::size_t length = std::strcspn(wish, ":");
  for (int kind = 0; kind < kKinds; ++kind) {
    const char* const name = kNames[static_cast<std::size_t>(kind)];
    if (std::strlen(name) == length && std::strncmp(wish, name, length) == 0) failing_kind = kind;
  }
  if (wish[length] == ':') first_failing = std::strtol(wish + length + 1, nullptr, 10);
  if (failing_kind < 0 || first_failing < 1) std::abort();
}

void write_counts() {
  counts = false;
  const char* const file = std::getenv("RAYGATE_FAULT_COUNT");
  if (file == nullptr) return;
  std::FILE* const out = std::fopen(file, "w");
  if (out == nullptr) std::abort();
  for (const auto& count : calls) std::fprintf(out, "%ld ", count.load());
  std::fclose(out);
}

using Main = int (*)(int, char**, char**);
Main real_main = nullptr;

int counted_main(int argc, char** argv, char** environment) {
  read_wish();
  std::atexit(write_counts);
  counts = true;
  return real_main(argc, argv, environment);
}

}  // namespace

// Replacements of C library functions must have the same names.
extern "C" {

int __libc_start_main(Main main, int argc, char** argv, void (*init)(), void (*fini)(),
                      void (*rtld_fini)(), void* stack_end) {
  real_main = main;
  const auto start =
      reinterpret_cast<decltype(&__libc_start_main)>(::dlsym(RTLD_NEXT, "__libc_start_main"));
  return start(counted_main, argc, argv, init, fini, rtld_fini, stack_end);
}

void* malloc(std::size_t size) { return no_memory(size) ? nullptr : __libc_malloc(size); }
void* calloc(std::size_t count, std::size_t size) {
  return no_memory(count * size) ? nullptr : __libc_calloc(count, size);
}
void* realloc(void* old, std::size_t size) {
  return no_memory(size) ? nullptr : __libc_realloc(old, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  return no_memory(size) ? nullptr : __libc_memalign(alignment, size);
}
int posix_memalign(void** result, std::size_t alignment, std::size_t size) {
  if (no_memory(size)) return ENOMEM;
  *result = __libc_memalign(alignment, size);
  return *result == nullptr ? ENOMEM : 0;
}
ssize_t write(int file, const void* bytes, std::size_t count) {
  return fails(kWrite, ENOSPC) ? -1 : ::syscall(SYS_write, file, bytes, count);
}
int fsync(int file) {
  return fails(kSync, EIO) ? -1 : static_cast<int>(::syscall(SYS_fsync, file));
}
int rename(const char* from, const char* to) noexcept {
  return fails(kRename, EIO) ? -1 : static_cast<int>(::syscall(SYS_rename, from, to));
}
}
