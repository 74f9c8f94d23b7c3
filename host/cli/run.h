// One run of the program: scene in, pictures and statistics out.
#pragma once

#include "host/cli/options.h"

namespace raygate {

/// Renders what `options` ask for, writes the pictures, prints warnings and progress on standard
/// error and statistics on standard output. Throws InputError for what the user has to mend,
/// FinderMismatch, and other exceptions for our own faults: then no output file of the picture
/// at hand has changed, unless the failure is that a later one could not be written. Throws
/// Interrupted after writing what had been rendered, marked as partial.
void run(const Options& options);

}  // namespace raygate
