"""Writes the micro-programs of hw/exact, hw/exact/exact_program_pkg.sv, from the polynomials whose signs they take.

`python3 -m synth.exact_program` writes the file, with `--check` it says by exit status 1 that the file is another, with
`--clocks` how long requests take at most. An instruction makes a number, or takes the sign of one, out of floats or of numbers made before: a difference of two
floats, or a sum of up to three products. `unsafe` finds where a number is read before it is written: there an
instruction waits (its fence).
"""

import dataclasses
import itertools
import pathlib
import sys

from synth import cores

FILE = cores.HW / "exact" / "exact_program_pkg.sv"

# Places of floats in a request, and of numbers in memory: a vector's x; y and z follow. As in exact_pkg.
FLOATS = {"origin": 0, "direction": 3, "triangle": 6, "other": 15, "limit": 24, "one": 25, "zero": 31}
NUMBERS = {"direction": 0, "a": 3, "b": 6, "c": 9, "normal": 12, "second": 15,
           "distance": 18, "slope": 19, "other_distance": 20, "other_slope": 21}
KINDS = ("coordinate", "ray", "pair", "cross", "plane", "edge", "compare")  # exact_pkg::kind_e
WRITE_DELAY = 5  # clocks from a digit's last product to the first that may read it


@dataclasses.dataclass
class Instruction:
    """The number `result`, or a sign where `decide`: the sum of the terms x y (x - y of floats)."""

    kind: str
    result: int
    terms: list[tuple[int, int]]
    decide: bool = False
    fence: bool = False  # waits until all before it is written
    last: bool = False  # of the program that says whether the ray hits

    def word(self) -> str:
        """Its bits, as exact_pkg::instruction_t has them."""
        places = [place for term in reversed([*self.terms, *[(0, 0)] * (3 - len(self.terms))]) for place in reversed(term)]
        flags = f"{KINDS.index(self.kind):03b}_{self.decide:d}{self.fence:d}{self.last:d}"
        return f"{flags}_{self.result:05b}_" + "_".join(f"{place:05b}" for place in places)


def difference(result: str, minuend: int, subtrahend: int) -> list[Instruction]:
    """Three numbers, floats minus floats."""
    return [Instruction("coordinate", NUMBERS[result] + k, [(minuend + k, subtrahend + k)]) for k in range(3)]


def direction() -> list[Instruction]:
    """The direction as three numbers."""
    return [Instruction("ray", NUMBERS["direction"] + k, [(FLOATS["direction"] + k, FLOATS["zero"])]) for k in range(3)]


def cross(result: str, x: str, y: str) -> list[Instruction]:
    """x cross y: of each component a product minus a product."""
    return [Instruction("cross", NUMBERS[result] + k, [(NUMBERS[x] + (k + 1) % 3, NUMBERS[y] + (k + 2) % 3),
                                                       (NUMBERS[x] + (k + 2) % 3, NUMBERS[y] + (k + 1) % 3)])
            for k in range(3)]


def dot(kind: str, x: str, y: str, result: str = "") -> Instruction:
    """x . y as a number, or its sign where there is no `result`."""
    return Instruction(kind, NUMBERS.get(result, 0), [(NUMBERS[x] + k, NUMBERS[y] + k) for k in range(3)], not result)


def compare() -> Instruction:
    """The sign of t - t' times those of both slopes: of D S' - S D'."""
    return Instruction("compare", 0, [(NUMBERS["distance"], NUMBERS["other_slope"]),
                                      (NUMBERS["slope"], NUMBERS["other_distance"])], True)


def programs() -> dict[str, list[Instruction]]:
    """By name, without fences. Limit and Order are of hits, and follow Hit where that is asked for, too."""
    o, t, u = FLOATS["origin"], FLOATS["triangle"], FLOATS["other"]
    hit = [*difference("b", t + 3, o), *difference("c", t + 6, o), *difference("a", t, o), *direction(),
           *cross("normal", "b", "c"), *cross("second", "c", "a"), dot("plane", "a", "normal"),
           dot("edge", "direction", "normal"), *cross("normal", "a", "b"), dot("edge", "direction", "second"),
           dot("edge", "direction", "normal")]
    hit[-1].last = True
    start = [*difference("a", t, o), *direction()]
    edges = [*difference("b", t + 3, t), *difference("c", t + 6, t)]
    limit = [*edges, *start, Instruction("pair", NUMBERS["other_distance"], [(FLOATS["limit"], FLOATS["zero"])]),
             *cross("normal", "b", "c"),
             Instruction("pair", NUMBERS["other_slope"], [(FLOATS["one"], FLOATS["zero"])]), dot("plane", "a", "normal", "distance"),
             dot("edge", "direction", "normal", "slope"), compare()]
    order = [*edges, *start, *cross("normal", "b", "c"), *difference("b", u + 3, u), *difference("c", u + 6, u),
             dot("plane", "a", "normal", "distance"), *cross("second", "b", "c"), *difference("a", u, o),
             dot("edge", "direction", "normal", "slope"), dot("plane", "a", "second", "other_distance"),
             dot("edge", "direction", "second", "other_slope"), compare()]
    return {"Hit": hit, "Limit": limit, "Order": order}


# What a request runs: one program, or two.
RUNS = {"Hit": ("Hit",), "Limit": ("Limit",), "HitLimit": ("Hit", "Limit"), "Order": ("Order",), "HitOrder": ("Hit", "Order")}


