// One run of the program: scene in, pictures and statistics out.
#pragma once

#include "host/cli/options.h"
#include "host/ranks/ranks.h"

namespace raygate {

/// Renders what `options` ask for, writes the pictures, prints warnings and progress on standard
/// error and statistics on standard output. Throws InputError for what the user has to mend,
/// IntersectorMismatch, and other exceptions for our own faults: then no output file of the picture
/// at hand has changed, unless the failure is that a later one could not be written. Throws
/// Interrupted after writing what had been rendered, marked as partial.
/// Each of several ranks calls it: they share the picture, and rank 0 writes it; of an animation
/// each renders and writes some frames.
void run(const Options& options, Ranks& ranks);

}  // namespace raygate
