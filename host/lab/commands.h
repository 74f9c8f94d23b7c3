// The subcommands of `lab`.
#pragma once

#include <filesystem>
#include <string>

namespace CLI {
class App;
}

namespace raygate::lab {

/// What all commands have in common.
struct Common {
  std::filesystem::path results;  ///< where to keep the rows; empty: they are printed only
  int status = 0;                 ///< the program's exit status, set by the command that ran
};

// Each declares a subcommand with its options; parsing its name runs it.
void add_stress(CLI::App& lab, Common& common);      ///< engines and variants in hard cases
void add_predicates(CLI::App& lab, Common& common);  ///< what an exact decision costs
void add_variants(CLI::App& lab, Common& common);    ///< the table of variants
void add_check(CLI::App& lab, Common& common);       ///< reference models against hardware
void add_pictures(CLI::App& lab, Common& common);    ///< pictures by any variant, timed and judged
void add_rays(CLI::App& lab, Common& common);        ///< rays per second, next to Embree's
void add_core(CLI::App& lab, Common& common);        ///< clocks a ray of the ray core
void add_skips(CLI::App& lab, Common& common);       ///< what each skip saves
void add_techniques(CLI::App& lab,
                    Common& common);  ///< what each technique of the path tracer gains

}  // namespace raygate::lab
