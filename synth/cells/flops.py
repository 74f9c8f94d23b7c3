"""A flip-flop's delay from the clock, and how long before and after a clock edge its data must stay."""

import pathlib

from synth import tools
from synth.cells import delays, ngspice
from synth.cells.catalogue import Cell, Corner
from synth.cells.delays import LOADS, MIDDLE, SLEWS
from synth.cells.extraction import Circuit
from synth.cells.ngspice import Transient

EDGE_SLEWS = (0.01, 0.12, 1.0)  # ns, of clock and data, in the tables of set-up and hold
SLOWER = 1.1  # a data edge too near to the clock's makes the output this many times as slow, or fail
NEAREST, FARTHEST, STEPS = -1.0, 2.0, 10  # ns between the edges, and how often the interval is halved: 3 ps


def flop(cell: Cell, circuit: Circuit, corner: Corner, folder: pathlib.Path) -> dict:
    """{"arcs": the tables of Q by the clock's slew and the load; "capacitances": pF of each input; "leakage": at rest; "setup", "hold": tables in ns
    of data that "rise" and that "fall", rows by the clock's slew, columns by the data's}."""
    grid = [(slew, load * cell.drive) for slew in SLEWS for load in LOADS]
    found = ngspice.run(circuit, corner, ["Q"], [_waves(cell, corner, slew, SLEWS[MIDDLE], load)
                                                 for slew, load in grid], folder / "tables.log")
    for (slew, load), got in zip(grid, found, strict=True):
        if not {"rise_delay", "fall_delay", "rise_slew", "fall_slew"} <= got.keys():
            raise tools.ToolFailed(f"{cell.name}: Q does not follow D at a slew of {slew} ns and {load} pF: {got}")
    volts = corner.volts

    def table(name: str, scale: float, less: float = 0) -> list[list[float]]:
        return [[scale * found[row * len(LOADS) + column][name] - less * load * cell.drive
                 for column, load in enumerate(LOADS)] for row in range(len(SLEWS))]

    arc = {"output": "Q", "input": "CLK", "inverts": None, "slews": list(SLEWS), "loads": [load * cell.drive for load in LOADS],
           "cell_rise": table("rise_delay", 1e9), "cell_fall": table("fall_delay", 1e9),
           "rise_transition": table("rise_slew", 1e9), "fall_transition": table("fall_slew", 1e9),
           "rise_energy": table("rise_supply", -1e12 * volts, volts**2), "fall_energy": table("fall_supply", -1e12 * volts)}
    middle = found[MIDDLE * len(LOADS) + MIDDLE]
    farads = {pin: (abs(middle[f"{pin}_up"]) + abs(middle[f"{pin}_down"])) / 2 / volts * 1e12 for pin in ("CLK", "D")}
    for pin in (cell.flop.clear, cell.flop.preset):
        if pin:
            farads[pin] = _asynchronous(cell, circuit, corner, pin, folder)
    return {"arcs": [arc], "capacitances": farads,
            "leakage": [{"when": "", "nanowatts": -middle["rest"] * volts * 1e9}],
            **{kind: _constraint(cell, circuit, corner, kind, folder / f"{kind}.log") for kind in ("setup", "hold")}}


