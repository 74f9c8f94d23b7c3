"""One design of hw/, as a command line describes it."""

import argparse
from collections.abc import Callable

from synth import catalogue


def whole(least: int, most: int) -> Callable[[str], str]:
    """The `type` of an option: nothing, or a whole number, as its text."""
    def checked(text: str) -> str:
        try:
            fits = not text or least <= int(text) <= most
        except ValueError:
            fits = False
        if not fits:
            raise argparse.ArgumentTypeError(f"expected a whole number from {least} to {most}, got {text!r}")
        return text
    return checked


def whole_numbers(text: str) -> str:
    """The same of several with commas between."""
    for number in text.split(",") if text else []:
        whole(1, 255)(number or "nothing")
    return text


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The options that `design` reads; an empty value counts as not given, so that a Makefile can pass all."""
    parser.add_argument("--adder", help="ripple, uniform, graded, prefix or behavioural")
    parser.add_argument("--width", type=whole(1, catalogue.MOST_BITS), help="bits of an adder or a multiplier")
    parser.add_argument("--groups", type=whole_numbers, help="carry-select groups, least significant first: 4,5,7,...")
    parser.add_argument("--look-ahead", type=whole(0, 1), help="1: groups add by carry look-ahead, 0: by ripple carry, as those of an adder do if not given")
    parser.add_argument("--exp-width", type=whole(2, 15), help="exponent bits of a float core")
    parser.add_argument("--frac-width", type=whole(2, 112), help="fraction bits of a float core")
    parser.add_argument("--exact", type=whole(0, 64), help="exact_units of the ray core")


def parse(parser: argparse.ArgumentParser) -> argparse.Namespace:
    """The command line, None in place of what is empty. A wrong value is told in one line, without all options."""
    parser.print_usage = lambda *_: None
    given = parser.parse_args()
    for name, value in vars(given).items():
        setattr(given, name, value or None)
    return given


def design(given: argparse.Namespace) -> catalogue.Design:
    """The design that `given.top` and the options describe."""
    parameters = {"Width": given.width, "ExpWidth": given.exp_width, "FracWidth": given.frac_width, "Exact": given.exact}
    widths = [int(width) for width in given.groups.split(",")] if given.groups else None
    kind = given.adder or ("graded" if widths else "")
    kinds = [*catalogue.adder_kinds(), catalogue.BEHAVIOURAL]
    if kind and kind not in kinds:
        raise ValueError(f"no adder {kind}; there are {', '.join(kinds)}")
    if widths and given.width and given.top == "adder" and sum(widths) != int(given.width):
        raise ValueError(f"the groups have {sum(widths)} bits together, the adder {given.width}")
    if widths and not given.width and given.top == "adder":
        parameters["Width"] = sum(widths)
    return catalogue.design(
        given.top, adder=kind, widths=widths,
        look_ahead=bool(int(given.look_ahead)) if given.look_ahead else None,
        **{name: int(value) for name, value in parameters.items() if value})
