"""Draws a layout: cells coloured by the part of the design to which they belong, wires, and the slowest path."""

import graphlib
import pathlib
import re

from matplotlib import collections as shapes
from matplotlib import pyplot as plt

from synth.catalogue import Design
from synth.layout.netlist import Netlist
from synth.layout.place import Placement
from synth.layout.route import Wires

INCHES = 11  # length of the die's longer side in the picture
METALS = {"metal1": "#203040", "metal2": "#303030", "metal3": "#5a5a5a"}  # higher metals: grey
BAND = 8  # number of adjacent bits of an adder with the same colour
REST = "the rest"


def parts_of(design: Design, netlist: Netlist, outputs: dict[str, set[str]]) -> dict[str, str]:
    """Returns the part of each cell, in the order of the legend.

    In an adder, parts are bands of BAND bits; a cell is in the band of the highest operand bit on which it depends. `outputs`: names
    of output pins by kind of cell.
    In other designs, parts are the instances in the top module; cells outside these instances are in part REST.
    """
    if design.top == "adder":
        bits = highest_bits(netlist, outputs)
        return {name: f"bits {bit // BAND * BAND} to {bit // BAND * BAND + BAND - 1}"
                for name, bit in sorted(bits.items(), key=lambda entry: entry[1])}
    named = {name: re.search(r"\bu_(\w+)", cell.name) for name, cell in netlist.cells.items()}
    parts = {name: found[1].replace("_", " ") if found else REST for name, found in named.items()}
    return dict(sorted(parts.items(), key=lambda entry: (entry[1] == REST, entry[1])))


def highest_bits(netlist: Netlist, outputs: dict[str, set[str]]) -> dict[str, int]:
    """Returns, for each cell of a combinational netlist, the highest operand bit on which the cell depends; 0 if none."""
    drivers = {net: name for name, cell in netlist.cells.items() for pin, net in cell.pins.items()
               if pin in outputs[cell.kind]}
    found = {name: int((re.findall(r"\[(\d+)\]", port.name) or [0])[0]) for name, port in netlist.ports.items() if not port.output}
    before = {name: [drivers.get(net, net) for pin, net in cell.pins.items() if pin not in outputs[cell.kind]]
              for name, cell in netlist.cells.items()}
    for name in graphlib.TopologicalSorter(before).static_order():
        if name in before:
            found[name] = max((found.get(one, 0) for one in before[name]), default=0)
    return {name: found[name] for name in netlist.cells}


def draw(placement: Placement, wires: Wires, parts: dict[str, str], path: list[dict], title: str, out: pathlib.Path) -> None:
    """Writes OUT.png. `path`: the steps of the slowest path; if it is empty, no path is drawn."""
    left, bottom, right, top = placement.die
    scale = INCHES / max(right - left, top - bottom)
    figure, axes = plt.subplots(figsize=((right - left) * scale + 2.8, (top - bottom) * scale + 0.6),
                                layout="constrained")
    labels = list(dict.fromkeys(parts.values()))
    colours = dict(zip(labels, _colours(len(labels)), strict=True))
    axes.add_collection(shapes.PolyCollection([_box(placement, name) for name in placement.cells], edgecolors="white", linewidths=0.4,
                                              facecolors=[colours[parts[name]] for name in placement.cells]))
    fine = (right - left) * (top - bottom) / 1e5  # the larger the die, the thinner the lines
    by_layer: dict[str, list] = {}
    for wire in (wire for pieces in wires.values() for wire in pieces):
        by_layer.setdefault(wire.layer, []).append([(wire.x0, wire.y0), (wire.x1, wire.y1)])
    for layer, lines in sorted(by_layer.items()):
        axes.add_collection(shapes.LineCollection(lines, colors=METALS.get(layer, "#808080"),
                                                  linewidths=0.9 / max(1, fine) ** 0.5, alpha=0.45))
    if path:
        _path(axes, placement, wires, path, max(1.2, 3 / max(1, fine) ** 0.25))
    for port, (x, y, _) in placement.pins.items():
        axes.plot(x, y, "s", ms=2, color="black" if placement.netlist.ports[port].output else "grey")
    for label in labels:
        axes.plot([], [], "s", ms=9, color=colours[label], label=label)
    axes.plot([], [], "s", ms=3, color="grey", label="inputs")
    axes.plot([], [], "s", ms=3, color="black", label="outputs")
    axes.set(xlim=(left, right), ylim=(bottom, top), aspect="equal", title=title, xlabel="um")
    axes.legend(loc="center left", bbox_to_anchor=(1, 0.5), frameon=False, fontsize="small")
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    figure.savefig(out.with_name(out.name + ".png"), dpi=120, bbox_inches="tight")
    plt.close(figure)


def _colours(count: int) -> list:
    if count > 10:
        return [plt.get_cmap("turbo")(0.08 + 0.84 * place / (count - 1)) for place in range(count)]
    palette = plt.get_cmap("Set3").colors
    return [palette[place] for place in (3, 0, 5, 4, 2, 6, 7, 9, 10, 8)[:count]]


def _box(placement: Placement, cell: str) -> list[tuple[float, float]]:
    """Returns the corners of a cell."""
    (x, y), macro = placement.corner(placement.cells[cell]), placement.macro(cell)
    return [(x, y), (x + macro.width, y), (x + macro.width, y + macro.height), (x, y + macro.height)]


def _path(axes: plt.Axes, placement: Placement, wires: Wires, path: list[dict], width: float) -> None:
    """Draws the wires of the path's nets, and outlines the path's cells."""
    pins = [(cell, pin) for cell, _, pin in (step["pin"].partition("/") for step in path) if cell in placement.cells]
    nets = dict.fromkeys(placement.netlist.cells[cell].pins[pin] for cell, pin in pins)
    lines = [[(wire.x0, wire.y0), (wire.x1, wire.y1)] for net in nets for wire in wires.get(net, [])]
    axes.add_collection(shapes.PolyCollection([_box(placement, cell) for cell, _ in pins], facecolors="none", edgecolors="black",
                                              linewidths=width / 2, zorder=4))
    axes.add_collection(shapes.LineCollection(lines, colors="crimson", linewidths=width, zorder=5))
    axes.plot([], [], color="crimson", linewidth=2, label="the slowest path")
