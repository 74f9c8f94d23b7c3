"""Places a netlist in rows with graywolf, which anneals: the seed decides."""

import dataclasses
import pathlib
import re

from synth import tools
from synth.layout.lef import Technology
from synth.layout.netlist import CONSTANTS, Netlist

UNITS = 100  # to the um, as qflow's parameters for graywolf count
ORIENTATIONS = ("N", "FS", "FN", "S", "FE", "FW", "W", "E")  # graywolf's numbers


@dataclasses.dataclass(frozen=True)
class Site:
    """Where a cell is: its lower left corner, um, and how it is turned (N, FN, S or FS)."""

    x: float
    y: float
    turned: str


@dataclasses.dataclass(frozen=True)
class Placement:
    """Cells and ports by their names; the core's width and height, um. Ports lie around the core."""

    cells: dict[str, Site]
    ports: dict[str, tuple[float, float]]
    width: float
    height: float


def place(netlist: Netlist, technology: Technology, parameters: pathlib.Path, seed: int,
          density: float, aspect: float, folder: pathlib.Path) -> Placement:
    """`density`: the share of the rows that cells take; `aspect`: the core's height by its width;
    `parameters`: qflow's .par of the library."""
    (folder / "placed.cel").write_text(cells_text(netlist, technology, density))
    text = re.sub(r"(\*random\.seed\s*:\s*)\d+", rf"\g<1>{seed}", parameters.read_text())
    text = re.sub(r"(chip\.aspect\.ratio\s*:\s*)[\d.]+", rf"\g<1>{aspect}", text)
    (folder / "placed.par").write_text(text)
    tools.run(["graywolf", "-n", "placed"], folder / "graywolf.log", folder=folder)
    return read((folder / "placed.pl1").read_text(), technology, netlist)


def gaps(netlist: Netlist, technology: Technology, density: float, pitch: float) -> dict[str, float]:
    """The room to leave beside each cell, um, whole pitches: the more, the more pins it has for its width.

    Wires crowd where pins do. Every cell gets what it lacks of a width that is the same for each of its pins.
    """
    widths = {name: technology.macros[cell.kind].width for name, cell in netlist.cells.items()}
    room = sum(widths.values()) * (1 / density - 1)
    low, high = 0.0, sum(widths.values()) / density  # um a pin
    for _ in range(60):
        middle = (low + high) / 2
        taken = sum(max(0.0, middle * len(cell.pins) - widths[name]) for name, cell in netlist.cells.items())
        low, high = (middle, high) if taken < room else (low, middle)
    found, credit = {}, 0.0
    for name, cell in netlist.cells.items():
        credit += max(0.0, low * len(cell.pins) - widths[name]) if room else 0.0
        found[name] = int(credit / pitch) * pitch
        credit -= found[name]
    return found


def cells_text(netlist: Netlist, technology: Technology, density: float) -> str:
    """graywolf's input. Every cell is one piece with the gap that goes with it, to its right."""
    layers = technology.layers.values()
    pitch = next(layer.pitch for layer in layers if layer.vertical)
    x, y = round(pitch * UNITS / 2), round(next(layer.pitch for layer in layers if not layer.vertical) * UNITS / 2)
    pad = f"corners 4 -{x} -{y} -{x} {y} {x} {y} {x} -{y}"
    lines, beside = [], gaps(netlist, technology, density, pitch)
    for place, (name, cell) in enumerate(netlist.cells.items()):
        macro = technology.macros[cell.kind]
        gap = beside[name]
        left, bottom = -round((macro.width + gap) * UNITS / 2), -round(macro.height * UNITS / 2)
        right, top = left + round((macro.width + gap) * UNITS), bottom + round(macro.height * UNITS)
        lines += [f"cell {place} {name}", f"left {left} right {right} bottom {bottom} top {top}"]
        for step in range(round((right - left) / UNITS / pitch)):
            x = left + round((step + 0.5) * pitch * UNITS)
            lines += [f"pin name twfeed{step + 1} signal TW_PASS_THRU layer 1 {x} {bottom}",
                      f"   equiv name twfeed{step + 1} layer 1 {x} {top}"]
        for pin, net in cell.pins.items():
            if net not in CONSTANTS.values():
                x, y = macro.pins[pin][0].centre
                lines.append(f"pin name {pin} signal {net} layer 1 "
                             f"{left + round(x * UNITS)} {bottom + round(y * UNITS)}")
    for place, (name, port) in enumerate(netlist.ports.items(), 1):
        if port.net == name:
            lines += [f"pad {place} name twpin_{name}", pad,
                      f"pin name {name} signal {port.net} layer 1 0 0", ""]
    return "\n".join(lines) + "\n"


def read(text: str, technology: Technology, netlist: Netlist) -> Placement:
    """graywolf's .pl1: name, box, orientation and row, one a line; the core's corner becomes (0, 0)."""
    boxes = {}
    for line in text.splitlines():
        name, *numbers = line.split()
        boxes[name] = tuple(map(int, numbers))
    missing = [name for name in netlist.cells if name not in boxes]
    if missing:
        raise tools.ToolFailed(f"graywolf placed {len(netlist.cells) - len(missing)} of "
                               f"{len(netlist.cells)} cells")
    left = min(boxes[name][0] for name in netlist.cells)
    bottom = min(boxes[name][1] for name in netlist.cells)
    cells = {}
    for name, cell in netlist.cells.items():
        x0, y0, x1, _, turned, _ = boxes[name]
        word = ORIENTATIONS[turned]
        if word in ("FN", "S"):  # the gap has been turned to the left side
            x0 = x1 - round(technology.macros[cell.kind].width * UNITS)
        cells[name] = Site((x0 - left) / UNITS, (y0 - bottom) / UNITS, word)
    ports = {name.removeprefix("twpin_"): ((box[0] + box[2]) / 2 / UNITS - left / UNITS,
                                           (box[1] + box[3]) / 2 / UNITS - bottom / UNITS)
             for name, box in boxes.items() if name.startswith("twpin_")}
    width = max(boxes[name][2] for name in netlist.cells) - left
    height = max(boxes[name][3] for name in netlist.cells) - bottom
    return Placement(cells, ports, width / UNITS, height / UNITS)
