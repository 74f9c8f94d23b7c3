"""Converts wires to resistors and capacitors in SPEF, from magic's extraction and the routed DEF.

magic computes a net's capacitance from the coefficients of its technology file: area, edge and overlap to lower layers, and coupling to
neighbours. Coupling counts once, as if neighbours did not switch. The capacitance is distributed over the net's wires by length.
Resistances follow from LEF's sheet resistances and the technology file's contact resistances.
"""

import dataclasses
import itertools
import pathlib
import re

from synth import tools
from synth.layout.lef import Rect, Technology
from synth.layout.netlist import Netlist
from synth.layout.place import Placement
from synth.layout.route import RAILS, Wire, Wires

# Reads the routed layout, extracts its capacitances to TOP.ext and writes TOP.gds. The cells in TOP.gds have only the pins and obstructions
# of the LEF file.
MAGIC = """drc off
lef read {lef}
def read routed.def -labels
load {top}
select top cell
extract all
gds write {top}.gds
quit -noprompt
"""
Node = tuple[str, float, float]  # layer, x, y
TOUCH = 0.8  # um: the side of a contact's metal. Contacts at most this far apart touch


def extract(netlist: Netlist, lef: pathlib.Path, rc: pathlib.Path, folder: pathlib.Path) -> dict[str, float]:
    """Returns the capacitance of each net, pF. Writes the layout as GDS into `folder`. `rc`: magic's start-up file."""
    (folder / "magic.tcl").write_text(MAGIC.format(lef=lef, top=netlist.top))
    tools.run(["magic", "-dnull", "-noconsole", "-rcfile", rc, "magic.tcl"], folder / "magic.log", folder=folder)
    return capacitances((folder / f"{netlist.top}.ext").read_text(), set(netlist.nets()))


def capacitances(text: str, nets: set[str]) -> dict[str, float]:
    """Returns the capacitance (pF) of each of `nets` in a cell's .ext file. The file states its unit in attofarads.

    Metal that merges with a cell's pin is not counted, because the library's input capacitance includes this metal.
    """
    unit = int(re.search(r"^scale \d+ (\d+)", text, re.M).group(1)) * 1e-6
    found = dict.fromkeys(nets, 0.0)
    for name, farads in re.findall(r'^node "([^"]+)" \S+ (\S+)', text, re.M):
        if name in nets:
            found[name] += float(farads) * unit
    for one, other, farads in re.findall(r'^cap "([^"]+)" "([^"]+)" (\S+)', text, re.M):
        for name in (one, other):
            if name in nets:
                found[name] += float(farads) * unit
    return {name: max(farads, 0.0) for name, farads in found.items()}


def contacts(tech: pathlib.Path, layers: list[str]) -> dict[str, float]:
    """Returns, for each layer but the last, the resistance (ohms) of a contact to the next higher layer, from magic's technology file. If
    the file does not list a contact, it has the resistance of the contact one layer lower."""
    text = tech.read_text()
    found: dict[str, float] = {}
    for place, layer in enumerate(layers[:-1], 2):
        ohms = re.search(rf"^\s*contact\s+m{place}c\s+\d+\s+(\d+)", text, re.M)
        found[layer] = int(ohms.group(1)) / 1000 if ohms else list(found.values())[-1]
    return found


def turned(rect: Rect, cell: tuple[float, float], at: tuple[float, float], how: str) -> Rect:
    """Returns `rect`, a rectangle in a cell, after placement. `cell`: the cell's width, height; `at`: its corner; `how`: N, FN, S or FS."""
    width, height = cell
    left, right = (width - rect.right, width - rect.left) if how in ("FN", "S") else (rect.left, rect.right)
    low, high = (height - rect.top, height - rect.bottom) if how in ("FS", "S") else (rect.bottom, rect.top)
    return Rect(rect.layer, at[0] + left, at[1] + low, at[0] + right, at[1] + high)


@dataclasses.dataclass
class Tree:
    """The resistors (ohms) of one net between its nodes and pins, and the length of wire attributed to each node, um."""

    resistors: list[tuple[Node | str, Node | str, float]]
    length: dict[Node, float]


def tree(wires: list[Wire], taps: dict[str, list[Rect]], technology: Technology,
         ohms: dict[str, float]) -> Tree:
    """Returns the tree of a net. A wire is split where another wire ends on it. `taps`: each pin's metal. `ohms`: returned by `contacts`.

    Raises ToolFailed if the net is in several pieces.
    """
    layers = list(technology.layers)
    points = {(wire.layer, x, y) for wire in wires for x, y in ((wire.x0, wire.y0), (wire.x1, wire.y1))}
    points |= {(wire.to, wire.x0, wire.y0) for wire in wires if wire.to}
    resistors: list[tuple[Node | str, Node | str, float]] = []
    length = dict.fromkeys(sorted(points), 0.0)
    for wire in wires:
        if wire.to:
            below = min(wire.layer, wire.to, key=layers.index)
            resistors.append(((wire.layer, wire.x0, wire.y0), (wire.to, wire.x0, wire.y0), ohms[below]))
            continue
        low, high = sorted([(wire.x0, wire.y0), (wire.x1, wire.y1)])
        on = sorted((x, y) for layer, x, y in points if layer == wire.layer
                    and low[0] <= x <= high[0] and low[1] <= y <= high[1])
        layer = technology.layers[wire.layer]
        for one, other in zip(on, on[1:]):
            far = abs(one[0] - other[0]) + abs(one[1] - other[1])
            ends = ((wire.layer, *one), (wire.layer, *other))
            resistors.append((*ends, layer.ohms * far / layer.width))
            for end in ends:
                length[end] += far / 2
    return Tree(resistors + joints(list(length), taps, resistors), length)


