#include "host/app/console.h"

#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstring>
#include <new>
#include <set>

#include "host/base/input_error.h"
#include "host/base/vectors.h"
#include "host/exact/ieee_floats.h"

namespace raygate {
namespace {

constexpr const char* kEraseLine = "\r\x1b[K";

constexpr int kUserError = 2;
constexpr const char* kOutOfMemory = "out of memory";

int why_output_failed = 0;  // errno of a failed print; 0: none failed
std::atomic<int> noted_signal = 0;
static_assert(std::atomic<int>::is_always_lock_free, "signal handlers may use nothing else");

/// Size in bytes of the memory that is released at the first failed allocation. The error message
/// needs memory, and so do some destructors, such as those of JSON values.
constexpr std::size_t kReserve = std::size_t{1} << 20;
std::atomic<void*> reserve = nullptr;

void note(int signal) { noted_signal = signal; }

/// Returns the bytes of the UTF-8 character at the start of `text`; 0 if it is not printable.
std::size_t shown_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(0);
  if (first < 0x80) return first >= 0x20 && first != 0x7f ? 1 : 0;
  const std::size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  if (first < 0xc2 || first > 0xf4 || text.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if (byte(i) < 0x80 || byte(i) > 0xbf) return 0;
  }
  return first == 0xc2 && byte(1) < 0xa0 ? 0 : length;  // U+0080 to U+009F are control characters
}

int report_error(int status, const char* what) {
  std::fprintf(stderr, "error: %s\n", printable(what).c_str());
  return status;
}

}  // namespace

std::string format_fixed(double value, int digits) {
  char text[400];  // the largest double has 309 digits before the point
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

std::string format_count(std::uint64_t count) {
  const std::string digits = std::to_string(count);
  std::string text;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) text += ',';
    text += digits[i];
  }
  return text;
}

std::string format_count(std::uint64_t count, const std::string& noun) {
  return format_count(count) + " " + noun + (count == 1 ? "" : "s");
}

std::string format_duration(double seconds) {
  if (!(seconds >= 0.0) || seconds > 1e9) return "?";
  if (seconds < 59.95) {
    const bool milli = seconds < 0.9995;
    const double value = milli ? seconds * 1e3 : seconds;
    const int digits = value < 9.995 ? 2 : value < 99.95 ? 1 : 0;
    return format_fixed(value, digits) + (milli ? " ms" : " s");
  }
  const long whole = std::lround(seconds);
  const bool minutes = whole < 3600;
  const long unit = minutes ? 1 : 60;
  char text[64];
  std::snprintf(text, sizeof text, minutes ? "%ld min %02ld s" : "%ld h %02ld min",
                whole / unit / 60, whole / unit % 60);
  return text;
}

std::string format_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.7g", value);
  return text;
}

std::string progress_text(double fraction, double elapsed) {
  std::string text =
      "rendering: " + std::to_string(static_cast<int>(100.0 * std::clamp(fraction, 0.0, 1.0))) +
      " %";
  // An estimate from less than 1 % of the work would be too coarse.
  if (fraction < 0.01) return text;
  return text + ", " + format_duration(elapsed * (1.0 - fraction) / fraction) + " left";
}

ProgressLine::ProgressLine(bool enabled) : enabled_(enabled && ::isatty(STDERR_FILENO) != 0) {}

void ProgressLine::erase() {
  if (drawn_) std::fputs(kEraseLine, stderr);
  drawn_ = false;
}

void ProgressLine::update(double fraction) {
  const Clock::time_point now = Clock::now();
  if (!enabled_ || (drawn_ && now - last_ < std::chrono::milliseconds(100))) return;
  last_ = now;
  drawn_ = true;
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  std::fprintf(stderr, "%s%s", kEraseLine, progress_text(fraction, elapsed).c_str());
}

std::string printable(std::string_view text, bool newlines) {
  std::string shown;
  while (!text.empty()) {
    std::size_t length = shown_length(text);
    if (length == 0 && newlines && text[0] == '\n') length = 1;
    if (length > 0) {
      shown += text.substr(0, length);
    } else {
      char code[8];
      std::snprintf(code, sizeof code, "\\x%02X", static_cast<unsigned char>(text[0]));
      shown += code;
      length = 1;
    }
    text.remove_prefix(length);
  }
  return shown;
}

