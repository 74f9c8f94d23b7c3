"""Makes a page for a lecture that shows each kind of adder, a Booth multiplication and a float addition with chosen operands.

`python3 -m synth.lecture`: see `--help`. The adders are drawn from their elaborated netlists. All signal values on the page are computed
from the netlists (structure.evaluate).
"""

import argparse
import collections
import html
import itertools
import pathlib
import string
import struct
import sys

from synth import catalogue, chosen, store, structure, tools
from synth.structure import evaluate, word

MOST_BITS = 16  # wider adders do not fit on a page

# Delays of cells, and of a gate, in full-adder delays. A gate counts 0.5, because a full adder's sum is two gates deep.
DELAYS = {"FULL_ADDER": 1.0, "MULTIPLEXER": 1.0}
GATE = 0.5
SYMBOLS = {"FULL_ADDER": "FA", "MULTIPLEXER": "mux", "$_AND_": "and", "$_OR_": "or", "$_XOR_": "xor", "$_NOT_": "not"}
CELL, SLOT, ROW, MARGIN = 30, 36, 62, 40  # pixels

KINDS = {
    "ripple": "Ripple carry: the carry goes through every full adder.",
    "uniform": "Carry select, groups of one width: each group adds for both carries at once, and the carry below chooses.",
    "graded": "Carry select, graded groups: a group is as wide as the time that its carry takes to come (the paper, 3.4).",
    "prefix": "Parallel prefix (Sklansky): generate and propagate of ever more bits, joined in a tree.",
}


