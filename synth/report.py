"""Writes what was measured: report.md for people, results.json and results.csv for programs."""

import itertools
import json
import platform
import re
from collections.abc import Callable

from synth import measure, store, tables, tools, yosys
from synth.catalogue import FLOWS, FPGAS, LIBRARIES, Row


CAVEATS = """\
Areas are square micrometres of the cells alone (the smallest NAND of two inputs: 96 in the 0.35 um library, 24 in the
0.18 um one). Delays are those of the slowest path at the typical corner, before layout and without wires. Inputs come from an
inverter of four times the least drive, outputs drive 0.1 pF (eight inputs of the least inverter in a user's library).
Silicon is slower, and the order of two designs that are close may change. iCE40 and ECP5 figures are placed and routed,
between registers, the median of several placements.
"""


def title(target: str) -> str:
    """What a target is called."""
    return next(entry.title for entry in [*LIBRARIES, *FPGAS] if entry.name == target)


def cost(record: dict | None) -> str:
    """`area / ns` or `LUTs / MHz`."""
    if record is None:
        return "-"
    if "mhz" in record:
        return f"{record['luts']:,} / {record['mhz']:.0f}"
    return f"{record['area']:,} / {record['delay_ns']:.2f}"


def groups() -> list[tuple[str, list[tuple[str, str]]]]:
    """The tables of a section: what each is of, and the target and flow of each column. One for each library, one for the FPGAs."""
    return [*((f"{library.title}: um2 / ns", [(library.name, flow) for flow in FLOWS]) for library in LIBRARIES),
            ("LUTs / MHz", [(device.name, "placed") for device in FPGAS])]


def measured_tables(rows: list[Row], targets: measure.Targets) -> tuple[list[dict], list[str], str]:
    """Measures rows and prints their tables, each row as soon as it is measured. Returns records, failures and the tables."""
    records, failures, printed = [], [], []

    def say(text: str) -> None:
        printed.append(text)
        print(text, flush=True)

    for section, (title, columns) in itertools.product(dict.fromkeys(row.section for row in rows), groups()):
        names = tuple(name for name in targets.names if any(target == name for target, _ in columns))
        flows = {row.design.name: [(name, flow) for name in names for flow in _flows(row, name)] for row in rows
                 if row.section == section}
        mine = [row for row in rows if flows.get(row.design.name)]
        columns = [column for column in columns if any(column in found for found in flows.values())]
        if not mine or not columns:
            continue
        width = max(len(f"{section}, {title}"), *(len(row.design.name) for row in mine))

        def line(cells: list[str], width: int = width) -> None:
            say(f"| {cells[0]:{width}} | " + " | ".join(f"{cell:>20}" for cell in cells[1:]) + " |")

        def ended(row: Row, got: list[dict], columns: list = columns, line: Callable = line) -> None:
            at = {(record["target"], record["flow"]): record for record in got}
            line([row.design.name, *(cost(at.get(column)) for column in columns)])

        line([f"{section}, {title}", *(_head(column) for column in columns)])
        say(f"|{'-' * (width + 2)}|" + "|".join(["-" * 21 + ":"] * len(columns)) + "|")
        got, wrong = measure.measure(mine, measure.Targets(names, targets.workers), ended)
        records, failures = records + got, failures + wrong
        say("")
    return records, failures, "\n".join(printed)


def _flows(row: Row, target: str) -> tuple[str, ...]:
    """The flows of a row on a target."""
    return next((row.flows_on(library) for library in LIBRARIES if library.name == target), row.flows.get(target, ()))


def _head(column: tuple[str, str]) -> str:
    """What a column of a table is called."""
    return column[1] if column[1] != "placed" else title(column[0])


def legend(records: list[dict]) -> str:
    """What the numbers and the flows of the tables are, a line each."""
    flows = [flow for flow in FLOWS if any(record["flow"] == flow for record in records)]
    parts = ["um2 / ns: of the cells alone; the slowest path at the typical corner, without wires"] if flows else []
    if any("mhz" in record for record in records):
        parts.append("LUTs / MHz: placed and routed between registers; the median of the seeds")
    return "\n".join([*parts, *(f"{flow}: {FLOWS[flow]}" for flow in flows)]) + "\n"


def clock_table(records: list[dict]) -> str:
    """The clock rates of the designs that have a clock, and where their slowest paths run; without what FPGAs say."""
    return tables.markdown(["unit", "library", "flow", "MHz", "slowest path from", "to"], [
        [record["design"], title(record["target"]), record["flow"],
         f"{1000 / record['delay_ns']:.1f}", record["from"], record["to"]]
        for record in records if "from" in record and "delay_ns" in record])