void print(std::string_view text, std::FILE* stream) {
  errno = 0;
  if (std::fputs(printable(text, true).c_str(), stream) < 0 && stream == stdout) {
    why_output_failed = errno;
  }
}

void print_warning(std::string_view what) {
  std::fprintf(stderr, "warning: %s\n", printable(what).c_str());
}

void print_warnings(const std::vector<std::string>& warnings, bool all) {
  constexpr std::size_t kMost = 10;
  std::set<std::string> seen;
  for (const std::string& warning : warnings) {
    if (seen.insert(warning).second && (all || seen.size() <= kMost)) print_warning(warning);
  }
  if (!all && seen.size() > kMost) {
    print_warning("and " + std::to_string(seen.size() - kMost) + " more; --verbose lists them");
  }
}

void flush_standard_output() {
  errno = 0;
  const bool failed = std::fflush(stdout) != 0 || std::ferror(stdout) != 0;
  if (!failed) return;
  const int why = why_output_failed != 0 ? why_output_failed : errno;
  if (why == EPIPE) {  // as after `| head`: ends without a message
    std::signal(SIGPIPE, SIG_DFL);
    std::raise(SIGPIPE);
  }
  const std::string reason = why != 0 ? std::strerror(why) : "an earlier write failed";
  throw InputError("standard output: cannot write: " + reason);
}

int run_guarded(const std::function<int()>& program) {
  // A file beyond the size limit, or a pipe without a reader, is a failed write, not a signal.
  std::signal(SIGXFSZ, SIG_IGN);
  std::signal(SIGPIPE, SIG_IGN);
  try {
    try {
      // The reserve is optional: a second call of run_guarded may find no memory for it.
      ::operator delete(reserve.exchange(::operator new(kReserve, std::nothrow)));
      std::set_new_handler([] {
        void* const memory = reserve.exchange(nullptr);
        if (memory == nullptr) throw std::bad_alloc();
        ::operator delete(memory);
      });
      int status = 0;
      try {
        status = program();
      } catch (const Information& asked) {
        print(asked.what());
      }
      flush_standard_output();
      return status;
    } catch (const InputError& unusable) {
      return report_error(kUserError, unusable.what());
    } catch (const Interrupted& interrupted) {
      return report_error(kSignalBase + interrupted.signal, interrupted.what());
    } catch (const std::bad_alloc&) {
      return report_error(kUserError, kOutOfMemory);
    } catch (const std::length_error&) {  // a length beyond any memory
      return report_error(kUserError, kOutOfMemory);
    } catch (const std::exception& fault) {
      return report_error(1, fault.what());
    }
  } catch (const std::bad_alloc&) {  // no memory for the error message
    std::fprintf(stderr, "error: %s\n", kOutOfMemory);
    return kUserError;
  }
}

int run_main(int argc, char** argv,
             const std::function<int(const std::vector<std::string>&)>& program) {
  const auto body = [&] {
    require_ieee_floats();
    try {
      use_vectors(wanted_vectors());
    } catch (const std::runtime_error& error) {
      throw InputError(error.what());
    }
    try {
      return program({argv + 1, argv + argc});
    } catch (const Information& asked) {
      std::string text = asked.what(), path = argv[0];  // cut to "./" or "bin/raygate-"
      path.resize(path.find_last_not_of("abcdefghijklmnopqrstuvwxyz") + 1);
      for (std::size_t at = 0; (at = text.find("./", at)) != text.npos; at += path.size()) {
        text.replace(at, 2, path);
      }
      throw Information(text);
    }
  };
  // Freed arrays return to the system, which lowers the peak memory.
  ::mallopt(M_MMAP_THRESHOLD, 1 << 20);
  return run_guarded(std::ref(body));  // a copy would allocate memory outside run_guarded
}

void handle_interruptions(void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART | static_cast<int>(SA_RESETHAND);  // a second signal kills
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction old {};
    if (::sigaction(signal, nullptr, &old) == 0 && old.sa_handler != SIG_IGN) {
      ::sigaction(signal, &action, nullptr);
    }
  }
}

void note_interruptions() { handle_interruptions(note); }

int interruption() { return noted_signal; }

}  // namespace raygate
