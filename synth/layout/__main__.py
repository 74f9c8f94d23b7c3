"""`python3 -m synth.layout`: see `--help`, or synth/README.md."""

import argparse
import dataclasses
import functools
import sys

from PIL import Image

from synth import catalogue, chosen, runner, store, tables, tools, yosys
from synth.catalogue import Library
from synth.layout import flow, picture

OUT = store.OUT / "layouts"
SECTIONS = ("adders", "multipliers", "cores", "unit")


def of_seeds(job: flow.Job, seeds: int) -> list[flow.Job]:
    """Returns the jobs of one row of the table, one job per seed. The row shows the median of their delays."""
    return [dataclasses.replace(job, seed=seed) for seed in range(1, seeds + 1)]


def section_rows(section: str, library: Library, seeds: int = 3) -> list[list[flow.Job]]:
    """Returns the rows of one of SECTIONS. `seeds`: number of seeds per adder. The other designs are large and get one seed."""
    reported = catalogue.report_rows()
    designs = {row.design.name: row.design for row in reported}
    if section == "adders":
        return [of_seeds(flow.Job(row.design, library, how), seeds) for row in reported if row.section == "48-bit adders"
                for how in ("cells", "fast") if how in row.flows["osu035"]]
    if section == "multipliers":
        names = "booth-graded-ripple-groups", "booth-ripple", "booth-uniform", "booth-prefix", "multiplier-behavioural"
        rows = [(designs[name], how, flow.SPARSE) for name, how in ((names[0], "cells"), *((name, "fast") for name in names))]
    elif section == "cores":
        exponent, fraction = catalogue.FORMATS["binary16"]
        sparse = {"fp_adder": flow.SPARSE, "fp_multiplier": flow.SPARSER, "fp_divider": flow.SPARSE}
        small = [catalogue.design(top, f"{top.replace('_', '-')}-binary16", "graded", ExpWidth=exponent, FracWidth=fraction) for top in sparse]
        rows = [*((design, "modules", flow.SPARSE) for design in small),
                *((designs[top.replace("_", "-")], "modules", how) for top, how in sparse.items())]
    else:
        rows = [(designs["hit_test_unit"], how, flow.SPARSE) for how in ("parts", "small")]
    return [[flow.Job(design, library, how, *sparse, routed=section != "unit")] for design, how, sparse in rows]


def arguments() -> argparse.Namespace:
    """Returns the parsed command line."""
    parser = argparse.ArgumentParser(prog="synth.layout", description=(
        "Places and routes netlists of make synth in OSU 0.35 um, or 0.18, times them with their wires and draws "
        "them; the report is build/synth/layouts/report-*.md."))
    parser.add_argument("--top", help=f"{', '.join(SECTIONS)}, or a module of hw/; all sections if none")
    chosen.add_arguments(parser)
    parser.add_argument("--targets", choices=[library.name for library in catalogue.LIBRARIES], default="osu035", help="(%(default)s)")
    parser.add_argument("--flow", choices=catalogue.FLOWS, default="fast", help="of a module; see synth/README.md (%(default)s)")
    parser.add_argument("--density", type=float, default=1, help="the share of the rows that cells of a module take (%(default)s)")
    parser.add_argument("--aspect", type=float, default=0.75, help="the core's height by its width, of a module (%(default)s)")
    parser.add_argument("--seeds", type=chosen.whole(1, 1000), help="placements of each adder, of which the median counts (3)")
    parser.add_argument("--jobs", type=chosen.whole(1, 1024), default=2, help="at once (%(default)s)")
    parser.add_argument("--publish", help="1: all sections, and writes table and pictures into synth/results, too")
    return chosen.parse(parser)


def wanted(given: argparse.Namespace) -> list[list[flow.Job]]:
    """Returns the rows that the command line selects."""
    library = catalogue.library(given.targets)
    _ = library.lef, library.liberty  # raise early if a file is missing; .lef first, because only some libraries have it
    if not 0 < given.density <= 1 or not 0 < given.aspect:
        raise ValueError(f"density {given.density:g} and aspect {given.aspect:g}, expected 0 < density <= 1 and 0 < aspect")
    if given.top is None or given.top in SECTIONS:
        return [row for section in SECTIONS if given.top in (None, section) for row in section_rows(section, library, given.seeds or 3)]
    return [of_seeds(flow.Job(chosen.design(given), library, given.flow, given.density, given.aspect), given.seeds or 1)]


