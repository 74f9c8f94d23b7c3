"""The values of a combinational netlist (unit_delay.netlist) for chosen inputs, and the netlist without what constants decide."""

from collections.abc import Callable, Iterator

# Output port -> its value from those of the cell's input ports; numbers without a sign.
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


def pins(cell: dict, direction: str) -> dict[str, list]:
    """Port -> bits, lowest first: numbers of the netlist's, or the constants "0", "1", "x"."""
    return {port: bits for port, bits in cell["connections"].items() if cell["directions"][port] == direction}


def bits_of(words: dict[str, list]) -> list:
    """All bits of some ports."""
    return [bit for bits in words.values() for bit in bits]


def in_order(module: dict, everything: bool = False) -> Iterator[dict]:
    """The cells that the outputs depend on, or all, each behind those that it depends on."""
    driver = {bit: cell for cell in module["cells"] for bit in bits_of(pins(cell, "output"))}
    wanted = [bit for port in module["ports"].values() if port["direction"] == "output" for bit in port["bits"]]
    given, todo = set(), module["cells"][:] if everything else [driver[bit] for bit in reversed(wanted) if bit in driver]
    while todo:
        cell = todo[-1]
        if id(cell) in given:
            todo.pop()
            continue
        before = [driver[bit] for bit in bits_of(pins(cell, "input")) if bit in driver and id(driver[bit]) not in given]
        todo += before
        if not before:
            given.add(id(todo.pop()))
            yield cell


def evaluate(module: dict, inputs: dict[str, int]) -> dict[object, int]:
    """Bit -> value, where input port `name` has the number inputs[name]; what nothing drives counts as 0."""
    values: dict[object, int] = {"0": 0, "1": 1, "x": 0}
    for name, number in inputs.items():
        values |= split(module["ports"][name]["bits"], number)
    for cell in in_order(module, everything=True):
        found = {port: word(bits, values) for port, bits in pins(cell, "input").items()}
        for port, bits in pins(cell, "output").items():
            values |= split(bits, FUNCTIONS[cell["type"]][port](found))
    return values


def split(bits: list, number: int) -> dict[object, int]:
    """Bit -> its value, where `bits`, lowest first, hold `number`."""
    return {bit: number >> place & 1 for place, bit in enumerate(bits)}


def word(bits: list, values: dict[object, int]) -> int:
    """The number that `bits`, lowest first, hold."""
    return sum(values.get(bit, 0) << place for place, bit in enumerate(bits))


def without_constants(module: dict) -> dict:
    """The same function with fewer gates: none with a constant or twice the same input, and none twice. Of gates and cells
    that take and give single bits."""
    same: dict[object, object] = {}  # bit -> the bit or constant that it equals
    cells, known = [], {}
    for cell in in_order(module):
        ins = {port: same.get(bit, bit) for port, (bit,) in pins(cell, "input").items()}
        (out, *more) = bits_of(pins(cell, "output"))
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
