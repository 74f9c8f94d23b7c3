"""Places a netlist in rows with Coloquinte, in seconds.

Coloquinte reads and writes the bookshelf format of placement contests: .nodes, .nets, .pl, .scl. Coordinates are whole numbers: here x in
tracks, y in steps of 1/STEPS of a row's height. A step is longer than a track. To the placer, horizontal wires (one metal) therefore cost
more than vertical wires (two metals).
"""

import dataclasses
import functools
import math
import pathlib

from synth import tools
from synth.layout.lef import Macro, Technology
from synth.layout.netlist import CONSTANTS, Netlist

FULL = 0.97  # most of a row that cells and gaps may take: the placer needs some free space to fill the rows
STEPS = 9
EFFORT = 3  # of 9; more effort takes longer and does not shorten wires


@dataclasses.dataclass(frozen=True)
class Site:
    """The place of a cell: lower left corner (um), and orientation N, FN, S or FS."""

    x: float
    y: float
    turned: str


@dataclasses.dataclass(frozen=True)
class Placement:
    """The places of a netlist's cells and ports by name, and the core's width and height, um. Ports lie around the core."""

    netlist: Netlist
    technology: Technology
    cells: dict[str, Site]
    ports: dict[str, tuple[float, float]]
    width: float
    height: float

    def macro(self, cell: str) -> Macro:
        """Returns the outline of a cell."""
        return self.technology.macros[self.netlist.cells[cell].kind]

    def corner(self, site: Site) -> tuple[float, float]:
        """Returns a cell's lower left corner in DEF, um. The offset puts the pins on tracks, which are at multiples of a pitch."""
        across, up = self.technology.tracks
        return site.x + across.offset, site.y + up.offset

    @functools.cached_property
    def die(self) -> tuple[float, float, float, float]:
        """The bounds of the core with four tracks around it, um: left, bottom, right, top."""
        across, up = (layer.pitch for layer in self.technology.tracks)
        return -4 * across, -4 * up, (round(self.width / across) + 4) * across, (round(self.height / up) + 4) * up

    @functools.cached_property
    def pins(self) -> dict[str, tuple[float, float, str]]:
        """The place of each port: x, y (um), layer. A port has a track of its own, on the side of the core near the port's cells."""
        across, up = (layer.pitch for layer in self.technology.tracks)
        left, bottom, right, top = self.die
        # A port's side is the side that the port is farthest beyond.
        sides: dict[str, list[tuple[float, str]]] = {"left": [], "right": [], "bottom": [], "top": []}
        for name, (x, y) in self.ports.items():
            beyond = {"left": -x, "right": x - self.width, "bottom": -y, "top": y - self.height}
            side = max(beyond, key=lambda word: (beyond[word], word))
            sides[side].append((x if side in ("bottom", "top") else y, name))
        found = {}
        for side, here in sides.items():
            upright = side in ("bottom", "top")
            step = across if upright else up
            last = round((self.width if upright else self.height) / step)
            if len(here) > last:
                raise tools.ToolFailed(f"{len(here)} ports on the {side} side, which has {last} tracks")
            for at, name in _spread([(at / step, name) for at, name in sorted(here)], last):
                if upright:
                    found[name] = (at * step, bottom + up if side == "bottom" else top - up, self.technology.up)
                else:
                    found[name] = (left + across if side == "left" else right - across, at * step, self.technology.across)
        return {name: found[name] for name in self.netlist.ports if name in found}


def _spread(wanted: list[tuple[float, str]], last: int) -> list[tuple[int, str]]:
    """Returns different whole numbers from 1 to `last`, in order, near the wanted numbers."""
    places, low = [], 1
    for count, (at, name) in enumerate(wanted):
        room = last - (len(wanted) - 1 - count)  # leaves places for the remaining names
        place = min(max(round(at), low), room)
        places.append((place, name))
        low = place + 1
    return places


