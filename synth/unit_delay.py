"""The paper's delay model, counted on the elaborated netlist: full adders and multiplexers on the
longest path, gates between them free.

The paper states 48, 14 and 10 full-adder delays but not what a multiplexer counts, nor which paths;
so every figure goes with its counting.
"""

import dataclasses
import pathlib

from synth import mapping, scripts, store, tools, yosys
from synth.catalogue import Design


@dataclasses.dataclass(frozen=True)
class Counting:
    """What a path's cells count, in full-adder delays."""

    name: str
    title: str
    multiplexer: float  # one multiplexer
    last_multiplexer: float  # the one that gives a bit of the sum, the last on its path


COUNTINGS = [
    Counting("all", "multiplexer = 1", 1, 1),
    Counting("carries", "multiplexer = 1, the one that selects the sum bit = 0", 1, 0),
    Counting("half", "multiplexer = 1/2", 0.5, 0.5),
    Counting("free", "multiplexer = 0", 0, 0),
]


def netlist(design: Design) -> dict:
    """The module of `design` as Yosys's JSON, flattened to structure.v's cells and gates; `names`: the bits of each word of
    the sources."""
    folder = store.OUT / "structure" / design.name
    files = [*design.sources(structural=True), tools.FLOWS / "known_inputs.v", *scripts.FILES]
    wanted = store.key(files, yosys.version(), design.facts, "with names")
    return store.cached(folder, wanted, lambda: _elaborate(design, folder))[0]


def _elaborate(design: Design, folder: pathlib.Path) -> dict:
    file = folder / "structure.json"
    yosys.run(scripts.structure_json(design, file), folder / "yosys.log")
    module = mapping.top_module(file)
    names = {name: net["bits"] for name, net in module["netnames"].items() if not net["hide_name"]}
    return {"ports": module["ports"], "names": names, "cells": [
        {"type": cell["type"], "connections": cell["connections"],
         "directions": cell["port_directions"]} for cell in module["cells"].values()]}


def count(module: dict, counting: Counting) -> dict:
    """The longest path from any input to the sum, and how many cells of each type it has."""
    driver = {}
    for cell in module["cells"]:
        for port, bits in cell["connections"].items():
            if cell["directions"][port] == "output":
                driver.update(dict.fromkeys(bits, cell))
    done: dict = {}

    def arrival(bit: object, last: bool) -> tuple[float, tuple[str, ...]]:
        """When `bit` is there, and the cells on its slowest path; `last`: it is a sum bit."""
        if (bit, last) in done:
            return done[bit, last]
        cell = driver.get(bit)
        if cell is None:  # an input or a constant
            return 0, ()
        slowest = max((arrival(source, False) for port, bits in cell["connections"].items()
                       if cell["directions"][port] == "input" for source in bits),
                      key=lambda arrived: arrived[0])
        kind = cell["type"]
        cost = {"FULL_ADDER": 1,
                "MULTIPLEXER": counting.last_multiplexer if last else counting.multiplexer}
        done[bit, last] = slowest[0] + cost.get(kind, 0), (*slowest[1], kind)
        return done[bit, last]

    delay, path = max((arrival(bit, True) for bit in module["ports"]["sum_o"]["bits"]), key=lambda arrived: arrived[0])
    return {"delay": delay, "full_adders": path.count("FULL_ADDER"),
            "multiplexers": path.count("MULTIPLEXER"),
            "gates": len(path) - path.count("FULL_ADDER") - path.count("MULTIPLEXER")}


def cells(module: dict) -> dict[str, int]:
    """How many full adders and multiplexers the whole netlist has."""
    kinds = [cell["type"] for cell in module["cells"]]
    return {kind.lower(): kinds.count(kind) for kind in ("FULL_ADDER", "MULTIPLEXER")}
