"""What the scripts beside it share: numbers on their command lines, and what becomes of a file that cannot be written."""

import argparse
import sys
from collections.abc import Callable


def at_least(least: int) -> Callable[[str], int]:
    """The `type` of an option: a whole number, no smaller than that."""
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
    """Runs `main` and ends the program: with status 2 and a line where a file cannot be used."""
    try:
        main()
    except OSError as error:
        print(f"error: {error.filename}: {error.strerror}", file=sys.stderr)
        sys.exit(2)