def _waves(cell: Cell, corner: Corner, clock_slew: float, data_slew: float, load: float,
           rises: float | None = None, falls: float | None = None, hold: bool = False) -> Transient:
    """Three clock edges: the first clears Q (sets it, for `hold`), at the second it rises and at the third it falls, or the
    other way round.

    Data rise `rises` ns ahead of the second edge and fall `falls` ns ahead of the third; a half period where that is None. For
    `hold` they do so as long *after* the edges, having come a quarter period before to what the edge takes.
    """
    volts = corner.volts
    # Q settles within a clock's half period, and so does data ahead of it.
    half = 3 + 3 * max(clock_slew, data_slew) + 60 * load / cell.drive
    edges = [half * (2 * i + 1) for i in range(3)]
    clock = ngspice.ramp([time + half * low for time in edges for low in (0, 1)], clock_slew, volts)
    if hold:
        data = ngspice.ramp([edges[1] - half / 2, edges[1] + rises, edges[2] + falls], data_slew, volts, high=True)
    else:
        data = ngspice.ramp([edges[1] - (half if rises is None else rises), edges[2] - (half if falls is None else falls)],
                            data_slew, volts)
    high = {pin: ngspice.constant(volts) for pin in (cell.flop.clear, cell.flop.preset) if pin}
    first, second = ("fall", "rise") if hold else ("rise", "fall")
    end = edges[2] + half
    measures = {}
    for name, i in ((first, 1), (second, 2)):
        window = (edges[i] - clock_slew, edges[i] + half - clock_slew)
        measures.update(delays.measures(name, "CLK", "Q", "rise", name, volts, window, event=i + 1))
    measures |= {f"D_{edge}": f"integ i(D) from={at - data_slew}n to={at + half / 2}n"
                 for edge, at in (("up", edges[1] - half), ("down", edges[2] - half))}
    measures["rest"] = f"find i(VPWR) at={edges[1] - 1.5 * clock_slew}n"
    measures |= {"CLK_up": measures["rise_charge"],
                 "CLK_down": f"integ i(CLK) from={edges[1] + half - clock_slew}n to={edges[2] - clock_slew}n"}
    return Transient({"CLK": clock, "D": data, **high}, {"Q": load}, end, measures)


def _constraint(cell: Cell, circuit: Circuit, corner: Corner, kind: str, log: pathlib.Path) -> dict:
    """Bisects, for each pair of slews and both edges of data at once, how near data may come to the clock's edge."""
    hold, load = kind == "hold", LOADS[1] * cell.drive
    pairs = [(clock, data) for clock in EDGE_SLEWS for data in EDGE_SLEWS]
    # Which edge of Q tells whether an edge of data kept its distance: for hold, that of the data before it.
    told = {"rise": "fall", "fall": "rise"} if hold else {"rise": "rise", "fall": "fall"}

    def distances(near: list[dict[str, float]]) -> list[dict[str, float]]:
        return ngspice.run(circuit, corner, ["Q"], [
            _waves(cell, corner, clock, data, load, at["rise"], at["fall"], hold)
            for (clock, data), at in zip(pairs, near, strict=True)], log)

    free = distances([{"rise": FARTHEST, "fall": FARTHEST}] * len(pairs))
    good = [dict.fromkeys(told, FARTHEST) for _ in pairs]
    bad = [dict.fromkeys(told, NEAREST) for _ in pairs]
    for _ in range(STEPS):
        tried = [{edge: (good[i][edge] + bad[i][edge]) / 2 for edge in told} for i in range(len(pairs))]
        for i, got in enumerate(distances(tried)):
            for edge, shows in told.items():
                delay = got.get(f"{shows}_delay")
                kept = delay is not None and 0 < delay < SLOWER * free[i][f"{shows}_delay"]
                (good if kept else bad)[i][edge] = tried[i][edge]
    size = len(EDGE_SLEWS)
    return {edge: [[good[row * size + column][edge] for column in range(size)] for row in range(size)] for edge in told}


def _asynchronous(cell: Cell, circuit: Circuit, corner: Corner, pin: str, folder: pathlib.Path) -> float:
    """The capacitance of a pin that clears or presets, pF; that it does so is seen to."""
    volts, slew, half = corner.volts, SLEWS[MIDDLE], 3.0
    high = pin == cell.flop.preset
    (got,) = ngspice.run(circuit, corner, ["Q"], [Transient(
        {"CLK": ngspice.ramp([half], slew, volts), "D": ngspice.constant(volts * (not high)),
         pin: ngspice.ramp([2 * half, 3 * half], slew, volts, high=True)}, {"Q": LOADS[MIDDLE]}, 4 * half,
        {"before": f"find v(Q) at={2 * half - 1}n", "after": f"find v(Q) at={4 * half - 0.1}n",
         "down": f"integ i({pin}) from={2 * half - 1}n to={3 * half - 1}n",
         "up": f"integ i({pin}) from={3 * half - 1}n to={4 * half - 0.1}n"})], folder / "asynchronous.log")
    if abs(got["before"] - volts * (not high)) > 0.02 * volts or abs(got["after"] - volts * high) > 0.02 * volts:
        raise tools.ToolFailed(f"{cell.name}: Q is {got['before']} V, and {got['after']} V after {pin} was low")
    return (abs(got["up"]) + abs(got["down"])) / 2 / volts * 1e12
