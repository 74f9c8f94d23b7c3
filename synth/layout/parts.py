"""Which part of a design each of its cells belongs to, for colours."""

import re

from synth import catalogue
from synth.catalogue import Design
from synth.layout.netlist import Netlist

BAND = 8  # bits of an adder without groups that share a colour, and gates in a row where all else fails

# What the instance's name in a hierarchy says, the first that matches.
NAMED = [
    (r"u_tree\b", "carry-save tree"),
    (r"u_round\b", "rounder"),
    (r"u_unpack", "unpacking"),
    (r"gen_row|u_divide\.(u_first|gen)", "divider rows"),
    (r"u_(right|align)\b", "shifter"),
    (r"u_(adder|far_sum|near_difference|quotient|remainder)\b", "wide adders"),
    (r"u_(exp|near_exp|a_minus_b|b_minus_a|offset|count)", "exponent adders"),
]
REST = "selection, control"
# The same in a multiplier; a group is of the last adder.
MULTIPLIER = [(r"u_tree\b", "carry-save tree"), (r"u_adder\b.*gen_group\[(?P<group>\d+)\]", "group {group}"),
              (r"u_adder\b", "rest of the last adder")]
# The same in a whole unit, whose multiplier and divider have adders of their own.
CORES = [(r"u_multiplier\b", "multiplier"), (r"u_divider\b", "divider"), (r"u_adder\b", "adder")]


def of(design: Design, netlist: Netlist, outputs: dict[str, set[str]]) -> dict[str, str]:
    """The part of each cell, in the order that a legend lists them in.

    Of an adder: the group, or the band of bits, of the highest operand bit that the cell depends on, which
    names the group in any mapping. Otherwise by the cells' names in the hierarchy; where no cell has one, by
    how many gates lie before it.
    """
    if design.top == "adder":
        return _adder(design, netlist, outputs)
    patterns, rest = (CORES, "registers, selection, control") if design.clock else (NAMED, REST)
    if design.top == "booth_multiplier":
        patterns, rest = MULTIPLIER, "Booth rows"

    def part_of(name: str) -> str:
        for pattern, part in patterns:
            if found := re.search(pattern, name):
                return part.format(group=int(found.groupdict().get("group", 0)) + 1)  # from 1, as in an adder
        return rest

    named = {name: part_of(cell.name) for name, cell in netlist.cells.items()}
    if set(named.values()) == {rest}:
        depth = _spread(netlist, outputs, lambda port: 0, 1)
        named = {name: BAND // 2 * (depth[name] // (BAND // 2)) for name in netlist.cells}
        named = {name: f"gates {low + 1} to {low + BAND // 2} of a path" for name, low in
                 sorted(named.items(), key=lambda entry: entry[1])}
        return named
    order = [part for _, part in patterns] + [rest]
    return dict(sorted(named.items(), key=lambda entry: (order.index(re.sub(r"\d+", "{group}", entry[1])),
                                                         len(entry[1]), entry[1])))


def _adder(design: Design, netlist: Netlist, outputs: dict[str, set[str]]) -> dict[str, str]:
    highest = _spread(netlist, outputs, lambda port: int((re.findall(r"\[(\d+)\]", port) or [0])[0]), 0)
    widths = groups(design)
    label, low = [], 0
    for place, width in enumerate(widths):
        label += [f"{'group ' + str(place + 1) + ': ' if len(set(widths)) > 1 or width != BAND else ''}"
                  f"bits {low} to {low + width - 1}"] * width
        low += width
    return {name: label[highest[name]] for name in sorted(netlist.cells, key=lambda name: highest[name])}


def groups(design: Design) -> list[int]:
    """The widths of an adder's groups, least significant first; bands where it has none."""
    parameters = dict(design.parameters)
    if packed := parameters.get("GroupWidths"):
        value = int(packed.split("'h")[1], 16)
        return [value >> 8 * place & 255 for place in range(16) if value >> 8 * place & 255]
    width = int(parameters.get("Width", 48))  # the module's own
    if parameters.get("Arith") == str(catalogue.adder_kinds()["graded"]) and width == 48:
        return [3, 5, 6, 7, 8, 9, 10]  # arith_pkg's
    return [min(BAND, width - low) for low in range(0, width, BAND)]


def _spread(netlist: Netlist, outputs: dict[str, set[str]], first, step: int) -> dict[str, int]:
    """The greatest of what `first` gives of the input ports before a cell, `step` added in each cell."""
    drivers = {net: name for name, cell in netlist.cells.items() for pin, net in cell.pins.items()
               if pin in outputs[cell.kind]}
    at = {name: first(port.name) for name, port in netlist.ports.items() if not port.output}
    inputs = {name: [net for pin, net in cell.pins.items() if pin not in outputs[cell.kind]]
              for name, cell in netlist.cells.items()}
    found: dict[str, int] = {}
    open_cells = list(netlist.cells)
    while open_cells:
        name = open_cells[-1]
        waiting = [drivers[net] for net in inputs[name] if net in drivers and drivers[net] not in found]
        if name in found:
            open_cells.pop()
        elif waiting and not netlist.cells[name].kind.startswith("DFF"):
            open_cells += waiting
        else:
            found[name] = max((found.get(drivers[net], 0) + step if net in drivers else at.get(net, 0)
                               for net in inputs[name]), default=0)
            open_cells.pop()
    return found
