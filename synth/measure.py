"""Measures designs on all targets: the jobs, and their results as flat records."""

import dataclasses
import sys

from synth import fpga, mapping, runner, tools, yosys
from synth.catalogue import FPGAS, LIBRARIES, Row


@dataclasses.dataclass(frozen=True)
class Targets:
    """What is measured: names of libraries and FPGAs, and how many jobs at once."""

    names: tuple[str, ...]
    workers: int = 2


def available(names: list[str] | None, whole: bool = True) -> tuple[str, ...]:
    """The targets asked for, or all whose tools are installed.

    Raises MissingTool for one that was asked for and for the standard-cell tools; an FPGA whose
    placer is absent is left out of a run of everything. A run that is not `whole` leaves out FPGAs, which
    a large unit may not fit, and cells that would have to be measured first: both take longer than one design.
    """
    yosys.folder()
    chosen = []
    for library in LIBRARIES:
        if not names and not whole and not library.is_made:
            print(f"no {library.title}: its cells are not measured yet; TARGETS={library.name} does that first (half an "
                  "hour on one processor), `make cells` too", file=sys.stderr)
        elif not names or library.name in names:
            tools.find("sta")
            _ = library.liberty, library.corners
            chosen.append(library.name)
    for device in FPGAS if names or whole else ():
        if names and device.name in names:
            tools.find(device.tool)
        if not names and not tools.installed(device.tool):
            print(f"no {device.title}: {device.tool} is not installed: {tools.TOOLS[device.tool][0]}",
                  file=sys.stderr)
        elif not names or device.name in names:
            chosen.append(device.name)
    unknown = set(names or []) - set(chosen)
    if unknown:
        known = ", ".join(target.name for target in [*LIBRARIES, *FPGAS])
        raise ValueError(f"no target {', '.join(sorted(unknown))}; there are {known}")
    return tuple(chosen)


def measure(rows: list[Row], targets: Targets) -> tuple[list[dict], list[str]]:
    """One record for each target and flow of each row; and the failures."""
    jobs, heads = [], []
    for row in rows:
        design = row.design
        head = {"section": row.section, "design": design.name, "top": design.top,
                "parameters": dict(design.parameters)}
        for library in LIBRARIES:
            if library.name in targets.names:
                for flow in row.flows.get(library.name, ()):
                    heads.append({**head, "target": library.name, "flow": flow})
                    jobs.append(runner.Job(
                        f"{design.name} {library.name} {flow}",
                        lambda d=design, t=library, f=flow: mapping.synthesise(d, t, f),
                        lambda got: f"{got['area']:,} / {got['delay_ns']:.2f} ns"))
        for device in FPGAS:
            if device.name in targets.names and device.name in row.flows:
                heads.append({**head, "target": device.name, "flow": "placed"})
                jobs.append(runner.Job(
                    f"{design.name} {device.name}",
                    lambda d=design, t=device: fpga.place(d, t),
                    lambda got: f"{got['luts']} LUTs, {got['mhz']} MHz"))
    results, failures = runner.run_all(jobs, targets.workers)
    return [{**head, **result} for head, result in zip(heads, results, strict=True)
            if result is not None], failures
