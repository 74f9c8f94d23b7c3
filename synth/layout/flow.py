"""Makes the layout of one design from its netlist and times it with its wires. Keeps results in build/synth/layouts."""

import dataclasses
import json
import pathlib

from synth import liberty, mapping, store, tools
from synth.catalogue import Design, Library
from synth.layout import estimate, lef, netlist, parasitics, place, route

HERE = pathlib.Path(__file__).resolve().parent
SPARSE = 0.45, 1.3  # density and aspect at which all nets of an integer multiplier can be routed
SPARSER = 0.42, 1.3  # density and aspect at which all nets of the binary32 multiplier can be routed
TIDIED = 1000  # most cells of a design whose nets are rerouted; rerouting then takes seconds


@dataclasses.dataclass(frozen=True)
class Job:
    """A layout to make. `density`: the fraction of the core's rows that cells take. `aspect`: the core's height divided by its width.
    Designs with many wires are better tall, because horizontal wires have one metal and vertical wires have two.
    `routed`: whether to route; else the wires are those of estimate.py."""

    design: Design
    library: Library
    flow: str
    density: float = 1.0
    aspect: float = 0.75
    seed: int = 1
    routed: bool = True

    @property
    def folder(self) -> pathlib.Path:
        """The folder of the layout's results."""
        name = f"{self.design.name}.{self.library.name}.{self.flow}"
        return store.OUT / "layouts" / f"{name}.{self.density:g}.{self.aspect:g}" / f"seed-{self.seed}"


def key(job: Job) -> str:
    """Returns a hash of everything that a layout depends on."""
    files = [*job.design.sources(job.flow == "cells"), job.library.liberty, job.library.lef,
             *job.library.magic, *mapping.files(),
             *(HERE / name for name in ("lef.py", "netlist.py", "place.py", "estimate.py", "route.py", "parasitics.py"))]
    return store.key(files, mapping.flow_facts(), *(tools.version(tool) for tool in ("qrouter", "magic")),
                     job.design.facts, job.library, job.flow, job.density, job.aspect, job.seed, job.routed)


def make(job: Job) -> tuple[dict, bool]:
    """Returns the result, and whether an earlier run kept it. It has the delays (ns) of cells alone, with estimated wires and with routed
    wires; areas (um2); wires (um, pF); number of failed nets, None if not routed. If nets failed, there is no delay with routed wires."""
    return store.cached(job.folder, key(job), tools.measured(lambda: _make(job)))


def _make(job: Job) -> dict:
    mapped, _ = mapping.synthesise(job.design, job.library, job.flow)
    run = store.OUT / "runs" / f"{job.design.name}.{job.library.name}.{job.flow}"
    folder = job.folder
    (folder / "wires.spef").unlink(missing_ok=True)  # `load` takes this file as the sign that all nets are routed
    (folder / "netlist.json").write_text((run / "netlist.json").read_text())
    nets = netlist.parse(mapping.top_module(folder / "netlist.json"), job.design.top)
    placement = place.place(nets, lef.read(job.library.lef), job.seed, job.density, job.aspect, folder)
    (folder / "placement.json").write_text(json.dumps({
        "cells": {name: dataclasses.astuple(site) for name, site in placement.cells.items()}, "ports": placement.ports,
        "width": placement.width, "height": placement.height}))
    (folder / "placed.v").write_text(nets.verilog())
    wires = estimate.wires(placement)
    ohms = parasitics.contacts(job.library.magic[1], list(placement.technology.layers))
    farads = {net: estimate.FARADS[job.library.name] * sum(wire.length for wire in pieces) for net, pieces in wires.items()}
    cells_ns, _ = mapping.critical_path(_time(job, nets, "cells"))

    def with_wires(name: str) -> tuple[float, list[dict]]:
        (folder / f"{name}.spef").write_text(parasitics.spef(placement, wires, farads, ohms, outputs(job.library)))
        return mapping.critical_path(_time(job, nets, name))

    guess_ns, path = with_wires("estimate")
    result = {
        "cells": len(nets.cells), "nets": len(nets.nets()), "area": mapped["area"], "cells_ns": cells_ns,
        "guess_ns": guess_ns, "core": round(placement.width * placement.height), "width": placement.width,
        "height": placement.height, "failed": None,
    }
    if job.routed:
        routed, failed = route.route(placement, job.library.lef, folder, tidy=len(nets.cells) <= TIDIED)
        result["failed"] = len(failed)
        if not failed:
            wires, farads = routed, parasitics.extract(nets, job.library.lef, job.library.magic[0], folder)
            result["wires_ns"], path = with_wires("wires")
    pieces = [wire for net in wires.values() for wire in net]
    return {**result, "path": path, "wire_um": round(sum(wire.length for wire in pieces)),
            "vias": sum(bool(wire.to) for wire in pieces), "wire_pf": round(sum(farads.values()), 3)}


def _time(job: Job, nets: netlist.Netlist, name: str) -> str:
    """Returns OpenSTA's report with the wires in NAME.spef, or without wires if there is no such file."""
    clock = next((short for short, port in nets.ports.items() if port.name == job.design.clock), "")
    wires = job.folder / f"{name}.spef"
    return mapping.sta(job.design, job.library, job.folder / "placed.v", job.folder / f"{name}.txt",
                       wires if wires.exists() else None, clock)


def outputs(library: Library) -> dict[str, set[str]]:
    """Returns the output pins of each type of cell, from the Liberty file."""
    return {cell.name: {pin.name for pin in cell.of("pin") if pin.attributes.get("direction") == "output"}
            for cell in liberty.read(library.liberty).of("cell")}


def load(job: Job) -> tuple[place.Placement, route.Wires]:
    """Returns the placement and wires of a layout made before. The wires are estimated unless all nets were routed."""
    kept = json.loads((job.folder / "placement.json").read_text())
    placement = place.Placement(netlist.parse(mapping.top_module(job.folder / "netlist.json"), job.design.top),
                                lef.read(job.library.lef), {name: place.Site(*site) for name, site in kept["cells"].items()},
                                kept["ports"], kept["width"], kept["height"])
    if (job.folder / "wires.spef").exists():
        return placement, route.wires((job.folder / "routed.def").read_text(), list(placement.technology.layers))
    return placement, estimate.wires(placement)