class AdderDrawing:
    """Positions of an adder's cells on the page. Column: the highest operand bit that a cell depends on. Row: arrival time."""

    def __init__(self, module: dict) -> None:
        self.module = module
        self.top = {bit: place for port in ("a_i", "b_i") for place, bit in enumerate(module["ports"][port]["bits"])}
        self.arrival, self.slowest = structure.arrivals(module, DELAYS, GATE)
        self.cells = list(structure.in_order(module))
        slots = collections.Counter()
        self.at = []  # per cell: column, arrival time, index among the cells with the same column and time
        for cell in self.cells:
            outs = structure.outputs(cell)
            column, arrival = max(self.top.get(bit, 0) for bit in structure.inputs(cell)), self.arrival[outs[0]]
            self.top |= dict.fromkeys(outs, column)
            self.at.append((column, arrival, slots[column, arrival]))
            slots[column, arrival] += 1
        self.rows = {arrival: row for row, arrival in enumerate(sorted({arrival for _, arrival, _ in self.at}))}
        width = len(module["ports"]["a_i"]["bits"])
        most = [max([count for (column, _), count in slots.items() if column == place], default=1) for place in range(width)]
        self.left = {place: MARGIN + sum(SLOT * count + 12 for count in most[place + 1:]) for place in range(width)}
        self.width = 2 * MARGIN + sum(SLOT * count + 12 for count in most)
        self.middle = {place: self.left[place] + SLOT * most[place] // 2 for place in range(width)}

    def on_slowest_path(self) -> set[int]:
        """Returns the id() of each cell on one of the longest paths."""
        outputs = [bit for port in ("sum_o", "carry_o") for bit in self.module["ports"][port]["bits"]]
        bit, found = max(outputs, key=lambda bit: self.arrival.get(bit, 0.0)), set()
        while bit in self.slowest:
            cell = self.slowest[bit]
            found.add(id(cell))
            bit = max(structure.inputs(cell), key=lambda bit: self.arrival.get(bit, 0.0))
        return found

    def svg(self, values: dict[object, int]) -> str:
        """Returns the drawing as SVG. `values`: the values to show on the wires, from evaluate()."""
        ports = self.module["ports"]
        below = MARGIN + 44 + ROW * len(self.rows)
        places = {}  # bit -> where its wire begins
        parts, wires = [], []
        for name, y in (("a_i", MARGIN - 14), ("b_i", MARGIN + 6)):
            parts.append(text(12, y, name[0], "name"))
            for place, bit in enumerate(ports[name]["bits"]):
                places[bit] = (self.middle[place] + (-6 if name == "a_i" else 6), MARGIN + 10)
                parts.append(text(self.middle[place], y, str(values[bit]), f"v{values[bit]}"))
        (carry,) = ports["carry_i"]["bits"]
        places[carry] = (self.width - 14, MARGIN + 10)
        parts.append(text(self.width - 14, MARGIN + 6, str(values[carry]), f"v{values[carry]}"))
        slow = self.on_slowest_path()
        for cell, (column, arrival, slot) in zip(self.cells, self.at, strict=True):
            x = self.left[column] + SLOT * slot + SLOT // 2
            y = MARGIN + 40 + ROW * self.rows[arrival]
            ins, outs = structure.inputs(cell), structure.outputs(cell)
            for place, bit in enumerate(ins):
                pin = x + 7 * (2 * place - len(ins) + 1) // 2
                if bit in places:
                    wires.append(wire(places[bit], (pin, y), values[bit]))
                else:
                    parts.append(text(pin, y - 3, bit, "kind"))
            places |= {bit: (x + 8 * (2 * place - len(outs) + 1) // 2, y + CELL) for place, bit in enumerate(outs)}
            bold = " slow" if id(cell) in slow else ""
            parts.append(f'<rect class="cell{bold}" x="{x - CELL // 2}" y="{y}" width="{CELL}" height="{CELL}" rx="4"/>')
            parts.append(text(x, y + 12, SYMBOLS.get(cell["type"], cell["type"]), "kind"))
            found = structure.pins(cell, "output")
            order = [bit for port in ("CARRY", "SUM") if port in found for bit in found[port]] or outs
            parts.append(text(x, y + 25, " ".join(str(values[bit]) for bit in order), "value"))
        for place, bit in [*enumerate(ports["sum_o"]["bits"]), (-1, ports["carry_o"]["bits"][0])]:
            x = self.middle[place] if place >= 0 else 14
            wires.append(wire(places[bit], (x, below), values[bit]))
            parts.append(text(x, below + 16, str(values[bit]), f"v{values[bit]}"))
        return (f'<svg viewBox="0 0 {self.width} {below + 28}" style="max-width:{self.width}px" role="img">'
                + "".join(wires) + "".join(parts) + "</svg>")


def text(x: float, y: float, words: str, kind: str) -> str:
    """Returns an SVG text, centred at x. `kind`: its class."""
    return f'<text class="{kind}" x="{x}" y="{y}">{html.escape(words)}</text>'


def wire(begin: tuple[float, float], end: tuple[float, float], value: int) -> str:
    """Returns an SVG curve that begins and ends vertically."""
    (x0, y0), (x1, y1) = begin, end
    bend = min(24.0, (y1 - y0) / 2)
    return f'<path class="w{value}" d="M{x0} {y0}C{x0} {y0 + bend} {x1} {y1 - bend} {x1} {y1}"/>'


def binary(number: int, width: int, marked: range = range(0)) -> str:
    """Returns a binary number as HTML, grouped by four bits from the lowest. The bits at the positions `marked` are in <b>."""
    bits = [f"<b>{number >> place & 1}</b>" if place in marked else f"{number >> place & 1}" for place in range(width)]
    groups = ["".join(reversed(bits[k:k + 4])) for k in range(0, width, 4)]
    return "\u2009".join(reversed(groups)).replace("</b><b>", "")


def table(header: list[str], rows: list[list[str]]) -> str:
    """Returns an HTML table. `header` and `rows` must be HTML."""
    line = lambda tag, cells: "<tr>" + "".join(f"<{tag}>{cell}</{tag}>" for cell in cells) + "</tr>"  # noqa: E731
    return "<table>" + line("th", header) + "".join(line("td", row) for row in rows) + "</table>"


def adder_section(kind: str, given: argparse.Namespace) -> str:
    """Returns the section of one kind of adder, drawn with the values of the operands."""
    design = catalogue.design("adder", adder=kind, widths=given.groups if kind == "graded" else None, Width=given.width,
                              look_ahead=None if kind in ("ripple", "prefix") else False)
    module = structure.without_constants(structure.netlist(design))
    values = evaluate(module, {"a_i": given.a, "b_i": given.b, "carry_i": given.carry})
    drawing = AdderDrawing(module)
    outputs = module["ports"]["sum_o"]["bits"] + module["ports"]["carry_o"]["bits"]
    select = module["names"].get("gen_select.u_adder.select", [])  # the bits of a group have the same select line
    widths = ", ".join(str(len([*group])) for _, group in itertools.groupby(select))
    cells = collections.Counter(SYMBOLS.get(cell["type"], cell["type"]) for cell in drawing.cells)
    slowest = max(drawing.arrival.get(bit, 0.0) for bit in outputs)
    title = "Carry select, your groups." if kind == "graded" and given.groups else KINDS[kind]
    return (f"<section><h3>{html.escape(title)}</h3><p>{given.a} + {given.b} + {given.carry} = <b>{word(outputs, values)}</b>. "
            f"{f'Group widths, lowest first: {widths}. ' if widths else ''}Slowest path (bold): {slowest:g} full-adder delays. Cells: "
            f"{', '.join(f'{count} {name}' for name, count in sorted(cells.items()))}.</p>{drawing.svg(values)}</section>")


def booth_section(given: argparse.Namespace) -> str:
    """Returns the section of the multiplication: digits, partial products, rows of the carry-save tree, final addition."""
    width = given.width + given.width % 2
    module = structure.netlist(catalogue.design("booth_multiplier", Width=width))
    values = evaluate(module, {"a_i": given.a, "b_i": given.b})
    number = lambda name: word(module["names"][name], values)  # noqa: E731
    digits = width // 2 + 1
    one, two, negative = (number(name) for name in ("one", "two", "negative"))
    queue = number("u_tree.queue")
    count = len(module["names"]["u_tree.queue"]) // (2 * width)
    words = [queue >> 2 * width * k & (1 << 2 * width) - 1 for k in range(count)]
    product = word(module["ports"]["product_o"]["bits"], values)
    bits = lambda number: f"<code>{binary(number, 2 * width)}</code>"  # noqa: E731
    multiples, rows = [], []
    for k in range(digits):
        size, sign = (one >> 2 * k & 1) + 2 * (two >> 2 * k & 1), "-" * (negative >> 2 * k & 1)
        multiple = number(f"gen_row[{k}].row")
        multiples.append([str(k), f"{sign}{size}", f"{sign}{size * given.a} x 4<sup>{k}</sup>", f"<code>{binary(multiple, width + 1)}</code>"])
        marked = binary(words[k], 2 * width, range(2 * k, 2 * k + width + 1))
        rows.append([f"row {k}", f"<code>{marked}</code>", str(words[k])])
    above, total = divmod(sum(words[:digits]), 1 << 2 * width)
    rows.append(["sum", bits(total), f"{total} + {above} x 2<sup>{2 * width}</sup>"])
    names = [*(f"row {k}" for k in range(digits)), *(f"{what} {k}" for k in range((count - digits) // 2) for what in ("sum", "carry"))]
    steps = [[str(k) if place == 3 * k else "", names[place], bits(words[place]), str(words[place])]
             for k in range((count - digits) // 2) for place in (*range(3 * k, 3 * k + 3), *range(digits + 2 * k, digits + 2 * k + 2))]
    steps += [["last" if place == count - 2 else "", names[place], bits(words[place]), str(words[place])] for place in (count - 2, count - 1)]
    steps.append(["", "product", bits(product), f"<b>{product}</b>"])
    return (f"<section><h2>Booth multiplier, {width} x {width} bits</h2><p>{given.a} x {given.b} = <b>{product}</b>: "
            f"the digits of {given.b} in radix 4 are -2 to 2, and each makes one partial product of {given.a}. A negative one is given "
            f"as the complement of its bits: 1 too little, and without its sign, which is -2<sup>{width + 1}</sup>.</p>"
            + table(["digit", "value", "stands for", "partial product"], multiples)
            + f"<p>The rows that are added hold the partial products in their places (marked) and, in free places around them, what "
              f"those lack. Below the last one stands a 1 for each negative digit k, of weight 4<sup>k</sup>. Call n the sum of these ones. "
              f"The signs together are -n x 2<sup>{width + 1}</sup>, which modulo 2<sup>{2 * width}</sup> is 2<sup>{width + 1}</sup> plus the "
              f"complement of n times 2<sup>{width + 1}</sup>: those bits stand above row 0, and one of them above row 1. So the rows "
              f"add up to the product, modulo 2<sup>{2 * width}</sup>:</p>"
            + table(["", "bits", "number"], rows)
            + "<p>Carry-save tree: each adder makes two rows of three, without passing a carry on. The last adder passes carries on.</p>"
            + table(["adder", "", "bits", "number"], steps) + "</section>")


def float_section(given: argparse.Namespace) -> str:
    """Returns the section of the sum of two binary16 numbers, step by step."""
    design = catalogue.design("fp_adder", ExpWidth=5, FracWidth=10)
    module = structure.netlist(design)
    packed = [struct.unpack("<H", struct.pack("<e", number))[0] for number in (given.x, given.y)]
    values = evaluate(module, {"a_i": packed[0], "b_i": packed[1], "subtract_i": 0, "rounding_mode_i": 0, "tininess_after_i": 0})
    names = module["names"]

    def row(step: str, name: str, meaning: str) -> list[str]:
        bits = names[name]
        return [step, f"<code>{name}</code>", f"<code>{binary(word(bits, values), len(bits))}</code>", str(word(bits, values)), meaning]

    near = values[names["near"][0]]
    way = ([row("near path", "near_difference", "difference of neighbours, exact"), row("", "near_count", "zeros before the leading one"),
            row("", "near_normal", "shifted left by as many places")] if near else
           [row("far path", "far_aligned", "the smaller one, shifted right by the distance"),
            row("", "far_sticky", "1 where a bit was lost on the way"),
            row("", "far_sum", "the difference: one integer bit, ten fraction bits, two guard bits" if values[names["subtract"][0]]
                else "the sum: two integer bits, ten fraction bits, one guard bit"),
            row("round", "u_round.increment", "1 where the result is rounded up")])
    result = word(module["ports"]["result_o"]["bits"], values)
    fields = "\u2009".join((f"{result >> 15}", f"{result >> 10 & 31:05b}", f"{result & 1023:010b}"))
    (shown,) = struct.unpack("<e", struct.pack("<H", result))
    operands = [struct.unpack("<e", struct.pack("<H", bits))[0] for bits in packed]
    rows = [row("unpack", "a_exp", "exponent of the first, biased by 15"), row("", "a_sig", "its significand with the leading one"),
            row("", "b_exp", "of the second"), row("", "b_sig", ""), row("order", "swap", "1 where the second is the larger one"),
            row("", "distance", "between the exponents"), *way,
            ["result", "<code>result_o</code>", f"<code>{fields}</code>", str(result), f"sign, exponent, fraction: <b>{shown!r}</b>"]]
    return (f"<section><h2>Float adder, binary16</h2><p>{operands[0]!r} + {operands[1]!r} = <b>{shown!r}</b>, rounded to the nearest; "
            f"words <code>{packed[0]:04x}</code>, <code>{packed[1]:04x}</code> and <code>{result:04x}</code>.</p>"
            + table(["step", "word", "bits", "number", "what it is"], rows) + "</section>")


PAGE = string.Template("""<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>Adders with $a and $b in them</title><style>
:root { color-scheme: light dark; --ink: #222; --paper: #fff; --faint: #adb5bd; --one: #d9480f; }
@media (prefers-color-scheme: dark) { :root { --ink: #e9ecef; --paper: #16181c; --faint: #5c636a; --one: #ff922b; } }
body { font: 16px/1.5 system-ui, sans-serif; color: var(--ink); background: var(--paper); max-width: 1100px; margin: 2em auto; padding: 0 1em; }
svg { width: 100%; height: auto; display: block; } section { break-inside: avoid; margin-bottom: 2.5em; overflow-x: auto; }
text { font: 11px system-ui, sans-serif; text-anchor: middle; fill: var(--ink); } text.kind { font-size: 9px; fill: var(--faint); }
text.v1, text.v0, text.name { font-size: 15px; } text.v1 { font-weight: 700; fill: var(--one); }
rect.cell { fill: var(--paper); stroke: var(--faint); } rect.slow { stroke: var(--ink); stroke-width: 2.5; }
path { fill: none; stroke-width: 1.2; } path.w0 { stroke: var(--faint); } path.w1 { stroke: var(--one); stroke-width: 1.8; }
table { border-collapse: collapse; font-size: 14px; } code b { background: color-mix(in srgb, var(--one) 25%, transparent); font-weight: inherit; } td, th { padding: 2px 12px 2px 0; text-align: left; white-space: nowrap; }
@media print { body { max-width: none; margin: 0; } }
</style></head><body><h1>What happens in an adder</h1>
<p>a = $a = <code>$a_bits</code>, b = $b = <code>$b_bits</code>. Drawn from the netlists of <code>hw/arith</code> and <code>hw/fp</code>: time runs
downwards, the highest bit is on the left, a wire that carries a 1 has a colour. A full adder (FA; its carry and its sum are
written into it) and a multiplexer count one full-adder delay each, a gate half of one.</p>
$sections
</body></html>
""")


def page(given: argparse.Namespace) -> str:
    """Returns the page as HTML that needs no other file."""
    sections = [adder_section(kind, given) for kind in KINDS] + [booth_section(given), float_section(given)]
    return PAGE.substitute(a=given.a, b=given.b, a_bits=binary(given.a, given.width), b_bits=binary(given.b, given.width),
                           sections="\n".join(sections))


def binary16(text: str) -> float:
    """Parses an option's value: a number in the range of binary16."""
    try:
        struct.pack("<e", float(text))
    except (OverflowError, ValueError):
        raise argparse.ArgumentTypeError(f"expected a number from -65504 to 65504, got {text!r}") from None
    return float(text)


@tools.command("synth.lecture")
def main() -> int:
    """Runs the command line."""
    parser = argparse.ArgumentParser(prog="synth.lecture", description="Draws adders with operands in them, as a page.")
    parser.add_argument("--width", type=chosen.whole(2, MOST_BITS), default=16, help="bits of the adders (%(default)s)")
    parser.add_argument("--groups", type=chosen.whole_numbers, help="the graded adder's groups, lowest first")
    for name, number in (("--a", 1365), ("--b", 2731)):
        parser.add_argument(name, type=chosen.whole(0, 2**MOST_BITS - 1), help=f"an operand (the lowest WIDTH bits of {number})")
    parser.add_argument("--carry", type=chosen.whole(0, 1), default=0, help="the carry into bit 0 (%(default)s)")
    parser.add_argument("--x", type=binary16, default=1.5, help="a number for the float adder (%(default)s)")
    parser.add_argument("--y", type=binary16, default=-0.3, help="the other (%(default)s)")
    given = chosen.parse(parser)
    given.a, given.b = (number % 2**given.width if typed is None else typed for typed, number in ((given.a, 1365), (given.b, 2731)))
    if max(given.a, given.b) >> given.width:
        raise ValueError(f"found operands {given.a} and {given.b}, expected numbers of {given.width} bits")
    if given.groups and sum(given.groups) != given.width:
        raise ValueError(f"found groups {given.groups}, expected {given.width} bits together")
    out = store.OUT / "lecture.html"
    store.replace(out, page(given))
    print(f"The page: {out.relative_to(pathlib.Path.cwd()) if out.is_relative_to(pathlib.Path.cwd()) else out}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
