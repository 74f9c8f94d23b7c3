"""What each call of the module sets up: IEEE 754 arithmetic, whatever other modules have set, and Ctrl-C."""

from __future__ import annotations

import functools
from typing import Any, Callable, TypeVar, cast

from . import _raygate

_Function = TypeVar("_Function", bound=Callable[..., Any])


def in_context(function: _Function) -> _Function:
    """Returns `function`, which rounds to nearest, with subnormals and without traps, on the thread that calls it and
    on those that it starts. It restores the state of the calling thread. It runs Python's signal handlers several
    times in 100 ms; what they raise, such as KeyboardInterrupt, ends the call."""
    @functools.wraps(function)
    def guarded(*arguments: Any, **keywords: Any) -> Any:
        with _raygate.CallContext():
            return function(*arguments, **keywords)
    return cast(_Function, guarded)
