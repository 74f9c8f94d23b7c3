"""Draws a simulation trace (VCD) as a timing diagram, by WaveDrom.

`python3 -m synth.waveform TRACE SAVE_FILE OUT`: OUT.json, WaveDrom's source, and OUT.svg. SAVE_FILE is
GTKWave's: it says which signals are drawn, how they are called and grouped.
"""

import argparse
import json
import pathlib
import re
import sys
from collections.abc import Callable


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


def at(changes: list[tuple[int, str]], time: int) -> str:
    """The bits of a signal at `time`."""
    return next((bits for when, bits in reversed(changes) if when <= time), "x")


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


def noise(changes: dict[str, list[tuple[int, str]]], edges: list[int]) -> set[str]:
    """What the paper's unit finds on its bus at edges that take no word: neither the first one nor those after it."""
    bus, valid, taken = (changes.get(f"top.hit_test_unit.{name}", []) for name in ("bus_i[31:0]", "valid_i", "word[2:0]"))
    return {at(bus, edge) for edge in edges if at(valid, edge) == "0" and set(at(taken, edge - 1)) == {"0"}}


def lane(name: str, changes: list[tuple[int, str]], edges: list[int], noise: set[str]) -> dict:
    """A signal as WaveDrom wants it, a column for each of `edges`: as it is right after that edge; crossed out where it holds
    `noise`."""
    wave, data, last = "", [], None
    for edge in edges:
        bits = at(changes, edge)
        if bits == last:
            wave += "."
        elif all(len(value) == 1 for _, value in changes):
            wave += bits
        elif bits in noise:
            wave += "x"
        else:
            wave += "="
            value = int(bits, 2)
            data.append(f"{value:08X}" if len(bits) == 32 else str(value))
        last = bits
    return {"name": name, "wave": wave, **({"data": data} if data else {})}


def diagram(trace: str, save_file: str) -> dict:
    """WaveDrom's source; raises KeyError for a signal that is not in the trace.

    The save file's first signal is the clock; a column is one of its rising edges, with the inputs that
    the edge took and all else as it is after it.
    """
    changes, chosen = read(trace), groups(save_file)
    (_, clock), *_ = chosen[0][1]
    edges = [when for when, bits in changes[clock] if bits == "1"]
    if not edges:
        raise ValueError(f"{clock} never rises")
    idle = noise(changes, edges)
    signal = [[group, *(lane(name, changes[signal], edges, idle) for name, signal in signals)]
              for group, signals in chosen]
    signal[0][1] = {"name": "clock", "wave": "p" + "." * (len(edges) - 1)}
    return {"signal": signal, "config": {"hscale": 2},
            "head": {"tock": 1, "text": "the worked example, clock edge by clock edge"}}


def render(source: pathlib.Path) -> str:
    """The SVG of WaveDrom's source in a file."""
    import wavedrom  # installed for tests and for synthesis alone

    # It measures words in Helvetica: the fonts that stand in for that are up to a third wider.
    drawn = wavedrom.render(source.read_text()).tostring()
    return drawn.replace("text{font-size:11pt;", "text{font-size:8pt;") + "\n"


def draw(trace: pathlib.Path, save_file: pathlib.Path, out: pathlib.Path) -> None:
    """Writes OUT.json and OUT.svg."""
    source = out.with_suffix(".json")
    text = json.dumps(diagram(trace.read_text(), save_file.read_text()), indent=1)
    source.write_text(re.sub(r"\{\s*(\"name\"[^{}]*?)\s*\}",  # a signal a line
                             lambda found: "{" + re.sub(r"\s*\n\s*", " ", found[1]) + "}", text) + "\n")
    out.with_suffix(".svg").write_text(render(source))


def main(prog: str, described: str, drawn: Callable[[pathlib.Path, pathlib.Path, pathlib.Path], None]) -> int:
    """The command line of what draws a trace by a save file; 2 for what the user can mend."""
    parser = argparse.ArgumentParser(prog=prog, description=described)
    for name in ("trace", "save_file", "out"):
        parser.add_argument(name, metavar=name.upper(), type=pathlib.Path)
    given = parser.parse_args()
    try:
        drawn(given.trace, given.save_file, given.out)
    except OSError as error:
        print(f"{prog}: {error.filename}: {error.strerror}", file=sys.stderr)
        return 2
    except (ValueError, KeyError) as error:
        print(f"{prog}: found in {given.trace}, or in {given.save_file}: {error}; expected a value change dump, "
              "and GTKWave's save file of its signals", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main("synth.waveform", "Draws a trace (VCD) as a timing diagram, OUT.json and OUT.svg.", draw))
