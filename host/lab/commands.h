// The commands of `lab`.
#pragma once

#include "host/lab/results.h"

namespace CLI {
class App;
}

namespace raygate::lab {

struct Outcome {
  Results results;
  int status = 0;  ///< the program's exit status
};

/// Declares a command with its options; parsing its name runs it.
using AddCommand = void(CLI::App& lab, Outcome& outcome);

AddCommand add_stress;      ///< correctness of engines and variants in hard cases
AddCommand add_watertight;  ///< public tests of watertightness
AddCommand add_rays;        ///< rays per second, compared with Embree
AddCommand add_core;        ///< clocks per ray of the ray core
AddCommand add_variants;    ///< the table of variants
AddCommand add_check;       ///< reference models against hardware
AddCommand add_pictures;    ///< images by any variant, timed and audited

}  // namespace raygate::lab
