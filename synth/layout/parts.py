"""Which part of a design each of its cells belongs to, for colours."""

import re

from synth.catalogue import Design
from synth.layout.netlist import Netlist

BAND = 8  # bits of an adder that share a colour
REST = "the rest"


def of(design: Design, netlist: Netlist, outputs: dict[str, set[str]]) -> dict[str, str]:
    """The part of each cell, in the order of the legend.

    Of an adder the band of the highest operand bit that the cell depends on, which holds in any mapping; else the instance in
    the top that the cell's name begins with, where it has one.
    """
    if design.top == "adder":
        bits = highest_bits(netlist, outputs)
        return {name: f"bits {bit // BAND * BAND} to {bit // BAND * BAND + BAND - 1}"
                for name, bit in sorted(bits.items(), key=lambda entry: entry[1])}
    named = {name: re.search(r"\bu_(\w+)", cell.name) for name, cell in netlist.cells.items()}
    parts = {name: found[1].replace("_", " ") if found else REST for name, found in named.items()}
    return dict(sorted(parts.items(), key=lambda entry: (entry[1] == REST, entry[1])))


def highest_bits(netlist: Netlist, outputs: dict[str, set[str]]) -> dict[str, int]:
    """The highest bit of an operand that each cell of a combinational netlist depends on; 0 of none."""
    drivers = {net: name for name, cell in netlist.cells.items() for pin, net in cell.pins.items()
               if pin in outputs[cell.kind]}
    at = {name: int((re.findall(r"\[(\d+)\]", port.name) or [0])[0]) for name, port in netlist.ports.items() if not port.output}
    inputs = {name: [net for pin, net in cell.pins.items() if pin not in outputs[cell.kind]]
              for name, cell in netlist.cells.items()}
    found: dict[str, int] = {}
    open_cells = list(netlist.cells)
    while open_cells:
        name = open_cells[-1]
        waiting = [drivers[net] for net in inputs[name] if net in drivers and drivers[net] not in found]
        if waiting and name not in found:
            open_cells += waiting
            continue
        found[name] = max((found[drivers[net]] if net in drivers else at.get(net, 0) for net in inputs[name]), default=0)
        open_cells.pop()
    return found
