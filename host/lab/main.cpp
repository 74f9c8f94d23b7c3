// lab: everything that is measured on the host, one subcommand each. `lab --help` lists them.
#include <CLI/CLI.hpp>

#include "host/cli/process.h"
#include "host/exact/ieee_floats.h"
#include "host/lab/commands.h"

namespace {

int run(int argc, char** argv) {
  using namespace raygate;
  require_ieee_floats();
  choose_vectors();
  CLI::App app("Measures raygate: how wrong, how fast, at what cost. make targets call it.", "lab");
  lab::Common common;
  app.add_option("--results", common.results,
                 "keep all that is found in this file: a JSON object a line");
  app.require_subcommand(1);
  lab::add_stress(app, common);
  lab::add_predicates(app, common);
  lab::add_variants(app, common);
  lab::add_check(app, common);
  lab::add_pictures(app, common);
  lab::add_rays(app, common);
  lab::add_core(app, common);
  lab::add_skips(app, common);
  lab::add_techniques(app, common);
  try {
    app.parse(argc, argv);
    return common.status;
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
}

}  // namespace

int main(int argc, char** argv) {
  return raygate::run_guarded([&] { return run(argc, argv); }, 1);
}
