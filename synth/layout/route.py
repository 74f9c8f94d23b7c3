"""Routes a placement with qrouter: DEF out, DEF with wires back."""

import dataclasses
import pathlib
import re

from synth import tools
from synth.layout.lef import Technology
from synth.layout.netlist import Netlist
from synth.layout.place import Placement

UNITS = 100  # to the um, in DEF
RAILS = ("gnd", "vdd")
FILLER = "FILL"


@dataclasses.dataclass(frozen=True)
class Wire:
    """A straight piece of a net, um; `layer` is that of its metal, or of both metals of a via."""

    layer: str
    x0: float
    y0: float
    x1: float
    y1: float
    to: str = ""  # a via: the metal that it leads to

    @property
    def length(self) -> float:
        """um."""
        return abs(self.x1 - self.x0) + abs(self.y1 - self.y0)


@dataclasses.dataclass(frozen=True)
class Routing:
    """The wires of each net, where the ports are (um, on which layer), the nets that failed."""

    wires: dict[str, list[Wire]]
    ports: dict[str, tuple[float, float, str]]
    failed: list[str]
    die: tuple[float, float, float, float]


def route(netlist: Netlist, placement: Placement, technology: Technology, lef: pathlib.Path,
          folder: pathlib.Path, tidy: bool = True) -> Routing:
    """Leaves placed.def and routed.def in `folder`. `tidy`: qrouter routes every net once more, twice: wires
    of a 48-bit adder become 5 % shorter, and it takes as long again."""
    ports = pins(placement, technology, netlist)
    die = outline(placement, technology)
    (folder / "placed.def").write_text(definition(netlist, placement, technology, ports, die))
    fence = "\n".join(f"obstruction {left} {bottom} {right} {top} {layer}"
                      for layer, left, bottom, right, top in fences(placement, technology, die))
    (folder / "failed.txt").unlink(missing_ok=True)
    (folder / "route.tcl").write_text(
        f"verbose 1\nread_lef {lef}\nvia stack all\nvdd vdd\ngnd gnd\n{fence}\nread_def placed.def\n"
        f"qrouter::standard_route routed.def false {str(not tidy).lower()}\nset failed [open failed.txt w]\n"
        "puts $failed [failing summary]\nforeach net [failing] {puts $failed $net}\n"
        "close $failed\nquit\n")
    tools.run(["qrouter", "-nog", "-s", "route.tcl"], folder / "qrouter.log", folder=folder)
    _, *failed = (folder / "failed.txt").read_text().split("\n")
    layers = list(technology.layers)
    return Routing(wires((folder / "routed.def").read_text(), layers), ports,
                   sorted(filter(None, failed)), die)


def _tracks(technology: Technology) -> tuple[float, float]:
    """Pitch of the vertical and of the horizontal tracks that ports lie on, um."""
    layers = list(technology.layers.values())
    return (next(layer.pitch for layer in layers if layer.vertical),
            next(layer.pitch for layer in layers if not layer.vertical))


def outline(placement: Placement, technology: Technology) -> tuple[float, float, float, float]:
    """The die: the core and four tracks around it, um."""
    across, up = _tracks(technology)
    right = round(placement.width / across) + 4
    top = round(placement.height / up) + 4
    return -4 * across, -4 * up, right * across, top * up


def pins(placement: Placement, technology: Technology,
         netlist: Netlist) -> dict[str, tuple[float, float, str]]:
    """Each port on a track of its own, at the side where its cells are: x, y, layer."""
    across, up = _tracks(technology)
    left, bottom, right, top = outline(placement, technology)
    middles = [name for name in technology.layers]
    vertical = next(name for name in middles if technology.layers[name].vertical)
    horizontal = next(name for name in middles[middles.index(vertical):]
                      if not technology.layers[name].vertical)
    # How far beyond each side; the side that it is furthest beyond is its own.
    sides: dict[str, list[tuple[float, str]]] = {"left": [], "right": [], "bottom": [], "top": []}
    for name, (x, y) in placement.ports.items():
        beyond = {"left": -x, "right": x - placement.width, "bottom": -y, "top": y - placement.height}
        side = max(beyond, key=lambda word: (beyond[word], word))
        sides[side].append((x if side in ("bottom", "top") else y, name))
    found = {}
    for side, here in sides.items():
        upright = side in ("bottom", "top")
        step = across if upright else up
        last = round((placement.width if upright else placement.height) / step)
        if len(here) > last:
            raise tools.ToolFailed(f"{len(here)} ports on the {side} side, which has {last} tracks")
        for at, name in _spread([(at / step, name) for at, name in sorted(here)], last):
            if upright:
                found[name] = (at * step, bottom + up if side == "bottom" else top - up, vertical)
            else:
                found[name] = (left + across if side == "left" else right - across, at * step, horizontal)
    return {name: found[name] for name in netlist.ports if name in found}


def _spread(wanted: list[tuple[float, str]], last: int) -> list[tuple[int, str]]:
    """Whole places of 1 to `last`, one for each, in order, near those wanted."""
    places, low = [], 1
    for count, (at, name) in enumerate(wanted):
        room = last - (len(wanted) - 1 - count)  # so that those that follow find theirs
        place = min(max(round(at), low), room)
        places.append((place, name))
        low = place + 1
    return places


