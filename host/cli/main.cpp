// The program `render`. Errors of all kinds become one line and an exit status here.
#include <csignal>
#include <cstdio>
#include <exception>
#include <new>

#include "host/cli/interrupt.h"
#include "host/cli/options.h"
#include "host/cli/run.h"
#include "host/exact/ieee_floats.h"
#include "host/scene/io/input_error.h"

namespace {

constexpr int kInternalError = 1;
constexpr int kUserError = 2;
constexpr int kSignalBase = 128;  // as shells report a death by signal

int fail(int status, const char* message) {
  std::fprintf(stderr, "error: %s\n", message);
  return status;
}

}  // namespace

int main(int argc, char** argv) {
  // A file that grows past the user's limit becomes a failed write, not a death.
  std::signal(SIGXFSZ, SIG_IGN);
  try {
    raygate::require_ieee_floats();
    const raygate::Options options = raygate::parse_options(argc, argv);
    if (options.information.empty()) {
      raygate::run(options);
    } else {
      std::fputs(options.information.c_str(), stdout);
    }
    return 0;
  } catch (const raygate::InputError& error) {
    return fail(kUserError, error.what());
  } catch (const raygate::Interrupted& interrupted) {
    return fail(kSignalBase + interrupted.signal(), interrupted.what());
  } catch (const std::bad_alloc&) {
    return fail(kUserError, "out of memory; a smaller --size or --crop needs less");
  } catch (const std::exception& error) {
    return fail(kInternalError, error.what());
  }
}
