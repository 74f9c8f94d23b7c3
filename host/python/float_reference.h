// Float arithmetic for the Python module: the reference model of the float cores' tests.
#pragma once

#include <nanobind/nanobind.h>

namespace raygate {

/// Adds the functions that raygate/float.py calls.
void add_float_reference(nanobind::module_& m);

}  // namespace raygate
