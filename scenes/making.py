"""Functions shared by the scripts of this folder: options that are numbers, and the error for a file that cannot be written."""

import argparse
import sys
from collections.abc import Callable


def at_least(least: int) -> Callable[[str], int]:
    """Returns an argparse `type` for whole numbers of at least `least`."""
    def checked(text: str) -> int:
        try:
            number = int(text)
        except ValueError:
            number = least - 1
        if number < least:
            raise argparse.ArgumentTypeError(f"expected a whole number, {least} or more, got {text!r}")
        return number
    return checked


def run(main: Callable[[], None]) -> None:
    """Runs `main`. If a file cannot be used, prints one line and ends the program with status 2."""
    try:
        main()
    except OSError as error:
        print(f"error: {error.filename}: {error.strerror}", file=sys.stderr)
        sys.exit(2)
