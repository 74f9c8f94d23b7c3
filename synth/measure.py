"""Measures designs on all targets: the jobs, and their results as flat records."""

import collections
import dataclasses
import sys
from collections.abc import Callable

from synth import fpga, mapping, runner, tools, yosys
from synth.catalogue import FPGAS, LIBRARIES, Row


@dataclasses.dataclass(frozen=True)
class Targets:
    """What is measured: names of libraries and FPGAs, and how many jobs at once."""

    names: tuple[str, ...]
    workers: int = 2


def available(names: list[str] | None, everything: bool = True, one: bool = False) -> tuple[str, ...]:
    """The targets asked for; else a user's library alone, or of `everything` all libraries and the FPGAs whose placers are
    installed, of `one` design all libraries, of the main designs the first.

    Raises MissingTool for a tool of a target that was asked for and for the standard-cell tools.
    """
    yosys.folder()
    known = {target.name: target for target in [*LIBRARIES, *FPGAS]}
    if unknown := set(names or []) - known.keys():
        raise ValueError(f"no target {', '.join(sorted(unknown))}; there are {', '.join(known)}")
    if not names and LIBRARIES[-1].file:
        names = [LIBRARIES[-1].name]
    chosen = names or [library.name for library in (LIBRARIES if everything or one else LIBRARIES[:1])]
    for device in FPGAS if everything and not names else ():
        if tools.installed(device.tool):
            chosen.append(device.name)
        else:
            print(f"no {device.title}: {device.tool} is not installed: {tools.TOOLS[device.tool][0]}", file=sys.stderr)
    for target in (known[name] for name in chosen):
        tools.find("sta" if target in LIBRARIES else target.tool)
        if target in LIBRARIES:
            _ = target.liberty
    return tuple(target for target in known if target in chosen)


def measure(rows: list[Row], targets: Targets, ended: Callable[[Row, list[dict]], None] | None = None,
            ) -> tuple[list[dict], list[str]]:
    """One record for each target and flow of each row; and the failures.

    `ended` is called with each row whose jobs have all ended, and its records, in place of lines of progress.
    """
    jobs: list[runner.Job] = []
    heads: list[tuple[Row, dict]] = []

    def add(row: Row, target: str, flow: str, work: Callable[[], tuple[dict, bool]], tell: Callable[[dict], str]) -> None:
        heads.append((row, {"section": row.section, "design": row.design.name, "top": row.design.top,
                            "parameters": dict(row.design.parameters), "target": target, "flow": flow}))
        jobs.append(runner.Job(f"{row.design.name} {target} {flow}", work, None if ended else tell))

    for row in rows:
        for library in LIBRARIES:
            for flow in row.flows_on(library) if library.name in targets.names else ():
                add(row, library.name, flow, lambda d=row.design, t=library, f=flow: mapping.synthesise(d, t, f),
                    lambda got: f"{got['area']:,} / {got['delay_ns']:.2f} ns")
        for device in FPGAS:
            if device.name in targets.names and device.name in row.flows:
                add(row, device.name, "placed", lambda d=row.design, t=device: fpga.place(d, t),
                    lambda got: f"{got['luts']} LUTs, {got['mhz']} MHz")
    found: dict[str, list[dict]] = {row.design.name: [] for row in rows}
    left = collections.Counter(row.design.name for row, _ in heads)

    def one_ended(place: int, result: dict | None) -> None:
        row, head = heads[place]
        found[row.design.name] += [{**head, **result}] if result else []
        left[row.design.name] -= 1
        if ended and left[row.design.name] == 0:
            ended(row, found[row.design.name])

    results, failures = runner.run_all(jobs, targets.workers, one_ended)
    return [{**head, **result} for (_, head), result in zip(heads, results, strict=True) if result is not None], failures
