"""Reads one design of hw/ from a command line."""

import argparse
import contextlib
import pathlib
import re
import sys
from collections.abc import Callable

from synth import brought, catalogue


def whole(least: int, most: int) -> Callable[[str], int]:
    """Returns an argparse `type` for options whose values are whole numbers from `least` to `most`."""
    def checked(text: str) -> int:
        if not re.fullmatch(r"\d+", text) or not least <= int(text) <= most:
            raise argparse.ArgumentTypeError(f"expected a whole number from {least} to {most}, got {text!r}")
        return int(text)
    return checked


def whole_numbers(text: str) -> list[int]:
    """Parses an option's value: comma-separated whole numbers from 1 to 255."""
    if not re.fullmatch(r"\d+(,\d+)*", text):
        raise argparse.ArgumentTypeError(f"expected whole numbers separated by commas, got {text!r}")
    return [whole(1, 255)(number) for number in text.split(",")]


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Adds the options that `design` reads."""
    parser.add_argument("--adder", default="", help="ripple, uniform, graded, prefix, behavioural, or a file of yours: my_adder.sv")
    parser.add_argument("--width", type=whole(1, catalogue.MOST_BITS), help="bits of an adder or a multiplier")
    parser.add_argument("--groups", type=whole_numbers, help="carry-select groups, least significant first: 4,5,7,...")
    parser.add_argument("--look-ahead", type=whole(0, 1), help="1: groups add by carry look-ahead, 0: by ripple carry, as those of an adder do if not given")
    parser.add_argument("--exp-width", type=whole(2, 15), help="exponent bits of a float core")
    parser.add_argument("--frac-width", type=whole(2, 112), help="fraction bits of a float core")
    parser.add_argument("--exact", type=whole(0, 64), help="exact_units of the ray core")


def parse(parser: argparse.ArgumentParser) -> argparse.Namespace:
    """Parses the command line. Names of options may be in capitals, like make's variables. Reports a wrong value in one line, without the
    usage message."""
    parser.print_usage = lambda *_: None
    return parser.parse_args([re.sub("^--[A-Z-]+", lambda name: name[0].lower(), word) for word in sys.argv[1:]])


def replaced(given: argparse.Namespace) -> contextlib.AbstractContextManager:
    """Returns a context. If option --adder names a file, it replaces the prefix adder within this context. Raises ValueError."""
    return brought.in_place(brought.bring({"ADDER": given.adder})) if given.adder.endswith(".sv") else contextlib.nullcontext()


def design(given: argparse.Namespace) -> catalogue.Design:
    """Returns the design that `given.top` and the options describe."""
    parameters = {"Width": given.width, "ExpWidth": given.exp_width, "FracWidth": given.frac_width, "Exact": given.exact}
    kind = given.adder or ("graded" if given.groups else "")
    words = given.top, pathlib.Path(kind).stem, *(f"{name}{value}" for name, value in parameters.items() if value is not None)
    own = "-".join(words) if kind.endswith(".sv") else ""  # a user's file, in place of the prefix adder
    kind = "prefix" if own else kind
    kinds = [*catalogue.adder_kinds(), catalogue.BEHAVIOURAL]
    if kind and kind not in kinds:
        raise ValueError(f"no adder {kind}; there are {', '.join(kinds)}, and files of yours: ADDER=my_adder.sv")
    if given.groups and given.top == "adder":
        if given.width not in (None, sum(given.groups)):
            raise ValueError(f"the groups have {sum(given.groups)} bits together, the adder {given.width}")
        parameters["Width"] = sum(given.groups)
    return catalogue.design(
        given.top, own, adder=kind, widths=given.groups, look_ahead=None if given.look_ahead is None else bool(given.look_ahead),
        **{name: value for name, value in parameters.items() if value is not None})
