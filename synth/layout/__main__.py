"""`python3 -m synth.layout`: see `--help`, or synth/README.md."""

import argparse
import dataclasses
import shutil
import sys

from synth import catalogue, chosen, runner, store, tables, tools, yosys
from synth.catalogue import Design, Library
from synth.layout import flow, parts, picture

OUT = store.OUT / "layouts"


@dataclasses.dataclass(frozen=True)
class Row:
    """A design of the table: laid out once for each seed, of which the median counts."""

    section: str
    design: Design
    how: str  # the flow
    density: float
    aspect: float
    seeds: int = 1
    routed: bool = True
    library: Library = catalogue.library("osu035")

    def jobs(self) -> list[flow.Job]:
        """One for each seed."""
        return [flow.Job(self.design, self.library, self.how, self.density, self.aspect, seed, self.routed)
                for seed in range(1, self.seeds + 1)]


SECTIONS = ("adders", "multipliers", "cores", "unit")


def section_rows(section: str, seeds: int = 3) -> list[Row]:
    """The rows of one of SECTIONS. `seeds`: of each adder; the others are large."""
    if section == "adders":
        return [Row(section, row.design, how, 1.0, 0.75, seeds) for row in catalogue.report_rows()
                if row.section == "48-bit adders"
                for how in ("cells", "fast") if how in row.flows["osu035"]]
    if section == "multipliers":
        graded = catalogue.design("booth_multiplier", "booth-graded-ripple-groups", "graded",
                                  look_ahead=False, Width=24)
        kinds = [catalogue.design("booth_multiplier", f"booth-{kind}", kind, Width=24)
                 for kind in ("ripple", "uniform", "prefix")]
        plain = catalogue.design("multiplier", "multiplier-behavioural", catalogue.BEHAVIOURAL, Width=24)
        return [Row(section, graded, "cells", *flow.SPARSE),
                *(Row(section, design, "fast", *flow.SPARSE) for design in (graded, *kinds, plain))]
    if section == "cores":
        small = catalogue.FORMATS["binary16"]
        tops = {"fp_adder": flow.SPARSE, "fp_multiplier": flow.SPARSER, "fp_divider": flow.SPARSE}
        return [*(Row(section, catalogue.design(top, f"{top.replace('_', '-')}-binary16", "graded",
                                                ExpWidth=small[0], FracWidth=small[1]), "modules", *flow.SPARSE)
                  for top in tops),
                *(Row(section, catalogue.design(top, top.replace("_", "-"), "graded"), "modules", *sparse)
                  for top, sparse in tops.items())]
    if section == "unit":  # whether qrouter routes 18,000 nets has not been tried
        return [Row(section, catalogue.design("hit_test_unit"), how, *flow.SPARSE, routed=False)
                for how in ("parts", "small")]
    raise ValueError(f"no section {section}; there are {', '.join(SECTIONS)}")


def arguments() -> argparse.Namespace:
    """The command line."""
    parser = argparse.ArgumentParser(prog="synth.layout", description=(
        "Places and routes netlists of make synth in OSU 0.35 um, or 0.18, times them with their wires and draws "
        "them; the report is build/synth/layouts/report-*.md."))
    parser.add_argument("--top", help=f"{', '.join(SECTIONS)}, or a module of hw/; all sections if none")
    chosen.add_arguments(parser)
    parser.add_argument("--targets", help="osu035 or osu018 (osu035)")
    parser.add_argument("--flow", help="of a module (see synth/README.md; fast)")
    parser.add_argument("--density", help="the share of the rows that cells of a module take (1)")
    parser.add_argument("--aspect", help="the core's height by its width, of a module (0.75)")
    parser.add_argument("--seeds", help="placements of each adder, of which the median counts (3)")
    parser.add_argument("--jobs", help="at once (2)")
    parser.add_argument("--publish", help="1: all sections, and writes table and pictures into synth/results, too")
    return chosen.parse(parser)


def wanted(given: argparse.Namespace) -> list[Row]:
    """The rows that the command line asks for."""
    library = {entry.name: entry for entry in catalogue.LIBRARIES}.get(given.targets or "osu035")
    if library is None:
        raise ValueError(f"no library {given.targets}, expected one of "
                         f"{', '.join(entry.name for entry in catalogue.LIBRARIES)}")
    _ = library.lef, library.liberty  # before anything is made, and first what only some libraries have
    return [dataclasses.replace(row, library=library) for row in _rows(given)]


def _rows(given: argparse.Namespace) -> list[Row]:
    seeds = int(given.seeds or 3)
    if given.top is None or given.top in SECTIONS:
        return [row for section in SECTIONS if given.top in (None, section)
                for row in section_rows(section, seeds)]
    flow_name, density, aspect = given.flow or "fast", float(given.density or 1), float(given.aspect or 0.75)
    if flow_name not in catalogue.FLOWS:
        raise ValueError(f"no flow {flow_name}, expected one of {', '.join(catalogue.FLOWS)}")
    if not 0 < density <= 1 or not 0 < aspect:
        raise ValueError(f"density {density:g} and aspect {aspect:g}, expected 0 < density <= 1 and 0 < aspect")
    return [Row(given.top, chosen.design(given), flow_name, density, aspect, int(given.seeds or 1))]


