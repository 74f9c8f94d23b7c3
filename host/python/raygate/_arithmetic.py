"""Arithmetic as IEEE 754 has it, whatever other modules of the process have set."""

import functools

from . import _raygate


def in_ieee_floats(function):
    """Runs `function`, on the thread that calls it and on those that it starts, rounding to nearest,
    with subnormals and without traps; then the thread's state is what it was."""
    @functools.wraps(function)
    def guarded(*arguments, **keywords):
        with _raygate.IeeeFloats():
            return function(*arguments, **keywords)
    return guarded
