"""Maps one design to one standard-cell library by one flow, and times the result."""

import collections
import functools
import json
import pathlib
import re

from synth import runner, scripts, store, tools, yosys
from synth.catalogue import Design, Library

# One step of a path in OpenSTA's report: load, slew, delay, arrival, edge, pin, cell type.
PATH_STEP = re.compile(r"^\s*(?:[\d.]+\s+)*?(?P<delay>-?[\d.]+)\s+(?P<arrival>-?[\d.]+) "
                       r"[v^] (?P<pin>\S+) \((?P<cell>\w+)\)$", re.M)


@functools.cache
def flow_facts() -> tuple[str, ...]:
    """Returns the versions of the tools that every mapping uses."""
    return yosys.version(), tools.version("sta")


def files() -> list[pathlib.Path]:
    """Returns the files of synth/ that define how a netlist is made and timed."""
    names = ("comparisons.v", "structure.v", "known_inputs.v", "osu_cells.v", "kept_memory.v", "kept_memories.v", "kept_enables.v", "timing.tcl",
             "constraints.sdc", *set(scripts.ABC_SCRIPTS.values()))
    return [*scripts.FILES, *sorted(tools.FLOWS / name for name in names)]


def top_module(file: pathlib.Path) -> dict:
    """Returns the top module in Yosys's JSON."""
    modules = json.loads(file.read_text())["modules"]
    (module,) = [body for body in modules.values() if "top" in body["attributes"]]
    return module


def synthesise(design: Design, library: Library, flow: str, root: pathlib.Path | None = None) -> tuple[dict, bool]:
    """Returns area (Liberty units), delay (ns), cells and critical path; and whether this result was cached."""
    folder = (root or store.OUT / "runs") / f"{design.name}.{library.name}.{flow}"
    read = [*design.sources(flow == "cells"), library.liberty, *files()]
    wanted = store.key(read, flow_facts(), design.facts, design.clock, library, flow)
    work = functools.partial(_map_and_time, design, library, flow, folder)
    return store.cached(folder, wanted, (lambda: runner.step("mapping, minutes for a core", folder / "yosys.log", work)) if flow == "blocks" else work)


def _map_and_time(design: Design, library: Library, flow: str, folder: pathlib.Path) -> dict:
    constraints = folder / "constraints"
    constraints.write_text(  # ABC counts femtofarads
        f"set_driving_cell {library.driver}\nset_load {1000 * library.load_pf:g}\n")
    prefix = folder / "netlist"
    yosys.run(scripts.standard_cells(design, library, flow, blocks(design), constraints, prefix), folder / "yosys.log")
    (mapped,) = statistics(prefix.with_suffix(".stat.json")).values()
    timing = sta(design, library, prefix.with_suffix(".timed.v"), folder / "timing.txt")
    delay, path = critical_path(timing)
    clocked = registers(prefix.with_suffix(".timed.v").read_text(), path) if design.clock else {}
    parts = {"blocks": block_costs(statistics(prefix.with_suffix(".blocks.json")), kept_memories(
        prefix.with_suffix(".memories").read_text()))} if flow == "blocks" else {}
    return {**clocked, **parts, "area": round(mapped["area"]), "delay_ns": delay, "cells": mapped["num_cells_by_type"], "path": path}


def sta(design: Design, library: Library, netlist: pathlib.Path, log: pathlib.Path,
        spef: pathlib.Path | None = None, clock: str = "") -> str:
    """Returns OpenSTA's report of the slowest path of `netlist`.

    `spef`: file of the wires' parasitics. `clock`: the clock port of `netlist`, if its name differs from the design's.
    """
    return tools.run(["sta", "-exit", tools.FLOWS / "timing.tcl"], log, {
        "LIBERTY": str(library.liberty), "NETLIST": str(netlist), "TOP": design.top,
        "SDC": str(tools.FLOWS / "constraints.sdc"), "DRIVER": library.driver, "LOAD": f"{library.load_pf}",
        "ACCESS": f"{library.access_ns}", "CLOCK": clock or design.clock,
        "SPEF": str(spef or "")})