def joints(nodes: list[Node], taps: dict[str, list[Rect]],
           resistors: list[tuple]) -> list[tuple[Node | str, Node | str, float]]:
    """Returns resistors (1 milliohm) that join touching pins and pieces of wire. Pieces may end beside each other, because qrouter moves a
    contact to fit a pin. Wires that arrive at different ends of a pin are joined by the pin's metal."""
    piece: dict[Node | str, Node | str] = {node: node for node in [*nodes, *taps]}

    def root(node: Node | str) -> Node | str:
        while piece[node] != node:
            piece[node] = node = piece[piece[node]]
        return node

    for one, other, _ in resistors:
        piece[root(one)] = root(other)
    touching = [(max(abs(one[1] - other[1]), abs(one[2] - other[2])), one, other)
                for one, other in itertools.combinations(nodes, 2) if one[0] == other[0]]
    touching += [(distance(rects, node), name, node) for name, rects in taps.items() for node in nodes]
    found = []
    for far, one, other in sorted(touching, key=lambda entry: entry[0]):
        if far <= TOUCH and root(one) != root(other):
            piece[root(one)] = root(other)
            found.append((one, other, 0.001))
    pieces = {root(node) for node in piece}
    if len(pieces) > 1:
        raise tools.ToolFailed(f"a net is in {len(pieces)} pieces: {nodes[:1]}, {', '.join(taps)}")
    return found


def distance(rects: list[Rect], node: Node) -> float:
    """Returns the distance from a node to the nearest of `rects` on the node's layer, um; infinity if there is none."""
    layer, x, y = node
    return min((max(rect.left - x, x - rect.right, rect.bottom - y, y - rect.top, 0)
                for rect in rects if rect.layer == layer), default=float("inf"))


def taps(placement: Placement, ends: list[tuple[str, str]]) -> dict[str, list[Rect]]:
    """Returns the metal of a net's pins and ports, by their names in SPEF, in the order of `ends` (an entry of Netlist.nets)."""
    found = {}
    for cell, pin in ends:
        if cell == "PIN":
            x, y, layer = placement.pins[pin]
            found[pin] = [Rect(layer, x, y, x, y)]
            continue
        site, macro = placement.cells[cell], placement.macro(cell)
        found[f"{cell}:{pin}"] = [turned(rect, (macro.width, macro.height), placement.corner(site), site.turned)
                                  for rect in macro.pins[pin]]
    return found


def spef(placement: Placement, wires: Wires, farads: dict[str, float], ohms: dict[str, float],
         outputs: dict[str, set[str]]) -> str:
    """Returns the text of a SPEF file. `farads`: pF of each net. `ohms`: returned by `contacts`. `outputs`: output pins by type of cell."""
    netlist = placement.netlist
    head = {"DATE": "", "VENDOR": "", "PROGRAM": "magic, qrouter", "VERSION": "", "DESIGN_FLOW": ""}
    lines = ['*SPEF "IEEE 1481-1998"', f'*DESIGN "{netlist.top}"',
             *(f'*{name} "{value}"' for name, value in head.items()), "*DIVIDER /", "*DELIMITER :",
             "*BUS_DELIMITER [ ]", "*T_UNIT 1 NS", "*C_UNIT 1 PF", "*R_UNIT 1 OHM", "*L_UNIT 1 HENRY", ""]
    for net, ends in netlist.nets().items():
        if net in RAILS or not wires.get(net):
            continue
        metal = taps(placement, ends)
        body = ["*CONN"]
        for (cell, pin), name in zip(ends, metal, strict=True):
            drives = netlist.ports[pin].output if cell == "PIN" else pin in outputs[netlist.cells[cell].kind]
            body.append(f"*{'P' if cell == 'PIN' else 'I'} {name} {'O' if drives else 'I'}")
        wired = tree(wires[net], metal, placement.technology, ohms)
        names = {node: f"{net}:{place}" for place, node in enumerate(wired.length, 1)}
        total = sum(wired.length.values())
        body.append("*CAP")
        for place, (node, name) in enumerate(names.items(), 1):
            share = wired.length[node] / total if total else 1 / len(names)
            body.append(f"{place} {name} {farads[net] * share:.8f}")
        body.append("*RES")
        body += [f"{place} {names.get(one, one)} {names.get(other, other)} {value:.4f}"
                 for place, (one, other, value) in enumerate(wired.resistors, 1)]
        lines += [f"*D_NET {net} {farads[net]:.8f}", *body, "*END", ""]
    return "\n".join(lines)
