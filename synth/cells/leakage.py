"""What a cell takes at rest, in each state of its inputs; and whether its outputs are what its functions say."""

import itertools
import pathlib

from synth import tools
from synth.cells import ngspice
from synth.cells.catalogue import Cell, Corner, inputs, value
from synth.cells.extraction import Circuit


def leakage(cell: Cell, circuit: Circuit, corner: Corner, folder: pathlib.Path) -> list[dict]:
    """For each state of a combinational cell's inputs: {"when": Liberty's words for it, "nanowatts": ...}."""
    pins = sorted({pin for _, function in cell.functions for pin in inputs(function)})
    states = [dict(zip(pins, values, strict=True)) for values in itertools.product((False, True), repeat=len(pins))]
    outputs = [output for output, _ in cell.functions]
    found = ngspice.run(circuit, corner, outputs, [ngspice.Transient(
        {pin: ngspice.constant(corner.volts * high) for pin, high in state.items()}, {}, 1.0,
        {"supply": "find i(VPWR) at=0.9n", **{output: f"find v({output}) at=0.9n" for output in outputs}})
        for state in states], folder / "rest.log")
    for state, got in zip(states, found, strict=True):
        for output, function in cell.functions:
            wanted = value(function, state)
            if abs(got[output] - corner.volts * wanted) > 0.02 * corner.volts:
                raise tools.ToolFailed(f"{cell.name}: {output} is {got[output]} V where {function} is {wanted:d}: {state}")
    return [{"when": "&".join(pin if high else f"!{pin}" for pin, high in state.items()),
             "nanowatts": -got["supply"] * corner.volts * 1e9} for state, got in zip(states, found, strict=True)]
