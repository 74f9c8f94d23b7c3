"""The paper's claims, each beside what is measured here."""

import pathlib
import re
import subprocess

from host.lab.report import rows as kept


def _run(root: pathlib.Path, *command: str) -> str:
    """What a program of build/sim prints."""
    return subprocess.run([root / command[0], *command[1:]], cwd=root, capture_output=True,
                          text=True, check=True).stdout


def _found(pattern: str, text: str, form: str = "{}") -> str:
    match = re.search(pattern, text)
    if not match:
        raise ValueError(f"expected {pattern} in {text!r}")
    return form.format(*match.groups())


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


def table(root: pathlib.Path, rows: list[dict]) -> list[dict]:
    """Rows of claim, the paper's figure, the measured one, and the command that prints it."""
    table_1, example = "build/sim/table_1", "build/sim/worked_example"
    counted = _run(root, table_1)
    lines = [
        ("operations per test, general form", "18",
         _found(r"general(?:\s+\S+){3}\s+(\S+)", counted), table_1),
        ("operations per test, proposed form", "10",
         _found(r"proposed(?:\s+\S+){3}\s+(\S+)", counted), table_1),
        ("operations spared", "44.4 %", _found(r"([\d.]+) % fewer", counted, "{} %"), table_1),
        ("clocks per test", "7", _found(r"proposed ([\d.]+)\.\s*$", counted), table_1),
        ("clocks from first word to last", "10",
         _found(r"(\d+) clocks", _run(root, example)), example),
        ("worked example, quotients of 21 bits", "3DC873F8 3E31C2A0 3DB0D090",
         " ".join(bus_words(_run(root, example, "--paper-divider"))), f"{example} --paper-divider"),
        ("48-bit adders, full-adder delays: ripple, uniform, graded", "48, 14, 10",
         ", ".join(f"{delay:g}" for delay in adder_delays()) or "no Yosys", "make synth TOP=adders"),
    ]
    for variant, unit in (("serial", "the paper's unit"), ("binary32", "the pipelined unit")):
        for row in kept.of(rows, "pictures", section="lanes", lanes=1, variant=variant):
            clocks = row["clocks"]
            lines += [(f"hit tests of a frame, ms at 10 MHz, {unit}", "512", f"{clocks / 1e4:.1f}",
                       row["command"]),
                      (f"units for 18 frames/s, {unit}", "9 to 10", f"{18 * clocks / 1e7:.2f}",
                       row["command"])]
    return [{"table": "claims", "claim": claim, "paper": paper, "measured": measured,
             "command": command} for claim, paper, measured, command in lines]
