"""Routes a placement with qrouter: writes DEF, and reads DEF with wires."""

import dataclasses
import pathlib
import re

from synth import tools
from synth.layout.place import Placement, Site

UNITS = 100  # DEF units per um
RAILS = ("gnd", "vdd")
FILLER = "FILL"


@dataclasses.dataclass(frozen=True)
class Wire:
    """A straight piece of a net, um, or a via. `layer`: the metal of a piece, or the metal at which a via begins."""

    layer: str
    x0: float
    y0: float
    x1: float
    y1: float
    to: str = ""  # for a via: the metal at which it ends

    @property
    def length(self) -> float:
        """Length in um."""
        return abs(self.x1 - self.x0) + abs(self.y1 - self.y0)


Wires = dict[str, list[Wire]]  # by net


def route(placement: Placement, lef: pathlib.Path, folder: pathlib.Path, tidy: bool = True) -> tuple[Wires, list[str]]:
    """Routes a placement. Returns the wires and the names of failed nets. Writes placed.def and routed.def into `folder`. `tidy`: makes
    qrouter reroute every net twice. This shortens the wires of a 48-bit adder by 5 % and doubles the time."""
    (folder / "placed.def").write_text(definition(placement))
    fence = "\n".join(f"obstruction {left} {bottom} {right} {top} {layer}"
                      for layer, left, bottom, right, top in fences(placement))
    (folder / "failed.txt").unlink(missing_ok=True)
    (folder / "route.tcl").write_text(
        f"verbose 1\nread_lef {lef}\nvia stack all\nvdd vdd\ngnd gnd\n{fence}\nread_def placed.def\n"
        f"qrouter::standard_route routed.def false {str(not tidy).lower()}\nset failed [open failed.txt w]\n"
        "puts $failed [failing summary]\nforeach net [failing] {puts $failed $net}\n"
        "close $failed\nquit\n")
    tools.run(["qrouter", "-nog", "-s", "route.tcl"], folder / "qrouter.log", folder=folder)
    _, *failed = (folder / "failed.txt").read_text().split("\n")
    return wires((folder / "routed.def").read_text(), list(placement.technology.layers)), sorted(filter(None, failed))


def fences(placement: Placement) -> list[tuple]:
    """Returns obstructions around the core (layer, left, bottom, right, top; um). Only straight wires to ports can pass them."""
    left, bottom, right, top = placement.die
    across, up = (layer.pitch / 2 for layer in placement.technology.tracks)
    found = []
    for place, (name, layer) in enumerate(placement.technology.layers.items()):
        if place == 0 or not layer.vertical:
            found += [(name, left, bottom, right, -up), (name, left, placement.height + up, right, top)]
        if place == 0 or layer.vertical:
            found += [(name, left, bottom, -across, top),
                      (name, placement.width + across, bottom, right, top)]
    return [(name, *(round(value, 3) for value in box)) for name, *box in found]


def fillers(placement: Placement) -> list[Site]:
    """Returns the places for filler cells: all free places in rows. Fillers continue the rails and wells between cells."""
    filler = placement.technology.macros[FILLER].width
    rows: dict[float, list] = {}
    for name, site in placement.cells.items():
        rows.setdefault(site.y, []).append((site.x, placement.macro(name).width, "FS" if site.turned in ("FS", "S") else "N"))
    found = []
    for y, row in sorted(rows.items()):
        at = 0.0
        for x, width, turned in [*sorted(row), (placement.width, 0, min(row)[2])]:
            while at + filler <= x + 1e-6:
                found.append(Site(at, y, turned))
                at += filler
            at = x + width
    return found


def _units(value: float) -> int:
    return round(value * UNITS)


def definition(placement: Placement) -> str:
    """Returns the text of the DEF file before routing."""
    netlist, technology = placement.netlist, placement.technology
    left, bottom, right, top = placement.die
    lines = ["VERSION 5.6 ;", "NAMESCASESENSITIVE ON ;", 'DIVIDERCHAR "/" ;', 'BUSBITCHARS "<>" ;',
             f"DESIGN {netlist.top} ;", f"UNITS DISTANCE MICRONS {UNITS} ;",
             f"DIEAREA ( {_units(left)} {_units(bottom)} ) ( {_units(right)} {_units(top)} ) ;"]
    for name, layer in technology.layers.items():
        low, high, axis = (left, right, "X") if layer.vertical else (bottom, top, "Y")
        first = -int(-low / layer.pitch) * layer.pitch
        count = int((high - first) / layer.pitch) + 1
        lines.append(f"TRACKS {axis} {_units(first)} DO {count} STEP {_units(layer.pitch)} LAYER {name} ;")
    cells = [*((name, netlist.cells[name].kind, site) for name, site in placement.cells.items()),
             *((f"f{place}", FILLER, site) for place, site in enumerate(fillers(placement)))]
    lines.append(f"COMPONENTS {len(cells)} ;")
    for name, kind, site in cells:
        x, y = map(_units, placement.corner(site))
        lines.append(f"- {name} {kind} + PLACED ( {x} {y} ) {site.turned} ;")
    ports = placement.pins
    lines += ["END COMPONENTS", f"PINS {len(ports)} ;"]
    for name, (x, y, layer) in ports.items():
        lines += [f"- {name} + NET {name}", f"  + LAYER {layer} ( 0 0 ) ( 1 1 )",
                  f"  + PLACED ( {_units(x)} {_units(y)} ) N ;"]
    nets = {net: ends for net, ends in netlist.nets().items() if len(ends) > 1 or net in RAILS}
    lines += ["END PINS", f"NETS {len(nets)} ;"]
    for net, ends in nets.items():
        lines += [f"- {net}", *(f"  ( {cell} {pin} )" for cell, pin in ends), ";"]
    return "\n".join([*lines, "END NETS", "END DESIGN"]) + "\n"


def wires(text: str, layers: list[str]) -> Wires:
    """Returns the ROUTED pieces of each net of a DEF file."""
    found: Wires = {}
    body = re.search(r"^NETS \d+ ;\n(.*?)^END NETS", text, re.M | re.S).group(1)
    units = int(re.search(r"^UNITS DISTANCE MICRONS (\d+)", text, re.M).group(1))
    for entry in body.split("\n- "):
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
