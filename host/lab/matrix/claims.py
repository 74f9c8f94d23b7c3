"""The paper's claims, each beside what is measured here."""

import pathlib
import re
import subprocess


def _run(root: pathlib.Path, *command: str) -> str:
    """What a program of build/sim prints; empty where it isn't built."""
    program = root / command[0]
    if not program.exists():
        return ""
    return subprocess.run([program, *command[1:]], cwd=root, capture_output=True, text=True,
                          check=True).stdout


def _found(pattern: str, text: str, form: str = "{}") -> str:
    match = re.search(pattern, text)
    return form.format(*match.groups()) if match else "not built"


def adder_delays() -> list[float]:
    """Full-adder delays of the 48-bit ripple, uniform and graded adders, on the elaborated netlists,
    under the counting that gives the paper's own figures (see synth/README.md); empty without Yosys."""
    from synth import catalogue, tools, unit_delay  # needs Yosys when called, not before
    adders = [("ripple", None), ("uniform", [4] * 12), ("graded", None)]
    try:
        designs = [catalogue.design("adder", "", kind, widths,
                                    None if kind == "ripple" else False, Width=48)
                   for kind, widths in adders]
        return [unit_delay.count(unit_delay.netlist(design), unit_delay.COUNTINGS[1])["delay"]
                for design in designs]
    except (tools.MissingTool, tools.ToolFailed):
        return []


def bus_words(text: str) -> list[str]:
    """The words on the output bus, from worked_example's table: the last of eight in a line."""
    lines = [re.findall(r"\b[0-9A-F]{8}\b", line) for line in text.splitlines()]
    return [words[-1] for words in lines if len(words) == 8]


def table(root: pathlib.Path, rows: list[dict]) -> list[list[str]]:
    """Rows of claim, the paper's figure, the measured one, and the command that prints it."""
    table_1 = _run(root, "build/sim/table_1")
    words = _run(root, "build/sim/worked_example", "--paper-divider")
    exact = _run(root, "build/sim/worked_example")
    delays = ", ".join(f"{delay:g}" for delay in adder_delays()) or "no Yosys"
    lines = [
        ["operations of a test, general form", "18",
         _found(r"general(?:\s+\S+){3}\s+(\S+)", table_1), "build/sim/table_1"],
        ["operations of a test, proposed form", "10",
         _found(r"proposed(?:\s+\S+){3}\s+(\S+)", table_1), "build/sim/table_1"],
        ["operations spared", "44.4 %", _found(r"([\d.]+) % fewer", table_1, "{} %"),
         "build/sim/table_1"],
        ["clocks a test", "7", _found(r"proposed ([\d.]+)\.\s*$", table_1), "build/sim/table_1"],
        ["clocks from first word to last", "10", _found(r"(\d+) clocks", exact),
         "build/sim/worked_example"],
        ["the worked example's words, 21-bit quotients", "3DC873F8 3E31C2A0 3DB0D090",
         " ".join(bus_words(words)) or "not built",
         "build/sim/worked_example --paper-divider"],
        ["48-bit adders, full-adder delays: ripple, uniform, graded", "48, 14, 10", delays,
         "make synth TOP=adders"],
    ]
    return lines + _frames(rows)


def _frames(rows: list[dict]) -> list[list[str]]:
    """The paper's frame: clocks, time at its 10 MHz, and units for its 18 frames a second."""
    lines = []
    for variant, title in (("serial", "the paper's unit"), ("binary32", "the pipelined unit")):
        row = next((row for row in rows if row["section"] == "lanes" and row["lanes"] == 1
                    and row["variant"] == variant), None)
        if row is None:
            continue
        clocks = row["clocks"]
        lines.append([f"hit tests of a frame of 320 x 200, 4 bounces, at 10 MHz, {title}", "512 ms",
                      f"{clocks / 1e4:.1f} ms ({clocks:,.0f} clocks)", row["command"]])
        lines.append([f"units for 18 such frames a second, {title}", "9 to 10",
                      f"{18 * clocks / 1e7:.2f}", row["command"]])
    return lines
