"""Runs the proofs of proofs/units.toml, claims about the units and their modules. Arithmetic modules are replaced by contracts
(proofs/contracts): modules that have only the properties that the claim needs."""

import functools
import pathlib
import re
import tomllib

from synth import catalogue, cores
from synth.assertions import PROOFS, Proof, holds, opened

CHECKS = cores.HW.parent / "sim" / "checks"


def around(cells: list[str], contracts: list[str]) -> list[pathlib.Path]:
    """Returns the files of the modules `cells` and of all modules that they need. Modules in the files `contracts` replace those in hw/."""
    standing = [PROOFS / "contracts" / f"{name}.sv" for name in contracts]
    replaced = re.findall(r"^module (\w+)", "".join(file.read_text() for file in standing), re.M)
    folders = {file.parent.name for name in cells for file in catalogue.HW.glob(f"*/{name}.sv")} or {"ray_core"}
    rtl = dict.fromkeys(file for folder in sorted(folders) for file in cores.files(folder) if file.stem not in replaced)
    needed = {file for name in (*cells, *contracts) for file in cores.used(name, [*rtl, *standing])}
    return [file for file in (*rtl, *standing) if file in {*needed, *standing}]


def prove(name: str, row: dict) -> tuple[dict, bool]:
    """Proves one case of an entry of units.toml. `row`: the entry's values, overridden by those of the case. See assertions.holds."""
    parameters = {key: value for key, value in row.items() if key[0].isupper()}
    cells = row["cell"].split()
    prepare = None
    if "wires" in row:
        prepare = opened(cells[0], row["wires"], row.get("memories", "").format(**parameters), **row.get("opened", {}), **parameters)
    checks = [CHECKS / f"{file}.sv" for file in row.get("checks", ())]
    return holds(row["asserted"], "Bitwuzla", [*around(cells, row.get("contracts", [])), *checks], prepare, tuple(parameters.items()),
                 row.get("steps", 0), row.get("reach", 0), tuple(row.get("beside", ())), name)


def _all() -> list[Proof]:
    proofs = []
    for pattern, row in tomllib.loads((PROOFS / "units.toml").read_text()).items():
        for case in row.get("cases", [{}]):
            full = row | case
            name = pattern.format(**full)
            proofs.append(Proof(f"unit.{name}", row["claim"].format(**full), "Bitwuzla", functools.partial(prove, name, full),
                                full.get("quick", True), full.get("long", False)))
    return proofs


ALL = _all()
