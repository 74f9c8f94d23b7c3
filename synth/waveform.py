"""Draws a simulation trace (VCD) as a timing diagram: `python3 -m synth.waveform TRACE OUT SIGNAL ...`.

Each signal is drawn clock by clock, a word as a box with its value (binary32 as a decimal too).
"""

import pathlib
import re
import struct
import sys

from synth import drawing
from synth.drawing import plt


def read(text: str) -> dict[str, list[tuple[int, str]]]:
    """Signal -> its changes, (time, bits). Of several of one name, that of the outermost scope."""
    depth, codes = 0, {}
    for word, rest in re.findall(r"\$(scope|upscope|var)\s([^$]*)\$end", text):
        depth += {"scope": 1, "upscope": -1, "var": 0}[word]
        if word == "var":
            code, name = rest.split()[2:4]
            codes[name] = min(codes.get(name, (depth, code)), (depth, code))
    changes: dict[str, list[tuple[int, str]]] = {code: [] for _, code in codes.values()}
    now = 0
    for line in text[text.index("$enddefinitions"):].splitlines()[1:]:
        if line.startswith("#"):
            now = int(line[1:])
        elif match := re.fullmatch(r"b([01xz]+) (\S+)|([01xz])(\S+)", line):
            bits, code = match[1] or match[3], match[2] or match[4]
            if code in changes:
                changes[code].append((now, bits))
    return {name: changes[code] for name, (_, code) in codes.items()}


def at(changes: list[tuple[int, str]], time: int) -> str:
    """The bits of a signal at `time`."""
    return next((bits for when, bits in reversed(changes) if when <= time), "x")


def draw(trace: pathlib.Path, out: pathlib.Path, signals: list[str], clock: str = "clk_i") -> None:
    """One column a rising edge: the inputs that it took, and all else as it is after it.

    Raises KeyError for a signal that is not there.
    """
    changes = read(trace.read_text())
    edges = [when for when, bits in changes[clock] if bits == "1"]
    if not edges:
        raise ValueError(f"{trace}: {clock} never rises")
    figure, axes = plt.subplots(figsize=(1.15 * len(edges) + 2.5, 0.5 * len(signals) + 1),
                                layout="constrained")
    for row, signal in enumerate(signals):
        axes.text(-0.1, -row, signal, ha="right", va="center", fontsize=9, family="monospace")
        for column, edge in enumerate(edges):
            bits = at(changes[signal], edge)
            single = len(bits) == 1 and all(len(b) == 1 for _, b in changes[signal])
            if single:
                level = -row + (0.3 if bits == "1" else -0.3)
                axes.plot([column, column + 1], [level, level], color="black", lw=1.2)
            else:
                axes.add_patch(plt.Rectangle((column + 0.03, -row - 0.33), 0.94, 0.66, fill=False))
                value = int(bits.replace("x", "0").replace("z", "0"), 2)
                text = str(value) if value < 64 else (
                    f"{value:08X}\n{struct.unpack('>f', value.to_bytes(4, 'big'))[0]:.6g}")
                axes.text(column + 0.5, -row, text, ha="center", va="center", fontsize=6)
    for column in range(len(edges)):
        axes.text(column, 0.65, str(column + 1), ha="center", fontsize=8)
        axes.axvline(column, color="grey", lw=0.4, ls=":")
    axes.set(xlim=(-2.2, len(edges)), ylim=(-len(signals), 1))
    axes.axis("off")
    drawing.save(figure, out)


if __name__ == "__main__":
    draw(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), sys.argv[3:])
