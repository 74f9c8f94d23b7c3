"""Context of each call of the module: IEEE 754 arithmetic, regardless of other modules' settings, and Ctrl-C."""

from __future__ import annotations

import functools
from typing import Any, Callable, TypeVar, cast

from . import _raygate

_Function = TypeVar("_Function", bound=Callable[..., Any])


def in_context(function: _Function) -> _Function:
    """Returns `function` with IEEE 754 arithmetic: it rounds to nearest, with subnormals and without traps, also on threads that it
    starts. After a call, the calling thread's state is restored. During a call, Python's signal handlers run several times per 100 ms.
    Their exceptions, such as KeyboardInterrupt, end the call."""
    @functools.wraps(function)
    def guarded(*arguments: Any, **keywords: Any) -> Any:
        return _raygate.call_in_context(function, *arguments, **keywords)
    return cast(_Function, guarded)
