"""The cells that are characterised, and the corners: the table to edit."""

import dataclasses
import itertools
import re

from synth.cells import package

PREFIX = "sky130_fd_sc_hd__"


@dataclasses.dataclass(frozen=True)
class Corner:
    """Speed of the transistors (n and p alike), supply and temperature."""

    name: str
    process: str  # of SkyWater's models: tt, ss, ff
    volts: float
    celsius: int


CORNERS = [Corner("tt", "tt", 1.80, 25), Corner("ss", "ss", 1.60, 100), Corner("ff", "ff", 1.95, -40)]


@dataclasses.dataclass(frozen=True)
class Flop:
    """A rising-edge flip-flop: its pins besides CLK, D and Q."""

    clear: str = ""  # a pin that, low, makes Q 0
    preset: str = ""  # ... 1


@dataclasses.dataclass(frozen=True)
class Cell:
    """A cell: its name without the library's, e.g. "nand2_1", and what its outputs are of its inputs, by Verilog's
    operators; or its flip-flop."""

    name: str
    functions: tuple[tuple[str, str], ...] = ()
    flop: Flop | None = None

    @property
    def drive(self) -> int:
        """How many times the least drive."""
        return int(self.name.rpartition("_")[2])

    @property
    def area(self) -> float:
        """Of its outline, um2."""
        width, height = re.search(r"SIZE +(\S+) BY +(\S+) ;", package.cell(self.name, "lef").read_text()).groups()
        return float(width) * float(height)


# Kind: drives, outputs.
COMBINATIONAL = {
    "inv": ((1, 2, 4, 8), {"Y": "!A"}),
    "buf": ((1, 2, 4, 8), {"X": "A"}),
    "clkbuf": ((4, 16), {"X": "A"}),
    "nand2": ((1, 2, 4), {"Y": "!(A&B)"}),
    "nor2": ((1, 2, 4), {"Y": "!(A|B)"}),
    "nand3": ((1, 2), {"Y": "!(A&B&C)"}),
    "nor3": ((1, 2), {"Y": "!(A|B|C)"}),
    "nand4": ((1,), {"Y": "!(A&B&C&D)"}),
    "nor4": ((1,), {"Y": "!(A|B|C|D)"}),
    "and2": ((1, 2, 4), {"X": "A&B"}),
    "or2": ((1, 2, 4), {"X": "A|B"}),
    "and3": ((1,), {"X": "A&B&C"}),
    "or3": ((1,), {"X": "A|B|C"}),
    "a21oi": ((1, 2, 4), {"Y": "!(A1&A2|B1)"}),
    "o21ai": ((1, 2, 4), {"Y": "!((A1|A2)&B1)"}),
    "a22oi": ((1, 2), {"Y": "!(A1&A2|B1&B2)"}),
    "o22ai": ((1, 2), {"Y": "!((A1|A2)&(B1|B2))"}),
    "a31oi": ((1,), {"Y": "!(A1&A2&A3|B1)"}),
    "o31ai": ((1,), {"Y": "!((A1|A2|A3)&B1)"}),
    "a211oi": ((1,), {"Y": "!(A1&A2|B1|C1)"}),
    "o211ai": ((1,), {"Y": "!((A1|A2)&B1&C1)"}),
    "a21o": ((1, 2), {"X": "A1&A2|B1"}),
    "o21a": ((1, 2), {"X": "(A1|A2)&B1"}),
    "xor2": ((1, 2), {"X": "A^B"}),
    "xnor2": ((1, 2), {"Y": "!(A^B)"}),
    "mux2": ((1, 2), {"X": "!S&A0|S&A1"}),
    "fa": ((1,), {"COUT": "A&B|A&CIN|B&CIN", "SUM": "A^B^CIN"}),
    "ha": ((1,), {"COUT": "A&B", "SUM": "A^B"}),
}

CELLS = [Cell(f"{kind}_{drive}", tuple(functions.items()))
         for kind, (drives, functions) in COMBINATIONAL.items() for drive in drives]
CELLS += [Cell("dfxtp_1", flop=Flop()), Cell("dfrtp_1", flop=Flop(clear="RESET_B")),
          Cell("dfstp_1", flop=Flop(preset="SET_B"))]


def value(function: str, state: dict[str, bool]) -> bool:
    """A function of `functions` at the inputs `state`."""
    text = re.sub(r"[A-Z]\w*", lambda name: str(int(state[name[0]])), function)
    return bool(eval(text.replace("!", "~")) & 1)  # noqa: S307  the table's own text, digits and operators alone


def inputs(function: str) -> list[str]:
    """The pins that a function names."""
    return sorted(set(re.findall(r"[A-Z]\w*", function)))


@dataclasses.dataclass(frozen=True)
class Arc:
    """An output that follows an input (or its opposite) while the other inputs are held."""

    output: str
    input: str
    inverts: bool
    held: tuple[tuple[str, bool], ...]


def arcs(cell: Cell) -> list[Arc]:
    """All arcs of a combinational cell, with every state of the other inputs that makes the output follow."""
    pins = sorted({pin for _, function in cell.functions for pin in inputs(function)})
    found = []
    for output, function in cell.functions:
        for pin in inputs(function):
            others = [other for other in pins if other != pin]
            for values in itertools.product((False, True), repeat=len(others)):
                held = dict(zip(others, values, strict=True))
                low, high = (value(function, {**held, pin: one}) for one in (False, True))
                if low != high:
                    found.append(Arc(output, pin, low, tuple(held.items())))
    return found
