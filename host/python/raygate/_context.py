"""Context of each call of the module: IEEE 754 arithmetic, regardless of other modules' settings, and Ctrl-C."""

from __future__ import annotations

import functools
from typing import Any, Callable, TypeVar, cast

from . import _raygate

_Function = TypeVar("_Function", bound=Callable[..., Any])


def in_context(function: _Function) -> _Function:
    """Returns `function`, which rounds to nearest, with subnormals and without traps, on the calling thread and on
    threads that it starts. It restores the state of the calling thread. It runs Python's signal handlers several
    times per 100 ms; their exceptions, such as KeyboardInterrupt, end the call."""
    @functools.wraps(function)
    def guarded(*arguments: Any, **keywords: Any) -> Any:
        return _raygate.call_in_context(function, *arguments, **keywords)
    return cast(_Function, guarded)
