// The program `render`.
#include "host/cli/options.h"
#include "host/cli/process.h"
#include "host/cli/run.h"
#include "host/exact/ieee_floats.h"

int main(int argc, char** argv) {
  const auto program = [&] {
    raygate::require_ieee_floats();
    raygate::choose_vectors();
    const raygate::Options options = raygate::parse_options(argc, argv);
    if (options.information.empty()) {
      raygate::run(options);
    } else {
      raygate::print(options.information);
    }
    return 0;
  };
  return raygate::run_guarded(program, 1);
}
