"""Delay, transition and energy of a cell's outputs, by slew of the input and load."""

import pathlib

from synth import tools
from synth.cells import ngspice
from synth.cells.catalogue import Arc, Cell, Corner, arcs
from synth.cells.extraction import Circuit

SLEWS = (0.01, 0.04, 0.12, 0.35, 1.0)  # ns from 20 to 80 %
LOADS = (0.0005, 0.003, 0.01, 0.03, 0.1)  # pF, times the drive
MIDDLE = 2  # where the slowest of several states is chosen, and where pins are measured


def combinational(cell: Cell, circuit: Circuit, corner: Corner, folder: pathlib.Path) -> dict:
    """{"arcs": tables of each output, input and sense; "capacitances": pF of each input}.

    Of the states of the other inputs that an arc may be taken in, that which is slowest in the middle of the table stands for all.
    """
    every = arcs(cell)
    outputs = [output for output, _ in cell.functions]
    slew, load = SLEWS[MIDDLE], LOADS[MIDDLE] * cell.drive
    probed = ngspice.run(circuit, corner, outputs,
                         [_transient(arc, outputs, slew, load, cell.drive, corner) for arc in every], folder / "states.log")
    slowest, charges = {}, {}
    for arc, got in zip(every, probed, strict=True):
        _check(cell, arc, got, corner.volts)
        key = (arc.output, arc.input, arc.inverts)
        total = got["up_delay"] + got["down_delay"]
        if key not in slowest or total > slowest[key][0]:
            slowest[key] = total, arc
        charges.setdefault(arc.input, []).append((abs(got["up_charge"]) + abs(got["down_charge"])) / 2)
    chosen = [arc for _, arc in slowest.values()]
    grid = [(arc, slew, load * cell.drive) for arc in chosen for slew in SLEWS for load in LOADS]
    found = ngspice.run(circuit, corner, outputs,
                        [_transient(arc, outputs, slew, load, cell.drive, corner) for arc, slew, load in grid],
                        folder / "tables.log")
    for (arc, _, _), got in zip(grid, found, strict=True):
        _check(cell, arc, got, corner.volts)
    size = len(SLEWS) * len(LOADS)
    return {
        "arcs": [_tables(arc, found[i * size:(i + 1) * size], [load * cell.drive for load in LOADS], corner)
                 for i, arc in enumerate(chosen)],
        "capacitances": {pin: sum(all) / len(all) / corner.volts * 1e12 for pin, all in charges.items()},
    }


def _transient(arc: Arc, outputs: list[str], slew: float, load: float, drive: int, corner: Corner) -> ngspice.Transient:
    """The input rises and falls, each long enough for the output to settle."""
    half = 3 + 3 * slew + 150 * load / drive  # ns: what the weakest cell at the slow corner needs, and more
    up, down, volts = 0.1 + slew, 0.1 + slew + half, corner.volts
    waves = {arc.input: ngspice.ramp([up, down], slew, volts),
             **{pin: ngspice.constant(volts * high) for pin, high in arc.held}}
    end = down + half
    return ngspice.Transient(waves, {pin: load if pin == arc.output else LOADS[0] for pin in outputs}, end, {
        **measures("up", arc.input, arc.output, "rise", "fall" if arc.inverts else "rise", volts, (0, down - slew)),
        **measures("down", arc.input, arc.output, "fall", "rise" if arc.inverts else "fall", volts, (down - slew, end)),
        "up_end": f"find v({arc.output}) at={down - slew:.5f}n", "down_end": f"find v({arc.output}) at={end - 0.01:.5f}n",
    })


def measures(name: str, source: str, output: str, edge: str, response: str, volts: float,
             window: tuple[float, float], event: int = 1) -> dict[str, str]:
    """The measures of one edge at `source` and of what it does to `output`: delay between the middles, transition from 20 to
    80 %, charge out of the supply and out of the source during `window`, ns. `event`: which of the edges."""
    low, high = 0.2 * volts, 0.8 * volts
    first, last = (low, high) if response == "rise" else (high, low)
    span = f"from={window[0]:.5f}n to={window[1]:.5f}n"
    after = f"td={window[0]:.5f}n"
    return {
        f"{name}_delay": f"trig v({source}) val={volts / 2} {edge}={event} targ v({output}) val={volts / 2} {after} {response}=1",
        f"{name}_slew": f"trig v({output}) val={first} {after} {response}=1 targ v({output}) val={last} {after} {response}=1",
        f"{name}_supply": f"integ i(VPWR) {span}",
        f"{name}_charge": f"integ i({source}) {span}",
    }


def _check(cell: Cell, arc: Arc, got: dict[str, float], volts: float) -> None:
    """Raises ToolFailed where the output did not follow the input as the cell's function says, and settle."""
    missing = {f"{edge}_{what}" for edge in ("up", "down") for what in ("delay", "slew", "end")} - got.keys()
    if missing:
        raise tools.ToolFailed(f"{cell.name}: {arc.output} does not follow {arc.input} with {dict(arc.held)}: "
                               f"no {', '.join(sorted(missing))}")
    if abs(got["up_end"] - got["down_end"]) < 0.98 * volts:
        raise tools.ToolFailed(f"{cell.name}: {arc.output} does not settle: it ends at {got['up_end']} and {got['down_end']} V")


def _tables(arc: Arc, found: list[dict[str, float]], loads: list[float], corner: Corner) -> dict:
    """The tables of an arc, ns and pJ: rows by slew, columns by load.

    Energies are what the cell takes beyond charging the load: the supply's on a rise less C V^2, all of it on a fall.
    """
    rise, fall = ("down", "up") if arc.inverts else ("up", "down")

    def table(name: str, scale: float, less: float = 0) -> list[list[float]]:
        return [[scale * found[row * len(loads) + column][name] - less * load for column, load in enumerate(loads)]
                for row in range(len(found) // len(loads))]

    volts = corner.volts
    return {"output": arc.output, "input": arc.input, "inverts": arc.inverts, "slews": list(SLEWS), "loads": loads,
            "cell_rise": table(f"{rise}_delay", 1e9), "cell_fall": table(f"{fall}_delay", 1e9),
            "rise_transition": table(f"{rise}_slew", 1e9), "fall_transition": table(f"{fall}_slew", 1e9),
            "rise_energy": table(f"{rise}_supply", -1e12 * volts, volts**2),
            "fall_energy": table(f"{fall}_supply", -1e12 * volts)}