def place(netlist: Netlist, technology: Technology, seed: int, density: float, aspect: float,
          folder: pathlib.Path) -> Placement:
    """Places the cells twice: first without ports, then with each port near the place of its net in the first placement.

    `density`: the fraction of the rows that cells take. `aspect`: the core's height divided by its width.
    """
    pitch = technology.tracks[0].pitch
    macros = {name: technology.macros[cell.kind] for name, cell in netlist.cells.items()}
    beside = gaps(netlist, technology, min(1.0, density / FULL), pitch)
    widths = {name: round((macro.width + beside[name]) / pitch) for name, macro in macros.items()}
    height = next(iter(macros.values())).height
    area = sum(widths.values()) * pitch * height / FULL
    rows = max(1, round(math.sqrt(area * aspect) / height))
    sites = math.ceil(area / (rows * height * pitch))
    widest = max(widths.values())
    for wider in range(0, widest + 1, max(1, widest // 4)):  # few cells may not pack into rows of their total area
        free, _ = _run(netlist, technology, widths, {}, (sites + wider, rows), seed, folder / "free")
        ports = around(netlist, free, (sites + wider, rows * STEPS))
        try:
            found, turned = _run(netlist, technology, widths, ports, (sites + wider, rows), seed, folder / "placed")
        except tools.ToolFailed:
            if wider + max(1, widest // 4) > widest:
                raise
            continue
        sites += wider
        break
    step = height / STEPS
    cells = {}
    for name, (x, y) in found.items():
        aside = beside[name] if turned[name] in ("FN", "S") else 0  # the gap of a mirrored cell is at its left side
        cells[name] = Site(x * pitch + aside, y * step, turned[name])
    return Placement(netlist, technology, cells, {name: (x * pitch, y * step) for name, (x, y) in ports.items()},
                     sites * pitch, rows * height)


def _run(netlist: Netlist, technology: Technology, widths: dict[str, int], ports: dict[str, tuple[int, int]],
         core: tuple[int, int], seed: int, stem: pathlib.Path) -> tuple[dict, dict[str, str]]:
    """Returns the lower left corner and the orientation of each cell. Without `ports`, cells are placed globally: not aligned to rows."""
    for suffix, text in bookshelf(netlist, technology, widths, ports, core).items():
        stem.with_suffix(suffix).write_text(text.format(stem=stem.name))
    solution = stem.with_suffix(".sol")
    tools.run(["coloquinte", "--effort", str(EFFORT), "--seed", str(seed), "--save-solution", solution,
               *([] if ports else ["--only-global"]), stem.with_suffix(".aux")], stem.with_suffix(".log"))
    places, turned = {}, {}
    for line in solution.read_text().splitlines():
        name, *words = line.split() or [""]
        if name in netlist.cells:
            places[name] = int(words[0]), int(words[1])
            turned[name] = words[3]
    return places, turned


def bookshelf(netlist: Netlist, technology: Technology, widths: dict[str, int], ports: dict[str, tuple[int, int]],
              core: tuple[int, int]) -> dict[str, str]:
    """Returns the bookshelf files by suffix. `widths`: of cells, in tracks. `ports`: x in tracks, y in rows / STEPS. `core`: (tracks, rows)."""
    sites, rows = core
    pitch = technology.tracks[0].pitch
    nodes = [f"{name} {widths[name]} {STEPS}" for name in netlist.cells] + [f"{name} terminal" for name in ports]
    at = [f"{name} {sites // 2} {rows * STEPS // 2} : N" for name in netlist.cells]
    at += [f"{name} {x} {y} : N" for name, (x, y) in ports.items()]
    nets = []
    for net, ends in netlist.nets().items():
        pins = []
        for cell, pin in ends:
            if cell == "PIN":
                pins += [f"{pin} I : 0 0"] if pin in ports else []
                continue
            macro = technology.macros[netlist.cells[cell].kind]
            x, y = macro.pins[pin][0].centre
            pins.append(f"{cell} I : {x / pitch - widths[cell] / 2:.2f} {(y / macro.height - 0.5) * STEPS:.2f}")
        if len(pins) > 1 and net not in CONSTANTS.values():
            nets += [f"NetDegree : {len(pins)} {net}", *pins]
    lines = [f"NumRows : {rows}"]
    for row in range(rows):
        lines += ["CoreRow Horizontal", f"Coordinate : {row * STEPS}", f"Height : {STEPS}", "Sitewidth : 1",
                  f"Siteorient : {'FS' if row % 2 else 'N'}", f"SubrowOrigin : 0 NumSites : {sites}", "End"]
    return {".aux": "RowBasedPlacement : {stem}.nodes {stem}.nets {stem}.pl {stem}.scl\n",
            **{suffix: "\n".join(["UCLA 1.0", *text]) + "\n" for suffix, text in
               ((".nodes", nodes), (".nets", nets), (".pl", at), (".scl", lines))}}


def around(netlist: Netlist, cells: dict[str, tuple[int, int]], core: tuple[int, int]) -> dict[str, tuple[int, int]]:
    """Returns places for the ports, equally spaced around the core, in the order of the directions from its middle to their nets' cells."""
    width, height = core
    angles = {}
    for ends in netlist.nets().values():
        near = [cells[cell] for cell, _ in ends if cell != "PIN"]
        x = sum(x for x, _ in near) / len(near) if near else 0
        y = sum(y for _, y in near) / len(near) if near else 0
        angles.update({pin: math.atan2(y / height - 0.5, x / width - 0.5) for cell, pin in ends if cell == "PIN"})
    order = sorted(angles, key=lambda name: (angles[name], name))
    return {name: _edge((place + 0.5) / len(order) * 2 * (width + height), width, height)
            for place, name in enumerate(order)}


def _edge(far: float, width: int, height: int) -> tuple[int, int]:
    """Returns the point at distance `far` along the core's edge. The path begins at the middle of the left side and goes downwards."""
    for x, y, dx, dy, length in ((0, height / 2, 0, -1, height / 2), (0, 0, 1, 0, width), (width, 0, 0, 1, height),
                                 (width, height, -1, 0, width), (0, height, 0, -1, height / 2)):
        if far <= length:
            return round(x + dx * far), round(y + dy * far)
        far -= length
    return 0, round(height / 2)


def gaps(netlist: Netlist, technology: Technology, density: float, pitch: float) -> dict[str, float]:
    """Returns the gap beside each cell, um, a multiple of `pitch`. Cells with many pins for their width get larger gaps.

    Wires are densest where pins are. Including gaps, cells with a gap have the same width per pin.
    """
    widths = {name: technology.macros[cell.kind].width for name, cell in netlist.cells.items()}
    room = sum(widths.values()) * (1 / density - 1)
    low, high = 0.0, sum(widths.values()) / density  # um per pin
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
