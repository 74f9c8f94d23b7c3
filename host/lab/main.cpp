// lab: measurements on the host, with one subcommand each. `lab --help` lists them.
#include <CLI/CLI.hpp>

#include "host/app/console.h"
#include "host/lab/lab.h"

namespace {

int run(int argc, char** argv) {
  using namespace raygate;
  CLI::App app(
      "Measures raygate: how wrong, how fast, at what cost. Prints JSON objects, one a line, of "
      "which `python3 -m host.lab` makes tables.",
      "lab");
  app.require_subcommand(1);
  for (lab::AddCommand* const add :
       {lab::add_stress, lab::add_watertight, lab::add_rays, lab::add_core, lab::add_variants,
        lab::add_check, lab::add_pictures}) {
    add(app);
  }
  try {
    app.parse(argc, argv);
    return 0;
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
}

}  // namespace

int main(int argc, char** argv) {
  return raygate::run_main(argc, argv, [&](const auto&) { return run(argc, argv); });
}