def fences(placement: Placement, technology: Technology,
           die: tuple[float, float, float, float]) -> list[tuple]:
    """Around the core no wires but those that lead straight to ports: obstructions, um."""
    left, bottom, right, top = die
    across, up = (pitch / 2 for pitch in _tracks(technology))
    found = []
    for place, (name, layer) in enumerate(technology.layers.items()):
        if place == 0 or not layer.vertical:
            found += [(name, left, bottom, right, -up), (name, left, placement.height + up, right, top)]
        if place == 0 or layer.vertical:
            found += [(name, left, bottom, -across, top),
                      (name, placement.width + across, bottom, right, top)]
    return [(name, *(round(value, 3) for value in box)) for name, *box in found]


def _units(value: float) -> int:
    return round(value * UNITS)


def origin(technology: Technology) -> tuple[float, float]:
    """Where the first cell's corner lies, um, so that its pins are on tracks, which are multiples of a pitch."""
    layers = list(technology.layers.values())
    return (next(layer.offset for layer in layers if layer.vertical),
            next(layer.offset for layer in layers if not layer.vertical))


def fillers(netlist: Netlist, placement: Placement, technology: Technology) -> list[tuple[float, float, str]]:
    """Where a row has no cell, for rails and wells must not end: x, y, orientation."""
    filler = technology.macros[FILLER].width
    rows: dict[float, list] = {}
    for name, site in placement.cells.items():
        rows.setdefault(site.y, []).append((site.x, technology.macros[netlist.cells[name].kind].width,
                                            "FS" if site.turned in ("FS", "S") else "N"))
    found = []
    for y, row in sorted(rows.items()):
        at = 0.0
        for x, width, turned in [*sorted(row), (placement.width, 0, min(row)[2])]:
            while at + filler <= x + 1e-6:
                found.append((at, y, turned))
                at += filler
            at = x + width
    return found


def definition(netlist: Netlist, placement: Placement, technology: Technology,
               ports: dict[str, tuple[float, float, str]], die: tuple[float, float, float, float]) -> str:
    """DEF before routing."""
    left, bottom, right, top = die
    lines = ["VERSION 5.6 ;", "NAMESCASESENSITIVE ON ;", 'DIVIDERCHAR "/" ;', 'BUSBITCHARS "<>" ;',
             f"DESIGN {netlist.top} ;", f"UNITS DISTANCE MICRONS {UNITS} ;",
             f"DIEAREA ( {_units(left)} {_units(bottom)} ) ( {_units(right)} {_units(top)} ) ;"]
    for name, layer in technology.layers.items():
        low, high, axis = (left, right, "X") if layer.vertical else (bottom, top, "Y")
        first = -int(-low / layer.pitch) * layer.pitch
        count = int((high - first) / layer.pitch) + 1
        lines.append(f"TRACKS {axis} {_units(first)} DO {count} STEP {_units(layer.pitch)} LAYER {name} ;")
    x0, y0 = origin(technology)
    gaps = fillers(netlist, placement, technology)
    lines.append(f"COMPONENTS {len(netlist.cells) + len(gaps)} ;")
    for name, site in placement.cells.items():
        lines.append(f"- {name} {netlist.cells[name].kind} + PLACED "
                     f"( {_units(site.x + x0)} {_units(site.y + y0)} ) {site.turned} ;")
    for place, (x, y, turned) in enumerate(gaps):
        lines.append(f"- f{place} {FILLER} + PLACED ( {_units(x + x0)} {_units(y + y0)} ) {turned} ;")
    lines += ["END COMPONENTS", f"PINS {len(ports)} ;"]
    for name, (x, y, layer) in ports.items():
        lines += [f"- {name} + NET {name}", f"  + LAYER {layer} ( 0 0 ) ( 1 1 )",
                  f"  + PLACED ( {_units(x)} {_units(y)} ) N ;"]
    nets = {net: ends for net, ends in netlist.nets().items() if len(ends) > 1 or net in RAILS}
    lines += ["END PINS", f"NETS {len(nets)} ;"]
    for net, ends in nets.items():
        lines += [f"- {net}", *(f"  ( {cell} {pin} )" for cell, pin in ends), ";"]
    return "\n".join([*lines, "END NETS", "END DESIGN"]) + "\n"


def wires(text: str, layers: list[str]) -> dict[str, list[Wire]]:
    """The ROUTED pieces of each net of a DEF of these UNITS."""
    found: dict[str, list[Wire]] = {}
    body = re.search(r"^NETS \d+ ;\n(.*?)^END NETS", text, re.M | re.S).group(1)
    units = int(re.search(r"^UNITS DISTANCE MICRONS (\d+)", text, re.M).group(1))
    for entry in body.split("\n- ")[0:]:
        name = entry.removeprefix("- ").split(None, 1)[0]
        pieces = []
        routed = re.search(r"\+ ROUTED (.*)", entry, re.S)
        for piece in re.split(r"\n\s*NEW ", routed.group(1)) if routed else []:
            pieces += _piece(piece.split(), layers, units)
        found[name] = pieces
    return found


def _piece(words: list[str], layers: list[str], units: int) -> list[Wire]:
    layer, at, found, place = words[0], None, [], 1
    while place < len(words):
        word = words[place]
        if word == "(":
            x, y = words[place + 1: place + 3]
            point = (at[0] if x == "*" else int(x) / units, at[1] if y == "*" else int(y) / units)
            if at is not None:
                found.append(Wire(layer, *at, *point))
            at = point
            place = words.index(")", place) + 1
            continue
        metals = [name for name in layers if f"M{name[-1]}" in word.split("_")]
        if len(metals) == 2:  # a via, named after its metals: M2_M1
            other = metals[0] if metals[1] == layer else metals[1]
            found.append(Wire(layer, *at, *at, to=other))
            layer = other
        place += 1
    return found
