"""The library of a corner: measured cell by cell, kept in build/synth/cells/, written as Liberty."""

import functools
import pathlib
import threading

from synth import runner, store, tools
from synth.cells import delays, extraction, flops, leakage, liberty, models, package
from synth.cells.catalogue import CELLS, CORNERS, Cell, Corner

FOLDER = store.OUT / "cells"
HERE = pathlib.Path(__file__).resolve().parent
_making = threading.Lock()


def corner(name: str) -> Corner:
    """The corner of that name."""
    return next(corner for corner in CORNERS if corner.name == name)


def measured(cell: Cell, at: Corner) -> tuple[dict, bool]:
    """Everything of a cell at a corner (delays.combinational or flops.flop, and "leakage"); whether it was kept."""
    return store.cached(_folder(cell, at), _key(cell, at), lambda: _measure(cell, at))


def _folder(cell: Cell, at: Corner) -> pathlib.Path:
    return FOLDER / f"{cell.name}.{at.name}"


def _key(cell: Cell, at: Corner) -> str:
    files = [package.cell(cell.name, "gds"), package.cell(cell.name, "spice"),
             *(package.device(name, at.process) for name in models.DEVICES),
             *(HERE / f"{name}.py" for name in ("models", "extraction", "ngspice", "delays", "flops", "leakage"))]
    return store.key(files, tools.version("ngspice"), package.klayout(), cell, at)


def _measure(cell: Cell, at: Corner) -> dict:
    circuit, folder = extraction.circuit(cell.name), _folder(cell, at)
    if cell.flop:
        return flops.flop(cell, circuit, at, folder)
    return {**delays.combinational(cell, circuit, at, folder), "leakage": leakage.leakage(cell, circuit, at, folder)}


def is_made(at: Corner) -> bool:
    """Whether all cells are measured at a corner; not where what measures them is missing."""
    try:
        return all(store.kept(_folder(cell, at), _key(cell, at)) is not None for cell in CELLS)
    except (tools.MissingTool, FileNotFoundError):
        return False


def _tell(got: dict) -> str:
    arc, i = got["arcs"][0], delays.MIDDLE
    return f"{arc['input']} to {arc['output']} {1000 * max(arc['cell_rise'][i][i], arc['cell_fall'][i][i]):.0f} ps"


def make(corners: list[Corner], workers: int) -> list[str]:
    """Measures what is not kept, and writes the libraries; returns what failed. MissingTool without ngspice or a package."""
    tools.find("ngspice")
    jobs = [runner.Job(f"{cell.name} {at.name}", lambda c=cell, a=at: measured(c, a), _tell)
            for at in corners for cell in CELLS if store.kept(_folder(cell, at), _key(cell, at)) is None]
    _, failures = runner.run_all(jobs, workers)
    for at in corners if not failures else ():
        store.replace(FOLDER / f"{at.name}.lib", liberty.library(at, [(cell, measured(cell, at)[0]) for cell in CELLS]))
    return failures


@functools.cache
def liberty_file(name: str) -> pathlib.Path:
    """The library of the corner `name`, measured where it is not up to date; ToolFailed where that failed."""
    with _making:
        failures = make([corner(name)], 2)
    if failures:
        raise tools.ToolFailed("\n".join(failures))
    return FOLDER / f"{name}.lib"
