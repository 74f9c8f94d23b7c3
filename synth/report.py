"""Writes the measured results: report.md for people, results.json and results.csv for programs."""

import itertools
import json
import platform

from synth import catalogue, measure, store, tables, tools, yosys
from synth.catalogue import FLOWS, FPGAS, Row


def title(target: str) -> str:
    """Returns the title of a target."""
    return catalogue.targets()[target].title


def groups() -> list[tuple[str, list[tuple[str, str]]]]:
    """Returns the tables of a section, one per library and one for all FPGAs: for each, its title, and (target, flow) of each column."""
    return [*((f"{library.title}: um2 / ns", [(library.name, flow) for flow in FLOWS]) for library in catalogue.LIBRARIES),
            ("LUTs / MHz", [(device.name, "placed") for device in FPGAS])]


def measured_tables(rows: list[Row], targets: measure.Targets) -> tuple[list[dict], list[str], str]:
    """Measures rows and prints their tables, each row as soon as it is measured. Returns records, failures and the tables."""
    records, failures, printed = [], [], []

    def say(text: str) -> None:
        printed.append(text)
        print(text, flush=True)

    known = catalogue.targets()
    for section, (kind, columns) in itertools.product(dict.fromkeys(row.section for row in rows), groups()):
        mine = [row for row in rows if row.section == section]
        measured = {(name, flow) for name in targets.names for row in mine for flow in row.flows_on(known[name])}
        columns = [column for column in columns if column in measured]
        if not columns:
            continue
        names = tuple(dict.fromkeys(name for name, _ in columns))
        mine = [row for row in mine if any(row.flows_on(known[name]) for name in names)]
        heads = [f"{section}, {kind}", *(title(name) if flow == "placed" else flow for name, flow in columns)]
        width = max(len(heads[0]), *(len(row.design.name) for row in mine))
        line = f"| {{:{width}}} |{' {:>20} |' * len(columns)}"
        say(line.format(*heads))
        say(f"|{'-' * (width + 2)}|" + "|".join(["-" * 21 + ":"] * len(columns)) + "|")
        for row, found in measure.measure(mine, measure.Targets(names, targets.workers), failures, quiet=True):
            at = {(record["target"], record["flow"]): record for record in found}
            say(line.format(row.design.name, *(measure.cost(at.get(column)) for column in columns)))
            records += found
        say("")
    return records, failures, "\n".join(printed)


def legend(records: list[dict]) -> str:
    """Returns the meaning of the tables' figures and flows, one per line."""
    flows = [flow for flow in FLOWS if any(record["flow"] == flow for record in records)]
    parts = ["um2 / ns: of the cells alone (NAND2X1: 96 in 0.35 um); the slowest path at the typical corner, before layout",
             "ns: paths that no operands sensitise count, too, so a carry-skip adder looks slower than it is"] if flows else []
    if any("mhz" in record for record in records):
        parts.append("LUTs / MHz: placed and routed between registers; the median of the seeds")
    return "\n".join([*parts, *(f"{flow}: {FLOWS[flow]}" for flow in flows)]) + "\n"


def path_table(record: dict) -> str:
    """Returns a table of a critical path, one row per cell: the delay of the cell with its load, from input to output pin."""
    rows = []
    for before, step in itertools.pairwise(record["path"]):
        (entered, _, came), (cell, _, pin) = before["pin"].rpartition("/"), step["pin"].rpartition("/")
        if cell == entered:
            rows.append([cell, step["cell"], f"{came} to {pin}", f"{step['delay']:.3f}", f"{step['arrival']:.3f}"])
    if (wait := record["delay_ns"] - record["path"][-1]["arrival"]) > 0.0005:
        rows.append(["", "", "set-up of the register or memory", f"{wait:.3f}", f"{record['delay_ns']:.3f}"])
    return tables.markdown(["instance", "cell", "through", "ns", "arrival, ns"], rows)


def blocks_table(record: dict) -> str:
    """Returns a table of the blocks of flow `blocks`: area and memory bits, the largest area first."""
    blocks = sorted(record["blocks"].items(), key=lambda item: -item[1]["area"])
    rows = [[name, f"{block['count']}", f"{block['area'] / 1e6:.2f}", f"{block['bits']:,}"] for name, block in blocks]
    rows.append([record["design"], "", f"{sum(block['area'] for _, block in blocks) / 1e6:.2f}",
                 f"{sum(block['bits'] for _, block in blocks):,}"])
    return tables.markdown(["block", "instances", "cells, mm2", "bits of memories, not in the area"], rows)


def versions() -> str:
    """Returns the tools and their versions as one line."""
    names = ["sta", *dict.fromkeys(device.tool for device in FPGAS)]
    stated = [f"{name} {tools.version(name)}" for name in names if tools.installed(name)]
    return ", ".join([f"yosys {yosys.version()}", *stated, f"Python {platform.python_version()}"])


def write(records: list[dict], measured: str, sections: list[tuple[str, str]], command: str, publish: bool = False) -> None:
    """Writes the three files. `measured`: the tables of measured_tables. `sections`: (title, Markdown) to append. `command`: the make
    command that measured. `publish`: also writes the CSV into results/."""
    store.OUT.mkdir(parents=True, exist_ok=True)
    parts = ["# What the arithmetic costs\n", f"Made by `make synth` with {versions()}.\n", legend(records).replace("\n", "\n\n"), measured,
             *(f"## {heading}\n\n{text}" for heading, text in sections)]
    (store.OUT / "report.md").write_text("\n".join([*parts, tables.measured(command)]))
    (store.OUT / "results.json").write_text(json.dumps({"tools": versions(), "results": records}, indent=1) + "\n")
    text = tables.comma_separated(records, ["section", "design", "target", "flow", "area", "delay_ns", "luts", "mhz"])
    (store.OUT / "results.csv").write_text(text)
    if publish:
        tables.publish("synth.csv", text, f"{command} PUBLISH=1")
