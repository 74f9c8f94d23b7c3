"""Writes what was measured: report.md for people, results.json and results.csv for programs."""

import json
import platform

from synth import store, tables, tools, yosys
from synth.catalogue import FLOWS, FPGAS, LIBRARIES

TITLES = {target.name: target.title for target in [*LIBRARIES, *FPGAS]}

CAVEATS = """\
Areas are square micrometres of the cells alone (the least NAND of two inputs: 96 in the 0.35 um library, 24 in the
0.18 um one, 3.75 in SkyWater's 130 nm). Delays are those of the slowest path at typical corner, in at an inverter of four times the
least, out into 0.1 pF (0.02 in 130 nm), with no layout and no wires: silicon is slower, and the order of two designs that
are close may change. iCE40 and ECP5 figures are placed and routed, between registers, the median of
several placements.
"""


def cost(record: dict | None) -> str:
    """`area / ns` or `LUTs / MHz`."""
    if record is None:
        return "-"
    if "mhz" in record:
        return f"{record['luts']:,} / {record['mhz']:.0f}"
    return f"{record['area']:,} / {record['delay_ns']:.2f}"


def section_tables(records: list[dict], section: str) -> str:
    """A table for each library (a column for each flow), and one for the FPGAs."""
    mine = [record for record in records if record["section"] == section]
    groups = [(f"{library.title}: um2 / ns", [(library.name, flow) for flow in FLOWS])
              for library in LIBRARIES]
    groups.append(("LUTs / MHz", [(device.name, "placed") for device in FPGAS]))
    return "\n".join(_table(mine, f"{section}, {title}", columns)
                     for title, columns in groups if any(
                         (record["target"], record["flow"]) in columns for record in mine))


def legend(records: list[dict]) -> str:
    """What the numbers and the flows of the tables are, a line each."""
    flows = [flow for flow in FLOWS if any(record["flow"] == flow for record in records)]
    parts = ["um2 / ns: of the cells alone; the slowest path at the typical corner, without wires"] if flows else []
    if any("mhz" in record for record in records):
        parts.append("LUTs / MHz: placed and routed between registers; the median of the seeds")
    return "\n".join([*parts, *(f"{flow}: {FLOWS[flow]}" for flow in flows)]) + "\n"


def _table(records: list[dict], title: str, columns: list[tuple[str, str]]) -> str:
    at = {(record["design"], record["target"], record["flow"]): record for record in records}
    columns = [column for column in columns if any(key[1:] == column for key in at)]
    designs = dict.fromkeys(record["design"] for record in records
                            if (record["target"], record["flow"]) in columns)
    heads = [flow if flow != "placed" else TITLES[target] for target, flow in columns]
    return tables.markdown([title, *heads], [
        [design, *(cost(at.get((design, *column))) for column in columns)] for design in designs])


def clock_table(records: list[dict]) -> str:
    """The clock rates of the designs that have a clock, and where their slowest paths run; without what FPGAs say."""
    return tables.markdown(["unit", "library", "flow", "MHz", "slowest path from", "to"], [
        [record["design"], TITLES[record["target"]], record["flow"],
         f"{1000 / record['delay_ns']:.1f}", record["from"], record["to"]]
        for record in records if "from" in record and "delay_ns" in record])


def corner_table(records: list[dict]) -> str:
    """The slowest path at each corner of the libraries that have several, ns; "" where there are none."""
    names = list(dict.fromkeys(name for record in records for name in record.get("corners_ns", {})))
    return tables.markdown(["design", "library", "flow", "typical, ns", *(f"{name}, ns" for name in names),
                            *(f"{name}, ratio" for name in names)], [
        [record["design"], TITLES[record["target"]], record["flow"], f"{record['delay_ns']:.2f}",
         *(f"{record['corners_ns'][name]:.2f}" for name in names),
         *(f"{record['corners_ns'][name] / record['delay_ns']:.2f}" for name in names)]
        for record in records if "corners_ns" in record])


def path_table(record: dict) -> str:
    """A critical path, cell by cell (output pins alone: what a cell and its load take)."""
    steps = [step for step in record["path"]]
    rows = []
    for i in range(0, len(steps)):
        step = steps[i]
        if i and step["pin"].rpartition("/")[0] == steps[i - 1]["pin"].rpartition("/")[0]:
            came = steps[i - 1]["pin"].rpartition("/")[2]
            cell, _, pin = step["pin"].rpartition("/")
            rows.append([cell, step["cell"], f"{came} to {pin}", f"{step['delay']:.3f}",
                         f"{step['arrival']:.3f}"])
    return tables.markdown(["instance", "cell", "through", "ns", "arrival, ns"], rows)


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


def write(records: list[dict], sections: list[tuple[str, str]]) -> None:
    """Writes the three files. `sections` are (title, Markdown) that follow the tables."""
    store.OUT.mkdir(parents=True, exist_ok=True)
    parts = ["# What the arithmetic costs\n", f"Made by `make synth` with {versions()}.\n", CAVEATS,
             "Flows: " + "; ".join(f"**{name}**: {text}" for name, text in FLOWS.items()) + ".\n"]
    for section in dict.fromkeys(record["section"] for record in records):
        parts += [f"## {section}\n", section_tables(records, section)]
    for title, text in sections:
        parts += [f"## {title}\n", text]
    (store.OUT / "report.md").write_text("\n".join(parts))
    (store.OUT / "results.json").write_text(
        json.dumps({"tools": versions(), "results": records}, indent=1) + "\n")
    columns = ["section", "design", "target", "flow", "area", "delay_ns", "luts", "mhz"]
    (store.OUT / "results.csv").write_text(tables.comma_separated(records, columns))