def path_table(record: dict) -> str:
    """A critical path, cell by cell (output pins alone: what a cell and its load take)."""
    steps = [step for step in record["path"]]
    rows = []
    for i in range(len(steps)):
        step = steps[i]
        if i and step["pin"].rpartition("/")[0] == steps[i - 1]["pin"].rpartition("/")[0]:
            came = steps[i - 1]["pin"].rpartition("/")[2]
            cell, _, pin = step["pin"].rpartition("/")
            rows.append([cell, step["cell"], f"{came} to {pin}", f"{step['delay']:.3f}",
                         f"{step['arrival']:.3f}"])
    return tables.markdown(["instance", "cell", "through", "ns", "arrival, ns"], rows)


# What every cell of an adder is in.
PLAIN = re.compile(r"u_cell|u_full_adder|select|restore|gen_bit\[\d+\]|_\d+_")


def chain(record: dict) -> str:
    """A critical path on one line: its cells in order, with the instances that they are in, `*` for a number."""
    steps, words = record["path"], []
    for before, step in zip(steps, steps[1:]):
        cell, _, _ = step["pin"].rpartition("/")
        if cell and cell == before["pin"].rpartition("/")[0]:
            inside = [re.sub(r"\d+", "*", name) for name in cell.split(".") if not PLAIN.fullmatch(name)][-2:]
            words.append(step["cell"] + f" ({'.'.join(inside)})" * bool(inside))
    return (f"{record['design']}, {record['flow']}, {record['delay_ns']:.2f} ns: "
            f"{' > '.join([steps[0]['pin'], *counted(words), steps[-1]['pin']])}")


def counted(words: list[str]) -> list[str]:
    """The same with repeated words, and repeated pairs of words, as one and their number."""
    found, at = [], 0
    while at < len(words):
        size, times = 1, 1
        for size in (1, 2):
            unit, times = words[at:at + size], 1
            while words[at + times * size:at + (times + 1) * size] == unit:
                times += 1
            if times > 1:
                break
        if times == 1:
            size = 1
        text = " > ".join(words[at:at + size])
        found.append(text if times == 1 else f"{times} x {text}" if size == 1 else f"{times} x ({text})")
        at += size * times
    return found


def blocks_table(record: dict) -> str:
    """Area and memories of each block of flow `blocks`, the largest first."""
    blocks = sorted(record["blocks"].items(), key=lambda item: -item[1]["area"])
    rows = [[name, f"{block['count']}", f"{block['area'] / 1e6:.2f}", f"{block['bits']:,}"] for name, block in blocks]
    rows.append([record["design"], "", f"{sum(block['area'] for _, block in blocks) / 1e6:.2f}",
                 f"{sum(block['bits'] for _, block in blocks):,}"])
    return tables.markdown(["block", "instances", "cells, mm2", "bits of memories, not in the area"], rows)


def versions() -> str:
    """The tools and their versions, one line."""
    names = ["sta", *dict.fromkeys(device.tool for device in FPGAS)]
    stated = [f"{name} {tools.version(name)}" for name in names if tools.installed(name)]
    return ", ".join([f"yosys {yosys.version()}", *stated, f"Python {platform.python_version()}"])


def write(records: list[dict], measured: str, sections: list[tuple[str, str]], publish: bool = False) -> None:
    """Writes the three files; with `publish` the report and the CSV into results/, too. `measured`: of measured_tables; `sections`:
    (title, Markdown) that follow."""
    store.OUT.mkdir(parents=True, exist_ok=True)
    parts = ["# What the arithmetic costs\n", f"Made by `make synth` with {versions()}.\n", CAVEATS,
             "Flows: " + "; ".join(f"**{name}**: {text}" for name, text in FLOWS.items()) + ".\n", measured]
    for title, text in sections:
        parts += [f"## {title}\n", text]
    (store.OUT / "report.md").write_text("\n".join([*parts, tables.measured("make synth ALL=1")]))
    (store.OUT / "results.json").write_text(
        json.dumps({"tools": versions(), "results": records}, indent=1) + "\n")
    columns = ["section", "design", "target", "flow", "area", "delay_ns", "luts", "mhz"]
    (store.OUT / "results.csv").write_text(tables.comma_separated(records, columns))
    if publish:
        for name, published in (("report.md", "synth.md"), ("results.csv", "synth.csv")):
            (tables.RESULTS / published).write_text((store.OUT / name).read_text())
