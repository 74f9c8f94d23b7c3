"""Measures area and delay of the adders, cores and units of hw/ with Yosys, ABC, OpenSTA and nextpnr."""

import sys
from types import TracebackType


def _tell(kind: type[BaseException], error: BaseException, trace: TracebackType | None) -> None:
    """Prints one line for Ctrl-C and a traceback for any other exception. After Ctrl-C, Python exits with status 130."""
    if issubclass(kind, KeyboardInterrupt):
        print("interrupted; what was finished is kept", file=sys.stderr)
    else:
        sys.__excepthook__(kind, error, trace)


sys.excepthook = _tell
