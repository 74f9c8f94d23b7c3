"""Runs ngspice on one cell: many transients in one process, between which sources and loads are altered."""

import dataclasses
import pathlib
import re

from synth import tools
from synth.cells import models
from synth.cells.catalogue import Corner
from synth.cells.extraction import Circuit

STEPS = 50  # of a transient at least; how fine it gets is said by these tolerances, which keep delays and transitions
TOLERANCES = "trtol=0.1 reltol=1e-3 chgtol=1e-16"  # within 0.5 % of what 8,000 even steps give
Wave = tuple[tuple[float, float], ...]  # ns and V; before the first and after the last, constant


@dataclasses.dataclass(frozen=True)
class Transient:
    """One run: what every input does, pF at every output, how long, ns; and what is measured, by name: ngspice's words.

    Measured currents flow out of the supply or an input: i(VPWR), i(A).
    """

    waves: dict[str, Wave]
    loads: dict[str, float]
    duration: float
    measures: dict[str, str]


def ramp(times: list[float], slew: float, volts: float, high: bool = False) -> Wave:
    """A wave that changes at `times` (of its middle), begins high or low, and takes `slew` ns from 20 to 80 %."""
    half, points = slew / 0.6 / 2, []
    for time in times:
        points += [(time - half, volts * high), (time + half, volts * (not high))]
        high = not high
    return tuple(points)


def constant(volts: float) -> Wave:
    """A wave that stays."""
    return ((0.0, volts),)


def run(circuit: Circuit, corner: Corner, outputs: list[str], transients: list[Transient],
        log: pathlib.Path) -> list[dict[str, float]]:
    """What each transient measured; a measure whose event never came is left out.

    Writes the deck beside `log`, which takes what ngspice prints.
    """
    inputs = [pin for pin in circuit.pins if pin not in outputs]
    deck = [f"* {circuit.name}, {corner.name}\n", models.at_corner(corner.process), circuit.spice(),
            ".global VGND\nVground VGND 0 0\n", f"VVPWR VPWR 0 {corner.volts}\n",
            f"X1 {' '.join(circuit.pins)} VPWR cell\n",
            *(f"V{pin} {pin} 0 pwl(0 0 1 0)\n" for pin in inputs),
            *(f"Cload_{pin} {pin} 0 1f\n" for pin in outputs),
            f".temp {corner.celsius}\n.options {TOLERANCES}\n.control\n"]
    for number, transient in enumerate(transients):
        deck += [f"alter @v{pin}[pwl] = [ {_points(wave, transient.duration)} ]\n".lower()
                 for pin, wave in transient.waves.items()]
        deck += [f"alter cload_{pin} = {farads:g}e-12\n".lower() for pin, farads in transient.loads.items()]
        step = transient.duration / STEPS
        deck.append(f"tran {step:.6f}n {transient.duration:.5f}n 0 {step:.6f}n\n")
        for name, words in transient.measures.items():
            # The supply's current flows out of its first node, which SPICE counts as negative.
            words = re.sub(r"i\((\w+)\)", r"v\1#branch", words)
            deck.append(f"meas tran {name} {words}\necho measured {number} {name} $&{name}\n")
        deck.append("destroy all\n")
    deck.append("quit\n.endc\n.end\n")
    log.parent.mkdir(parents=True, exist_ok=True)
    source = log.with_suffix(".cir")
    source.write_text("".join(deck))
    # Threads of its own take ngspice fifteen times as long on circuits this small.
    (log.parent / ".spiceinit").write_text("set num_threads=1\n")
    text = tools.run(["ngspice", "-b", source], log, folder=log.parent)
    results: list[dict[str, float]] = [{} for _ in transients]
    for number, name, got in re.findall(r"^measured (\d+) (\w+) (\S+)$", text, re.M):
        results[int(number)][name] = float(got)
    return results


def _points(wave: Wave, duration: float) -> str:
    """The wave from 0 to the end in seconds and volts; ngspice wants at least two points."""
    points = [(0.0, wave[0][1]), *((time, volts) for time, volts in wave if time > 0), (duration + 1, wave[-1][1])]
    return " ".join(f"{time:.6f}e-9 {volts:g}" for time, volts in points)
