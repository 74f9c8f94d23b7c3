"""Draws a trace of one ray in the ray core (VCD): when each part has something of it.

`python3 -m synth.ray_timeline TRACE SAVE_FILE OUT.svg`. TRACE is what `make lecture PIXEL=64,64` writes. SAVE_FILE is GTKWave's, as for
synth.waveform: its first signal is the clock, each other one a row, with a bar where it is not zero.
"""

import pathlib
import sys

from synth import waveform
from synth.drawing import plt

COLOURS = ("tab:blue", "tab:green", "tab:orange", "tab:red", "tab:purple")


def bars(changes: list[tuple[int, str]], edges: list[int]) -> list[tuple[int, int]]:
    """(first clock, clocks) of each stretch in which the signal is not zero; x is zero."""
    found: list[tuple[int, int]] = []
    values = iter([*changes, (edges[-1] + 1, "0")])
    when, bits = next(values)
    now = "0"
    for clock, edge in enumerate(edges):
        while when <= edge:
            now = bits
            when, bits = next(values, (edges[-1] + 1, "0"))
        if "1" not in now:
            continue
        if found and sum(found[-1]) == clock:
            found[-1] = (found[-1][0], found[-1][1] + 1)
        else:
            found.append((clock, 1))
    return found


def draw(trace: str, save_file: str, out: pathlib.Path) -> None:
    """Writes OUT.svg; raises KeyError for a signal that is not in the trace."""
    changes, groups = waveform.read(trace), waveform.groups(save_file)
    (_, clock), *_ = groups[0][1]
    edges = [when for when, bits in changes[clock] if bits == "1"]
    rows = [(place, name, bars(changes[signal], edges)) for place, (_, signals) in enumerate(groups)
            for name, signal in signals if signal != clock]
    first = min(stretch[0][0] for _, _, stretch in rows if stretch)
    figure, axes = plt.subplots(figsize=(11, 0.32 * len(rows) + 1), layout="constrained")
    for y, (group, _, stretches) in enumerate(rows):
        axes.broken_barh([(start - first, length) for start, length in stretches], (y - 0.35, 0.7),
                         color=COLOURS[group % len(COLOURS)])
    axes.set_yticks(range(len(rows)), [name for _, name, _ in rows])
    axes.invert_yaxis()
    axes.set_xlim(0, len(edges) - first)
    axes.set_xlabel("clocks")
    axes.grid(axis="x", alpha=0.4)
    axes.set_axisbelow(True)
    figure.savefig(out, metadata={"Date": None})
    plt.close(figure)


if __name__ == "__main__":
    sys.exit(waveform.main("synth.ray_timeline", "Draws a trace (VCD) of one ray in the ray core, OUT as SVG.",
                           lambda trace, save_file, out: draw(trace.read_text(), save_file.read_text(), out)))
