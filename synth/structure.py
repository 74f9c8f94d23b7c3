"""Makes netlists of full adders, multiplexers and gates (flows/structure.v), times them by the paper's delay model, and evaluates them.

The paper states delays of 48, 14 and 10 full adders, but no delay of a multiplexer. A Counting is an assumption about this delay.
"""

import dataclasses
import graphlib
import pathlib
from collections.abc import Callable, Iterator

from synth import mapping, scripts, store, tools, yosys
from synth.catalogue import Design


@dataclasses.dataclass(frozen=True)
class Counting:
    """Assumed delays of multiplexers, in full-adder delays. Gates have no delay."""

    title: str
    multiplexer: float  # one multiplexer
    last_multiplexer: float  # a multiplexer whose output is a bit of the sum


COUNTINGS = [
    Counting("multiplexer = 1", 1, 1),
    Counting("the paper's: 1, but 0 at a sum bit", 1, 0),
    Counting("multiplexer = 1/2", 0.5, 0.5),
    Counting("multiplexer = 0", 0, 0),
]


def netlist(design: Design) -> dict:
    """Returns the ports and cells of `design` as in Yosys's JSON, flattened to gates and the cells of structure.v. Entry `names`: the bits
    of each signal of the sources, by name."""
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


def pins(cell: dict, direction: str) -> dict[str, list]:
    """Returns port -> bits, lowest first. A bit is its number in the netlist, or a constant "0", "1", "x"."""
    return {port: bits for port, bits in cell["connections"].items() if cell["directions"][port] == direction}


def inputs(cell: dict) -> list:
    """Returns all input bits of a cell."""
    return [bit for bits in pins(cell, "input").values() for bit in bits]


def outputs(cell: dict) -> list:
    """Returns all output bits of a cell."""
    return [bit for bits in pins(cell, "output").values() for bit in bits]


def in_order(module: dict, everything: bool = False) -> Iterator[dict]:
    """Returns the cells that the outputs depend on, or all cells, in topological order: each cell follows the cells that drive it."""
    cells = module["cells"]
    driver = {bit: place for place, cell in enumerate(cells) for bit in outputs(cell)}
    before = {place: [driver[bit] for bit in inputs(cell) if bit in driver] for place, cell in enumerate(cells)}
    wanted = set(before) if everything else set()
    todo = [driver[bit] for port in module["ports"].values() if port["direction"] == "output" for bit in port["bits"] if bit in driver]
    while todo:
        place = todo.pop()
        if place not in wanted:
            wanted.add(place)
            todo += before[place]
    return (cells[place] for place in graphlib.TopologicalSorter(before).static_order() if place in wanted)


def arrivals(module: dict, costs: dict[str, float], gate: float = 0) -> tuple[dict[object, float], dict[object, dict]]:
    """Returns, by bit, the arrival time in full-adder delays, and the cell that drives the bit. `costs`: delays of cells by type. `gate`:
    delay of all other types."""
    arrival: dict[object, float] = {}
    giver: dict[object, dict] = {}
    for cell in in_order(module):
        time = max(arrival.get(bit, 0.0) for bit in inputs(cell)) + costs.get(cell["type"], gate)
        for bit in outputs(cell):
            arrival[bit], giver[bit] = time, cell
    return arrival, giver


def delay(module: dict, counting: Counting) -> float:
    """Returns the longest delay from any input to the sum."""
    arrival, giver = arrivals(module, {"FULL_ADDER": 1, "MULTIPLEXER": counting.multiplexer})
    uncounted = {"MULTIPLEXER": counting.multiplexer - counting.last_multiplexer}
    return max(arrival[bit] - uncounted.get(giver[bit]["type"], 0) for bit in module["ports"]["sum_o"]["bits"] if bit in giver)


def hardware(module: dict) -> dict[str, int]:
    """Returns the numbers of full adders, multiplexers and gates in the whole netlist."""
    kinds = [cell["type"] for cell in module["cells"]]
    found = {"full_adder": kinds.count("FULL_ADDER"), "multiplexer": kinds.count("MULTIPLEXER")}
    return {**found, "gate": len(kinds) - sum(found.values())}


