// lab: measurements on the host, with one subcommand each. `lab --help` lists them.
#include <CLI/CLI.hpp>

#include "host/app/process.h"
#include "host/lab/commands.h"

namespace {

int run(int argc, char** argv) {
  using namespace raygate;
  CLI::App app("Measures raygate: how wrong, how fast, at what cost. make targets call it.", "lab");
  std::filesystem::path file;
  app.add_option("--results", file, "keep all that is found in this file: a JSON object a line");
  app.require_subcommand(1);
  lab::Outcome outcome;
  for (lab::AddCommand* const add :
       {lab::add_stress, lab::add_watertight, lab::add_rays, lab::add_core, lab::add_variants,
        lab::add_check, lab::add_pictures}) {
    add(app, outcome);
  }
  try {
    app.parse(argc, argv);
    if (!file.empty()) outcome.results.write(file);
    return outcome.status;
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
}

}  // namespace

int main(int argc, char** argv) {
  return raygate::run_main(argc, argv, [&](const auto&) { return run(argc, argv); });
}
