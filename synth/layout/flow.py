"""One design from its netlist to a layout that is timed with its wires; kept in build/synth/layouts."""

import dataclasses
import json
import pathlib
import re

from synth import mapping, store, tools
from synth.catalogue import Design, Library
from synth.layout import lef, netlist, parasitics, place, route

HERE = pathlib.Path(__file__).resolve().parent


@dataclasses.dataclass(frozen=True)
class Job:
    """A layout to make. `density`: the share of the core's rows that cells take; `aspect`: its height by its
    width. Wires run across in one metal alone and upwards in two, so what has many is better tall."""

    design: Design
    library: Library
    flow: str
    density: float = 1.0
    aspect: float = 0.75
    seed: int = 1

    @property
    def folder(self) -> pathlib.Path:
        """Where it is kept."""
        name = f"{self.design.name}.{self.library.name}.{self.flow}"
        return store.OUT / "layouts" / f"{name}.{self.density:g}.{self.aspect:g}" / f"seed-{self.seed}"


@dataclasses.dataclass(frozen=True)
class Layout:
    """What the kept files say: enough to draw it and to simulate it."""

    netlist: netlist.Netlist
    technology: lef.Technology
    placement: place.Placement
    routing: route.Routing


def key(job: Job) -> str:
    """Of all that a layout depends on."""
    files = [*job.design.sources(job.flow == "cells"), job.library.liberty, job.library.lef,
             job.library.graywolf, *job.library.magic, *mapping.scripts(),
             *(HERE / name for name in ("lef.py", "netlist.py", "place.py", "route.py", "parasitics.py",
                                        "magic.tcl"))]
    return store.key(files, mapping.flow_facts(), *(tools.version(tool) for tool in ("qrouter", "magic")),
                     job.design.facts, job.library, job.flow, job.density, job.aspect, job.seed)


def make(job: Job) -> tuple[dict, bool]:
    """Delay of the cells alone and with wires (ns), areas (um2), wires (um, pF), failed nets, slacks;
    and whether it was kept. Where nets failed there is no delay with wires."""
    return store.cached(job.folder, key(job), tools.measured(lambda: _make(job)))


def _make(job: Job) -> dict:
    mapped, _ = mapping.synthesise(job.design, job.library, job.flow)
    run = store.OUT / "runs" / f"{job.design.name}.{job.library.name}.{job.flow}"
    folder = job.folder
    (folder / "netlist.json").write_text((run / "netlist.json").read_text())
    nets = netlist.parse(mapping.top_module(folder / "netlist.json"), job.design.top)
    technology = lef.read(job.library.lef)
    placement = place.place(nets, technology, job.library.graywolf, job.seed, job.density, job.aspect,
                            folder)
    routing = route.route(nets, placement, technology, job.library.lef, folder)
    startup, tech = job.library.magic
    farads = parasitics.extract(nets, job.library.lef, startup, folder)
    (folder / "placed.v").write_text(nets.verilog())
    clock = next((name for name, port in nets.ports.items() if port.name == job.design.clock), "")
    cells_ns, _ = mapping.critical_path(
        mapping.sta(job.design, job.library, folder / "placed.v", folder / "cells.txt", clock=clock))
    wires = [wire for pieces in routing.wires.values() for wire in pieces]
    result = {
        "cells": len(nets.cells), "nets": len(nets.nets()), "failed": len(routing.failed),
        "area": mapped["area"], "cells_ns": cells_ns,
        "core": round(placement.width * placement.height), "width": placement.width,
        "height": placement.height, "wire_um": round(sum(wire.length for wire in wires)),
        "vias": sum(bool(wire.to) for wire in wires), "wire_pf": round(sum(farads.values()), 3),
    }
    if routing.failed:
        return result
    ohms = parasitics.contacts(tech, list(technology.layers))
    (folder / "wires.spef").write_text(parasitics.spef(
        nets, placement, routing, technology, farads, ohms, outputs(job.library)))
    report = mapping.sta(job.design, job.library, folder / "placed.v", folder / "wires.txt", True,
                         folder / "wires.spef", clock)
    wires_ns, path = mapping.critical_path(report)
    return {**result, "wires_ns": wires_ns, "path": path, "slacks": slacks(report)}


def slacks(report: str) -> list[float]:
    """The slack at each end of a path in an OpenSTA report of end points, ns, the least first."""
    found = re.findall(r"^\S+ \((?:output|\w+)\) +[\d.]+ +-?[\d.]+ +(-?[\d.]+)", report, re.M)
    return sorted(map(float, found))


def outputs(library: Library) -> dict[str, set[str]]:
    """The output pins of each type of cell, as Liberty says."""
    found = {}
    for name, body in re.findall(r"^\s*cell \((\w+)\) \{(.*?)(?=^\s*cell \(|\Z)",
                                 library.liberty.read_text(), re.M | re.S):
        found[name] = set(re.findall(r"pin\s*\((\w+)\)\s*\{[^}]*?direction\s*:\s*output", body))
    return found


def load(job: Job) -> Layout:
    """A layout that was made."""
    folder = job.folder
    nets = netlist.parse(mapping.top_module(folder / "netlist.json"), job.design.top)
    technology = lef.read(job.library.lef)
    placement = place.read((folder / "placed.pl1").read_text(), technology, nets)
    failed = [name for name in (folder / "failed.txt").read_text().split("\n")[1:] if name]
    wires = route.wires((folder / "routed.def").read_text(), list(technology.layers))
    return Layout(nets, technology, placement, route.Routing(
        wires, route.pins(placement, technology, nets), failed, route.outline(placement, technology)))