def measure(rows: list[Row], workers: int) -> tuple[list[dict], list[str]]:
    """Makes all layouts; one record for each row whose layouts were made, of the median seed."""
    all_jobs = [(row, job) for row in rows for job in row.jobs()]
    results, failures = runner.run_all([runner.Job(
        f"{job.design.name} {job.flow} seed {job.seed}", lambda j=job: flow.make(j), told)
        for _, job in all_jobs], workers)
    records = []
    for row in rows:
        mine = [(job, result) for (of, job), result in zip(all_jobs, results, strict=True)
                if of is row and result]
        routed = sorted(((job, result) for job, result in mine if result["failed"] == 0),
                        key=lambda pair: pair[1]["wires_ns"])
        if mine:
            job, result = routed[len(routed) // 2] if routed else mine[0]
            records.append({"section": row.section, "design": row.design.name, "flow": row.how,
                            "seed": job.seed, "job": job, **result,
                            "spread": [got["wires_ns"] for _, got in routed],
                            "failed": [got["failed"] for _, got in mine]})
    return records, failures


def told(result: dict) -> str:
    """A few words of a result."""
    if "wires_ns" in result:
        return f"{result['cells_ns']:.2f} ns, {result['wires_ns']:.2f} ns with wires"
    failed = "" if result["failed"] is None else f", {result['failed']} nets failed"
    return f"{result['cells_ns']:.2f} ns, {result['guess_ns']:.2f} ns with estimated wires{failed}"


def table(records: list[dict]) -> str:
    """Cells alone, with wires, their ratio, areas and wires; the wires are the estimate's where not all are routed."""
    rows = []
    for got in records:
        spread = got["spread"]
        delays = ["-", "-", "-", "-"]
        if spread:
            delays = [f"{min(spread):.2f}", f"{got['wires_ns']:.2f}", f"{max(spread):.2f}",
                      f"{got['wires_ns'] / got['cells_ns']:.3f}"]
        rows.append([got["design"], got["flow"], got["cells"], f"{got['area']:,}", f"{got['core']:,}",
                     f"{got['area'] / got['core']:.2f}", f"{got['wire_um'] / 1000:.1f}",
                     f"{got['wire_pf']:.2f}", f"{got['cells_ns']:.2f}", f"{got['guess_ns']:.2f}", *delays,
                     " ".join("not routed" if count is None else str(count) for count in got["failed"])])
    return tables.markdown(
        ["design", "flow", "cells", "cells, um2", "core, um2", "density", "wires, mm", "wires, pF",
         "cells alone, ns", "estimated wires, ns", "with wires, least", "median", "most", "median / alone", "nets failed"], rows)


def draw(records: list[dict]) -> list[str]:
    """The median layout of each row; the pictures' names."""
    names = []
    for got in records:
        job = got["job"]
        made = flow.load(job)
        name = f"{got['design']}-{job.library.name}-{got['flow']}"
        picture.draw(made, parts.of(job.design, made.netlist, flow.outputs(job.library)),
                     got["path"], f"{got['design']}, flow {got['flow']}, {job.library.title}"
                     + ("" if got["spread"] else ", wires estimated"), OUT / name)
        names.append(name)
    return names


def main() -> int:
    """1 where a layout fails, 2 for what the user can mend."""
    given = arguments()
    try:
        if given.publish and (given.top or given.targets):
            raise ValueError("PUBLISH=1: expected all layouts, without TOP and TARGETS")
        yosys.folder()
        for tool in ("sta", "coloquinte", "qrouter", "magic"):
            tools.find(tool)
        records, failures = measure(wanted(given), int(given.jobs or 2))
    except (tools.MissingTool, FileNotFoundError, ValueError) as error:
        print(f"layout: {error}", file=sys.stderr)
        return 2
    OUT.mkdir(parents=True, exist_ok=True)
    text = table(records)
    pictures = draw(records)
    report = OUT / f"report-{given.top or 'all'}-{given.targets or 'osu035'}.md"
    report.write_text("\n".join(
        ["# Layouts\n", text, *(f"![{name}]({name}.png)\n" for name in pictures)]))
    if given.publish:
        (tables.RESULTS / "layout.md").write_text(f"# Layouts\n\n{text}\n{tables.measured('make layout')}")
        for name in pictures:
            published = tables.RESULTS / f"layout-{name.replace('-osu035', '')}.png"
            if published.exists():  # of the others none is shown
                shutil.copy(OUT / f"{name}.png", published)
    print(text)
    print(f"Report: {report.relative_to(tools.ROOT)}")
    for failure in failures:
        print("failed:", failure, file=sys.stderr)
    return 1 if failures or any(any(got["failed"]) for got in records) else 0


if __name__ == "__main__":
    sys.exit(main())