@dataclasses.dataclass(frozen=True)
class Lengths:
    """Digits of a request's numbers: differences, the direction, limit and one (see exact_exponents)."""

    coordinate: int
    ray: int
    pair: int

    @property
    def fraction(self) -> int:
        """Of a distance or a slope."""
        return 2 * self.coordinate + max(self.coordinate, self.ray)

    def of(self, instruction: Instruction, other: int) -> tuple[int, int, int]:
        """Digits of x, of y, of the result; `other`: of what a hit is compared with."""
        n, kind = 2 * self.coordinate, instruction.kind
        if kind in ("coordinate", "ray", "pair"):
            return getattr(self, kind), 1, getattr(self, kind)
        return {"cross": (self.coordinate, self.coordinate, n), "plane": (self.coordinate, n, self.fraction),
                "edge": (self.ray, n, self.fraction), "compare": (self.fraction, other, 0)}[kind]


def steps(x: int, y: int, terms: int, digits: int, down: bool) -> list[tuple[int, list[tuple[int, int, int]]]]:
    """By column, in order: its number, and its products, x's digit, y's digit and the term."""
    columns = range(x + y - 2, -1, -1) if down else range(digits)
    return [(k, [(i, k - i, t) for i in range(max(0, k - y + 1), min(x - 1, k) + 1) for t in range(terms)])
            for k in columns]


def unsafe(program: list[Instruction], lengths: Lengths, other: int, hasty: bool) -> int | None:
    """The first instruction that reads a digit which is not written yet; `hasty`: signs are sure at once."""
    clock, written = 0, {}
    for number, one in enumerate(program):
        if one.fence:
            clock = max([clock, *written.values()])
        columns = steps(*lengths.of(one, other)[:2], len(one.terms), lengths.of(one, other)[2], one.decide)
        first = clock
        for place, (k, products) in enumerate(columns):
            for i, j, t in products:
                x, y = one.terms[t]
                read = () if one.kind in ("coordinate", "ray", "pair") else ((x, i), (y, j))
                if any(written.get(digit, 0) > clock for digit in read):
                    return number
                clock += 1
            clock += not products
            if not one.decide:
                written[one.result, k] = clock - 1 + WRITE_DELAY
            elif hasty and place == 0:
                first = clock + WRITE_DELAY - 1
        if one.decide and hasty:
            clock = min(clock, first)
    return None


def fenced() -> dict[str, list[Instruction]]:
    """The programs with the fences that they need, whatever the lengths."""
    made = programs()
    for names in RUNS.values():
        whole = [one for name in names for one in made[name]]
        for n, ray, pair, hasty in itertools.product((1, 2, 3, 6), (1, 2, 6), (1, 2, 9), (False, True)):
            lengths = Lengths(n, ray, pair)
            while (place := unsafe(whole, lengths, pair if "Limit" in names else lengths.fraction, hasty)) is not None:
                whole[place].fence = True
    return made


def clocks(run: str, lengths: Lengths, first: int = 5, seen: int = WRITE_DELAY - 1) -> int:
    """From a request to its answer, where each sign is sure in its last column alone. `first`: to the first step; `seen`: from a
    step to its sum."""
    made = fenced()
    total = first + seen
    for one in (one for name in RUNS[run] for one in made[name]):
        x, y, digits = lengths.of(one, lengths.pair if "Limit" in run else lengths.fraction)
        total += seen * one.fence + sum(max(len(products), 1) for _, products in steps(x, y, len(one.terms), digits, one.decide))
    return total


def table() -> str:
    """Clocks at most, by digits: for hw/exact's page."""
    rows = {"does it hit": "Hit", "t against a limit, of a hit": "Limit", "t against another hit's": "Order",
            "does it hit, and then t against another's": "HitOrder"}
    lengths = [Lengths(n, n, pair) for n, pair in ((1, 1), (2, 2), (6, 9))]
    return "".join(f"| {what} | {' | '.join(f'{clocks(run, one):,}' for one in lengths)} |\n" for what, run in rows.items())


def text() -> str:
    """The package."""
    lines, starts = [], {}
    for name, program in fenced().items():
        starts[name] = len(lines)
        lines += [one.word() for one in program]
    entries = "\n".join(f"  localparam logic [6:0] {name} = 7'd{start};" for name, start in starts.items())
    words = "\n".join(f"      7'd{place}: instruction = 41'b{word};" for place, word in enumerate(lines))
    return f"""// Micro-programs of the exact unit, as exact_pkg::instruction_t. Written by synth/exact_program.py, which says what they do.
package exact_program_pkg;

  // verilator lint_off UNUSEDPARAM
  // No top enters everywhere.
{entries}
  // verilator lint_on UNUSEDPARAM

  function automatic logic [40:0] instruction(logic [6:0] address);
    case (address)
{words}
      default: instruction = '0;
    endcase
  endfunction

endpackage
"""


def main() -> int:
    """Runs the command line."""
    if sys.argv[1:] not in ([], ["--check"], ["--clocks"]):
        print(f"found {' '.join(sys.argv[1:])}, expected --check, --clocks or nothing", file=sys.stderr)
        return 2
    if sys.argv[1:] == ["--clocks"]:
        print(table(), end="")
        return 0
    file = pathlib.Path(FILE)
    if sys.argv[1:]:
        return int(file.read_text() != text())
    file.write_text(text())
    return 0


if __name__ == "__main__":
    sys.exit(main())
