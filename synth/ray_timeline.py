"""Draws a trace of one ray in the ray core (VCD): when each part has something of it.

`python3 -m synth.ray_timeline TRACE SAVE_FILE OUT.svg`. TRACE is what `make lecture PIXEL=64,64` writes. SAVE_FILE is GTKWave's: its
first signal is the clock, each other one a row, with a bar where it is not zero.
"""

import pathlib
import re
import sys

from synth.drawing import plt

COLOURS = ("tab:blue", "tab:green", "tab:orange", "tab:red", "tab:purple")


def read(text: str) -> dict[str, list[tuple[int, str]]]:
    """Signal, by its full name -> its changes, (time, bits)."""
    scopes, codes = [], {}
    for word, rest in re.findall(r"\$(scope|upscope|var) (.*?) ?\$end", text):
        if word == "scope":
            scopes.append(rest.split()[1])
        elif word == "upscope":
            scopes.pop()
        else:
            codes[".".join([*scopes, "".join(rest.split()[3:])])] = rest.split()[2]
    changes: dict[str, list[tuple[int, str]]] = {code: [] for code in codes.values()}
    now = 0
    for line in text[text.index("$enddefinitions"):].splitlines()[1:]:
        if line.startswith("#"):
            now = int(line[1:])
        elif match := re.fullmatch(r"b([01xz]+) (\S+)|([01xz])(\S+)", line):
            changes[match[2] or match[4]].append((now, match[1] or match[3]))
    return {name: changes[code] for name, code in codes.items()}


def groups(save_file: str) -> list[tuple[str, list[tuple[str, str]]]]:
    """The groups of a save file: their names, and (name, signal) of what is in them."""
    found: list[tuple[str, list[tuple[str, str]]]] = []
    for flags, group, name, signal in re.findall(
            r"^@(\w+)\n(?:-(.*)|\+\{(.*)\} (\S+))$", save_file, re.M):
        if signal:
            found[-1][1].append((name, signal))
        elif int(flags, 16) & 0x800000:  # where a group begins
            found.append((group, []))
    return found


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
    changes, chosen = read(trace), groups(save_file)
    (_, clock), *_ = chosen[0][1]
    edges = [when for when, bits in changes[clock] if bits == "1"]
    rows = [(place, name, bars(changes[signal], edges)) for place, (_, signals) in enumerate(chosen)
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


def main() -> int:
    """The command line; 2 for what the user can mend."""
    if len(sys.argv) != 4:
        print("usage: synth.ray_timeline TRACE SAVE_FILE OUT.svg", file=sys.stderr)
        return 2
    trace, save_file, out = map(pathlib.Path, sys.argv[1:])
    try:
        draw(trace.read_text(), save_file.read_text(), out)
    except OSError as error:
        print(f"synth.ray_timeline: {error.filename}: {error.strerror}", file=sys.stderr)
        return 2
    except (ValueError, KeyError) as error:
        print(f"synth.ray_timeline: found in {trace}, or in {save_file}: {error}; expected a value change dump, "
              "and GTKWave's save file of its signals", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