def blocks(design: Design) -> list[str]:
    """Returns the modules that flow `blocks` maps on their own: the modules of the design's folder except subsystems. Subsystems only
    connect other modules and count as parts of the top."""
    return [file.stem for file in design.sources() if file.stem != design.top and not file.stem.endswith(("_pkg", "_subsystem"))
            and file.parent.name == design.folder]


def kept_memories(dump: str) -> dict[str, int]:
    """Returns the bits of the memories in a Yosys dump of cells, by module; module "" if the dump names no module."""
    bits, module = collections.Counter(), ""
    for header, size in re.findall(r"^module \\?(\S+)|parameter \\BITS (\d+)", dump, re.M):
        module = header or module
        bits[module] += int(size or 0)
    return dict(bits)


def statistics(file: pathlib.Path) -> dict[str, dict]:
    """Returns, from Yosys's `stat -json`, the area (Liberty units) and cells by type of each module, including submodules."""
    return {name.removeprefix("\\"): {"area": 0, **module} for name, module in json.loads(file.read_text())["modules"].items()}


def block_costs(modules: dict[str, dict], memories: dict[str, int]) -> dict[str, dict]:
    """Returns, for each kind of block in the top, the number of instances, their total area (Liberty units) and their total memory bits.
    Both totals include submodules.

    `modules`: from `statistics`, before flattening. `memories`: from `kept_memories`.
    """
    inside = {name: {cell: count for cell, count in module["num_cells_by_type"].items() if cell in modules}
              for name, module in modules.items()}

    def bits(name: str) -> int:
        return memories.get(name, 0) + sum(count * bits(cell) for cell, count in inside[name].items())

    (top,) = modules.keys() - {cell for cells in inside.values() for cell in cells}
    rest = modules[top]["area"] - sum(count * modules[cell]["area"] for cell, count in inside[top].items())
    found = {"the rest": {"count": 1, "area": round(rest), "bits": memories.get("", memories.get(top, 0))}}
    for cell, count in inside[top].items():
        block = found.setdefault(cell.partition("$")[0], {"count": 0, "area": 0, "bits": 0})
        block["count"] += count
        block["area"] += round(count * modules[cell]["area"])
        block["bits"] += count * bits(cell)
    return found


def registers(netlist: str, path: list[dict]) -> dict[str, str]:
    """Returns both ends of a path: for a register, the name of its signal; for a port, the port's name."""
    def name(pin: str) -> str:
        instance, _, port = pin.partition("/")
        if not port:
            return instance
        output = re.search(rf"\b{re.escape(instance)} \([^;]*?\.Q\(\\?([^ )]+)", netlist)
        return output.group(1) if output else instance

    return {"from": name(path[0]["pin"]), "to": name(path[-1]["pin"])}


def critical_path(report: str) -> tuple[float, list[dict]]:
    """Returns the length in ns, including set-up time, and the steps of the slowest path in OpenSTA's report.

    Raises ToolFailed if the report has no path.
    """
    arrival = re.search(r"^\s*(-?[\d.]+)\s+data arrival time", report, re.M)
    if arrival is None:
        problem = re.search(r"^(?:Error|Warning).*", report, re.M)
        raise tools.ToolFailed(f"no timing path: {problem.group(0) if problem else report[-300:]}")
    setup = re.search(r"^\s*(?:[\d.]+\s+)*?-([\d.]+)\s+[\d.]+\s+library setup time", report, re.M)
    steps = [{"arrival": float(step["arrival"]), "delay": float(step["delay"]), "pin": step["pin"], "cell": step["cell"]}
             for step in PATH_STEP.finditer(report[: arrival.start()])]
    return round(float(arrival.group(1)) + float(setup.group(1) if setup else 0), 3), steps