def measure(rows: list[list[flow.Job]], workers: int) -> tuple[list[dict], list[str]]:
    """Makes all layouts. Returns a record per row, of the seed with the median delay, and the failures. Omits rows without any layout."""
    failures: list[str] = []
    results = runner.run([runner.Job(f"{job.design.name} {job.flow} seed {job.seed}", functools.partial(flow.make, job), told)
                          for row in rows for job in row], workers, failures)
    records = []
    for row in rows:
        mine = [{"job": job, **result} for job, result in zip(row, results) if result]
        routed = sorted((got for got in mine if got["failed"] == 0), key=lambda got: got["wires_ns"])
        if mine:
            records.append({**(routed[len(routed) // 2] if routed else mine[0]), "spread": [got["wires_ns"] for got in routed],
                            "failed": [got["failed"] for got in mine]})
    return records, failures


def told(result: dict) -> str:
    """Returns a layout's delays in words, of the cells alone and with wires, and its number of failed nets."""
    if "wires_ns" in result:
        return f"{result['cells_ns']:.2f} ns, {result['wires_ns']:.2f} ns with wires"
    failed = "" if result["failed"] is None else f", {result['failed']} nets failed"
    return f"{result['cells_ns']:.2f} ns, {result['guess_ns']:.2f} ns with estimated wires{failed}"


HEADS = ["design", "flow", "cells", "cells, um2", "core, um2", "density", "wires, mm", "wires, pF", "cells alone, ns",
         "estimated wires, ns", "with wires, least", "median", "most", "median / alone", "nets failed"]


def table(records: list[dict]) -> list[list[object]]:
    """Returns the rows of the table, with columns HEADS. For a layout with unrouted nets, lengths and capacitances are estimates."""
    rows = []
    for got in records:
        spread = got["spread"]
        delays = [*(f"{ns:.2f}" for ns in (min(spread), got["wires_ns"], max(spread))),
                  f"{got['wires_ns'] / got['cells_ns']:.3f}"] if spread else ["-"] * 4
        rows.append([got["job"].design.name, got["job"].flow, got["cells"], f"{got['area']:,}", f"{got['core']:,}",
                     f"{got['area'] / got['core']:.2f}", f"{got['wire_um'] / 1000:.1f}", f"{got['wire_pf']:.2f}", f"{got['cells_ns']:.2f}",
                     f"{got['guess_ns']:.2f}", *delays,
                     " ".join("not routed" if count is None else str(count) for count in got["failed"])])
    return rows


def draw(got: dict) -> str:
    """Draws a layout; returns the picture's name."""
    job = got["job"]
    placement, wires = flow.load(job)
    name = f"{job.design.name}-{job.library.name}-{job.flow}"
    picture.draw(placement, wires, picture.parts_of(job.design, placement.netlist, flow.outputs(job.library)), got["path"],
                 f"{job.design.name}, flow {job.flow}, {job.library.title}" + ("" if got["spread"] else ", wires estimated"), OUT / name)
    return name


@tools.command("layout")
def main() -> int:
    """Runs the command line. Returns 1 if a layout fails, 2 for errors that the user can correct."""
    given = arguments()
    if given.publish and (given.top or given.targets != "osu035"):
        raise ValueError("PUBLISH=1: expected all layouts, without TOP and TARGETS")
    yosys.folder()
    for tool in ("sta", "coloquinte", "qrouter", "magic"):
        tools.find(tool)
    with chosen.replaced(given):
        records, failures = measure(wanted(given), given.jobs)
        OUT.mkdir(parents=True, exist_ok=True)
        rows, pictures = table(records), [draw(got) for got in records]
    report = OUT / f"report-{given.top or 'all' if given.top in (None, *SECTIONS) else chosen.design(given).name}-{given.targets}.md"
    text = tables.markdown(HEADS, rows)
    report.write_text("\n".join(["# Layouts\n", text, *(f"![{name}]({name}.png)\n" for name in pictures)]))
    if given.publish:
        for name, are_adders in (("adders", True), ("cores", False)):
            mine = [dict(zip(HEADS, (str(cell).replace(",", "") for cell in row))) for got, row in zip(records, rows)
                    if (got["job"].design.top == "adder") == are_adders]
            tables.publish(f"layout-{name}.csv", tables.comma_separated(mine, HEADS), "make layout PUBLISH=1")
        for name in pictures:
            published = tables.RESULTS / f"layout-{name.replace('-osu035', '')}.png"
            if published.exists():  # the other layouts have no published picture
                Image.open(OUT / f"{name}.png").convert("RGB").quantize(64).save(published, optimize=True)
    print(f"{text}\nReport: {report.relative_to(tools.ROOT)}" + (f", picture: {pictures[0]}.png" if len(pictures) == 1 else ""))
    return runner.status(failures) or any(any(got["failed"]) for got in records)


if __name__ == "__main__":
    sys.exit(main())