# Cell type -> output port -> function of the values of the input ports. Values are unsigned numbers.
FUNCTIONS: dict[str, dict[str, Callable[[dict[str, int]], int]]] = {
    "FULL_ADDER": {"SUM": lambda x: x["A"] ^ x["B"] ^ x["C"], "CARRY": lambda x: int(x["A"] + x["B"] + x["C"] > 1)},
    "MULTIPLEXER": {"OUT": lambda x: x["WHEN_1"] if x["SELECT"] else x["WHEN_0"]},
    "$_AND_": {"Y": lambda x: x["A"] & x["B"]},
    "$_OR_": {"Y": lambda x: x["A"] | x["B"]},
    "$_XOR_": {"Y": lambda x: x["A"] ^ x["B"]},
    "$_XNOR_": {"Y": lambda x: 1 ^ x["A"] ^ x["B"]},
    "$_NOT_": {"Y": lambda x: 1 ^ x["A"]},
    "$_MUX_": {"Y": lambda x: x["B"] if x["S"] else x["A"]},
    "$shl": {"Y": lambda x: x["A"] << x["B"]},
    "$shr": {"Y": lambda x: x["A"] >> x["B"]},
    "$ge": {"Y": lambda x: int(x["A"] >= x["B"])},
    "$lt": {"Y": lambda x: int(x["A"] < x["B"])},
    "$add": {"Y": lambda x: x["A"] + x["B"]},
    "$sub": {"Y": lambda x: x["A"] - x["B"]},
}
FUNCTIONS["CARRY_SAVE"] = FUNCTIONS["FULL_ADDER"]


def evaluate(module: dict, given: dict[str, int]) -> dict[object, int]:
    """Returns bit -> value for input ports with the numbers `given`, by name. Bits without a driver are 0."""
    values: dict[object, int] = {"0": 0, "1": 1, "x": 0}
    for name, number in given.items():
        values |= split(module["ports"][name]["bits"], number)
    for cell in in_order(module, everything=True):
        found = {port: word(bits, values) for port, bits in pins(cell, "input").items()}
        for port, bits in pins(cell, "output").items():
            values |= split(bits, FUNCTIONS[cell["type"]][port](found))
    return values


def split(bits: list, number: int) -> dict[object, int]:
    """Returns bit -> value for `bits`, lowest first, that hold `number`."""
    return {bit: number >> place & 1 for place, bit in enumerate(bits)}


def word(bits: list, values: dict[object, int]) -> int:
    """Returns the number that `bits`, lowest first, hold."""
    return sum(values.get(bit, 0) << place for place, bit in enumerate(bits))


def without_constants(module: dict) -> dict:
    """Returns a netlist of the same function, without gates that have a constant input or two equal inputs, and without duplicate gates.
    All ports of cells must have one bit."""
    same: dict[object, object] = {}  # removed bit -> the bit or constant that replaces the removed bit
    cells, known = [], {}
    for cell in in_order(module):
        ins = {port: same.get(bit, bit) for port, (bit,) in pins(cell, "input").items()}
        out, *more = outputs(cell)
        a, b = ins.get("A"), ins.get("B")
        constants = [bit for bit in (a, b) if bit in ("0", "1")]
        other = b if a in ("0", "1") else a
        folds = {("$_AND_", "0"): "0", ("$_AND_", "1"): other, ("$_OR_", "0"): other, ("$_OR_", "1"): "1",
                 ("$_XOR_", "0"): other}
        kind = cell["type"]
        shape = (kind, *(sorted(map(str, ins.values())) if kind in ("$_AND_", "$_OR_", "$_XOR_") else ins.items()))
        if constants and (kind, constants[0]) in folds:
            same[out] = folds[kind, constants[0]]
        elif kind in ("$_AND_", "$_OR_") and a == b:
            same[out] = a
        elif not more and shape in known:
            same[out] = known[shape]
        else:
            known[shape] = out
            cells.append(cell | {"connections": pins(cell, "output") | {port: [bit] for port, bit in ins.items()}})
    ports = {name: port | {"bits": [same.get(bit, bit) for bit in port["bits"]]} for name, port in module["ports"].items()}
    return module | {"ports": ports, "cells": cells}
