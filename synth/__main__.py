"""`python3 -m synth`: see `--help`, or synth/README.md."""

import argparse
import pathlib
import resource
import sys

from synth import brought, catalogue, chosen, cores, float_peers, grading, measure, prove, report, runner, store, structure, tables, tools


def arguments() -> argparse.Namespace:
    """Returns the parsed command line."""
    parser = argparse.ArgumentParser(prog="synth", description=(
        "Synthesises hw/ for standard cells and FPGAs. Without --top: the main designs, or everything, and a report "
        "in build/synth/. With it: one design, its area, delay, critical path and, for an adder, "
        "its unit delays and the proof that it adds."))
    parser.add_argument("--top", help="module of hw/ (adder, booth_multiplier, fp_adder, ...), or "
                        "adders: the adders' part of the report alone; float_peers: other people's float cores beside ours")
    chosen.add_arguments(parser)
    parser.add_argument("--liberty", help="a Liberty file, measured in place of other targets")
    parser.add_argument("--all", help="1: every design on every target; else the first ones, in osu035")
    parser.add_argument("--publish", help="1: with --all, writes results.csv into synth/results, too")
    parser.add_argument("--targets", help="osu035,osu018,ice40,ecp5; of one design its standard cells if not given")
    parser.add_argument("--jobs", type=chosen.whole(1, 1024), default=2, help="at once (%(default)s)")
    return chosen.parse(parser)


def run_one(design: catalogue.Design, targets: measure.Targets) -> int:
    """Measures one design and prints the results. An adder is proven first, and measured beside the other kinds of its width."""
    cells = design.top == "adder"
    flows = (("cells", "kept", "default", "fast") if cells else
             ("blocks",) if design.clock and design.folder in ("exact", "ray_core") else
             ("parts",) if design.clock and design.folder == "hit_test" else
             ("small", "parts") if design.clock else ("area", "small", "fast"))
    plan = dict.fromkeys(targets.names, catalogue.PLACED)
    plan |= {library.name: flows for library in catalogue.LIBRARIES if library.name in plan}
    designs, delays = [design], []
    if cells:
        try:
            prove.adds(design)
            print("Proof: it adds, for all operands (SAT).\n")
        except tools.Refuted as error:
            raise tools.ToolFailed(brought.in_words("ADDER", "proof that it adds", error.values)) from error
        width = dict(design.parameters).get("Width", grading.WIDTH)
        others = [catalogue.design("adder", adder=kind, look_ahead=False if kind in ("uniform", "graded") else None, Width=width)
                  for kind in ("ripple", "uniform", "graded", *(() if cores.replaced else ("prefix",)), catalogue.BEHAVIOURAL)]
        designs += [other for other in others if other.name != design.name]
    rows = []
    for one in designs:
        parts = structure.hardware(module := structure.netlist(one)) if cells else {}
        gates_only = not parts.get("full_adder") and not parts.get("multiplexer")
        rows.append(catalogue.Row(design.name, one, {target: tuple(flow for flow in how if flow != "cells" or not gates_only)
                                                     for target, how in plan.items()}))
        if cells and not parts["gate"]:  # full adders and multiplexers alone: the model applies
            delays.append([one.name, *(f"{structure.delay(module, counting):g}" for counting in structure.COUNTINGS)])
    records, failures, _ = report.measured_tables(rows, targets)
    print(report.legend(records))
    records = [record for record in records if record["design"] == design.name]
    for record in records:
        if "blocks" in record:
            print(report.blocks_table(record))
    timed = [record for record in records if "path" in record]
    if timed:
        best = min((record for record in timed if record["target"] == timed[0]["target"]), key=lambda record: record["delay_ns"])
        ends = f", from {best['from']} to {best['to']}" if "from" in best else ""
        print(f"Critical path, {report.title(best['target'])}, {best['flow']}{ends}:\n")
        print(report.path_table(best))
    if delays:
        print(tables.markdown(["full-adder delays", *(counting.title for counting in structure.COUNTINGS)], delays))
    return runner.status(failures)


def run_all(given: argparse.Namespace, targets: measure.Targets) -> int:
    """Measures the main designs, or with --all every design, prints the tables and writes the report."""
    rows = catalogue.report_rows() if given.all else catalogue.first_rows()
    if given.top == "adders":
        rows = [row for row in catalogue.report_rows() if row.design.top == "adder"]
    records, failures, measured = report.measured_tables(rows, targets)
    print(report.legend(records))
    sections = [("The paper's delay model", grading.model_table())] if given.top == "adders" or given.all else []
    for title, text in sections:
        print(f"{title}\n\n{text}")
    report.write(records, measured, sections, "make synth" + (f" TOP={given.top}" if given.top else " ALL=1" if given.all else ""), bool(given.publish))
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    print(f"Took {used.ru_utime + used.ru_stime:.0f} s of processor time. Report: "
          f"{(store.OUT / 'report.md').relative_to(tools.ROOT)}" + "; ALL=1 measures everything." * (not given.all and not given.top))
    return runner.status(failures)


@tools.command("synth")
def main() -> int:
    """Runs the command line."""
    given = arguments()
    if given.publish and (given.top or not given.all or given.liberty or given.targets):
        raise ValueError("PUBLISH=1: expected the whole report, ALL=1 without TOP, LIBERTY and TARGETS")
    with chosen.replaced(given):
        return run(given)


def run(given: argparse.Namespace) -> int:
    """Measures what the command line asks for."""
    one = chosen.design(given) if given.top and given.top not in ("adders", "float_peers") else None
    if given.liberty:
        catalogue.LIBRARIES.append(catalogue.of_user(pathlib.Path(given.liberty)))
    targets = measure.Targets(
        measure.available(given.targets.split(",") if given.targets else None, bool(given.all or given.top == "adders"), bool(one)),
        given.jobs)
    if one:
        return run_one(one, targets)
    if given.top == "float_peers":
        return float_peers.run([library for library in catalogue.LIBRARIES if library.name in targets.names])
    return run_all(given, targets)


if __name__ == "__main__":
    sys.exit(main())
