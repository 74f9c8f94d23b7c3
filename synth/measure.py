"""Measures designs on all targets and returns the results as flat records."""

import dataclasses
import functools
import sys
from collections.abc import Iterator

from synth import catalogue, fpga, mapping, runner, tools, yosys
from synth.catalogue import FPGAS, Library, Row


@dataclasses.dataclass(frozen=True)
class Targets:
    """The names of the libraries and FPGAs to measure on, and the number of parallel jobs."""

    names: tuple[str, ...]
    workers: int = 2


def available(names: list[str] | None, everything: bool = True, one: bool = False) -> tuple[str, ...]:
    """Returns the targets by the first rule that applies: 1. `names`; 2. the user's library; 3. `everything`: all libraries, and the FPGAs
    whose placers are installed; 4. `one` (a single module is measured): all libraries; 5. the first library.

    Raises MissingTool if a tool of a returned target is missing, and ValueError for an unknown name.
    """
    yosys.folder()
    known, libraries = catalogue.targets(), catalogue.LIBRARIES
    if unknown := set(names or []) - known.keys():
        raise ValueError(f"no target {', '.join(sorted(unknown))}; there are {', '.join(known)}")
    if not names and libraries[-1].file:
        names = [libraries[-1].name]
    chosen = names or [library.name for library in (libraries if everything or one else libraries[:1])]
    for device in FPGAS if everything and not names else ():
        if tools.installed(device.tool):
            chosen.append(device.name)
        else:
            print(f"no {device.title}: {device.tool} is not installed: {tools.TOOLS[device.tool][0]}", file=sys.stderr)
    for target in (known[name] for name in chosen):
        if isinstance(target, Library):
            tools.find("sta")
            _ = target.liberty
        else:
            tools.find(target.tool)
    return tuple(target for target in known if target in chosen)


def cost(record: dict | None) -> str:
    """Returns the text `area / ns` or `LUTs / MHz` for a record, "-" for None."""
    if record is None:
        return "-"
    if "mhz" in record:
        return f"{record['luts']:,} / {record['mhz']:.0f}"
    return f"{record['area']:,} / {record['delay_ns']:.2f}"


def measure(rows: list[Row], targets: Targets, failures: list[str], quiet: bool = False) -> Iterator[tuple[Row, list[dict]]]:
    """Yields each row with its records as soon as the row's jobs have ended: a record per target and flow that did not fail.

    `quiet`: prints no progress."""
    todo = [(row, target, flow) for row in rows for name, target in catalogue.targets().items() if name in targets.names
            for flow in row.flows_on(target)]
    results = runner.run([runner.Job(
        f"{row.design.name} {target.name} {flow}",
        functools.partial(mapping.synthesise, row.design, target, flow) if isinstance(target, Library) else
        functools.partial(fpga.place, row.design, target), None if quiet else cost) for row, target, flow in todo],
        targets.workers, failures)
    for row in rows:
        mine = [(target.name, flow) for of, target, flow in todo if of is row]
        yield row, [{"section": row.section, "design": row.design.name, "top": row.design.top, "parameters": dict(row.design.parameters),
                     "target": target, "flow": flow, **result}
                    for (target, flow), result in zip(mine, results) if result is not None]
