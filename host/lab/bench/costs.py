"""Area, delay and energy of each variant's unit, as measured by `make synth` and `make layout TOP=energy`.

Uses the unit's own record if synthesis has measured it in the variant's format. Otherwise adds up the
cores: multiplier, adder and divider for the paper's unit, whose critical path is a multiplication and
a division.
"""

import concurrent.futures
import contextlib
import dataclasses
import functools
import json
import pathlib
import sys

from host.lab.rows import ROOT
from synth import brought, catalogue, measure as synth, tools
from synth.layout import energy as energy_of, flow as placement, formats, tests as operations
from synth.layout.jobs import SPARSE

LIBRARY = "osu035"  # of the paper's time
FLOWS = ("parts", "fast", "small")  # the first available one is used
UNITS = {"pipeline": "hit_test_pipeline", "serial": "hit_test_unit"}
CORES = ("fp_multiplier", "fp_adder", "fp_divider")
USUAL = {"ExpWidth": 8, "FracWidth": 23, "QuotientBits": 0, "RoundingMode": 0, "Arith": 0}
ROUNDINGS = ("nearest-even", "toward-zero", "down", "up", "nearest-away")  # as in fp_pkg


@dataclasses.dataclass(frozen=True)
class Cost:
    """The cost of a unit."""

    area: float  # in the library's unit
    period_ns: float


def _parameters(variant: dict) -> dict[str, int]:
    kind = variant.get("adder", "")
    adder = {"Arith": 1 if kind == catalogue.BEHAVIOURAL else catalogue.adder_kinds()[kind]} if kind else {}
    return {"ExpWidth": variant["exponent_bits"], "FracWidth": variant["digits"] - 1,
            "QuotientBits": variant["quotient_digits"],
            "RoundingMode": ROUNDINGS.index(variant["rounding"]), **adder}


def design(variant: dict) -> catalogue.Design:
    """Returns the design of the variant's unit."""
    return catalogue.design(UNITS[variant["unit"]], **{name: value for name, value in _parameters(variant).items()
                                                       if value != USUAL[name]})


def _kept_apart(variant: dict) -> contextlib.AbstractContextManager:
    """Returns a context in which synthesis reads the variant's user-supplied modules."""
    return brought.in_place(pathlib.Path(variant["brought"])) if variant["brought"] else contextlib.nullcontext()


def _measured(folder: str, rows: dict, workers: int, wires: bool) -> list[dict]:
    with _kept_apart({"brought": folder}):
        made, failures = synth.measure(list(rows.values()), synth.Targets((LIBRARY,), workers))
        for record in made if wires else ():
            placed = placement.Job(rows[record["design"]].design, catalogue.library(LIBRARY), FLOWS[0], *SPARSE, routed=False)
            record["wired_ns"] = placement.make(placed)[0]["guess_ns"]
    print("\n".join(failures), file=sys.stderr)
    return [{**record, "brought": folder} for record in made]


def synthesis(variants: list[dict], workers: int, measure: bool, wires: bool = False) -> list[dict]:
    """Returns rows of the results of `make synth` and, with `measure`, of each unit in each format of the variants.
    With `wires`, units are also placed: `wired_ns` is the period with the wires estimated by layout/estimate.py.
    Reports failures and missing tools on standard error."""
    file = ROOT / "build" / "synth" / "results.json"
    records = json.loads(file.read_text())["results"] if file.exists() else []
    if measure:
        designs = {variant["brought"]: {} for variant in variants}
        for variant in variants:
            if variant["hardware"]:
                designs[variant["brought"]][design(variant).name] = catalogue.Row("variants", design(variant), {LIBRARY: FLOWS[:1]})
        try:
            with concurrent.futures.ProcessPoolExecutor() as pool:  # the choice of files is per process
                for made in pool.map(functools.partial(_measured, workers=-(-workers // len(designs)), wires=wires), *zip(*designs.items())):
                    records = made + records
        except (tools.MissingTool, tools.ToolFailed) as error:
            print(error, file=sys.stderr)
    return [{"table": "synthesis", **record} for record in records
            if record.get("target") == LIBRARY and "area" in record]


def energies(variants: list[dict] | tuple = ()) -> list[dict]:
    """Returns rows of the results of `make layout TOP=energy`, and of the cores of these variants of the paper's unit:
    energy per operation in a format in pJ, and the number of operations per test."""
    file = ROOT / "build" / "synth" / "energies.json"
    found = json.loads(file.read_text())["results"] if file.exists() else []
    for variant in variants:
        if variant["unit"] == "serial" and variant["exponent_bits"] == 8:  # the only format that layout/tests.py supports
            usual = {name: value for name, value in _parameters(variant).items() if name not in ("RoundingMode", "QuotientBits")
                     and value != USUAL[name]}
            with _kept_apart(variant):
                found = [{"top": core, "exponent": variant["exponent_bits"], "significand": variant["digits"], "brought": variant["brought"],
                          **energy_of.of_cells(catalogue.design(core, **usual), catalogue.library(LIBRARY), formats.FLOW)[0]}
                         for core in CORES] + found
    return [{"table": "energy", **record, "a_test": operations.OPERATIONS[record["top"]]} for record in found]


def energy(records: list[dict], variant: dict) -> float | None:
    """Returns the energy in nJ of the cores for one test of the paper's unit in the variant's format, or None if
    unknown."""
    if variant["unit"] != "serial" or variant["flush"] or variant["fused"] or variant["quotient_digits"]:
        return None
    wanted = variant["exponent_bits"], variant["digits"], variant.get("brought", "")
    mine = {record["top"]: record["pj"] * record["a_test"] for record in records
            if (record["exponent"], record["significand"], record.get("brought", "")) == wanted}
    return sum(mine.values()) / 1000 if mine.keys() == set(CORES) else None


def _number(record: dict, name: str) -> int:
    text = str(record.get("parameters", {}).get(name, USUAL[name]))
    return int(text.rpartition("'")[2].lstrip("dh") or 0) if "'" in text else int(text)


def _find(records: list[dict], top: str, variant: dict, flow: str) -> dict | None:
    wanted = {**USUAL, **_parameters(variant)}
    if top not in ("fp_divider", UNITS["serial"]):
        wanted["QuotientBits"] = 0
    if top in CORES:
        del wanted["RoundingMode"]  # an input of the cores
    return next((record for record in records if record["top"] == top and record["flow"] == flow
                 and record.get("brought", "") == variant.get("brought", "")
                 and all(_number(record, name) == value for name, value in wanted.items())), None)


def unit(records: list[dict], variant: dict) -> dict | None:
    """Returns the record of the variant's unit in its format, or None if synthesis has not measured it."""
    if variant["flush"] or variant["fused"]:
        return None  # not supported by the hardware
    found = (_find(records, UNITS[variant["unit"]], variant, flow) for flow in FLOWS)
    return next((record for record in found if record), None)


def cost(records: list[dict], variant: dict) -> Cost | None:
    """Returns the variant's cost, or None if synthesis has not measured its format or design."""
    if variant["flush"] or variant["fused"]:
        return None
    record = unit(records, variant)
    if record:
        return Cost(record["area"], record["delay_ns"])
    for flow in FLOWS if variant["unit"] == "serial" else ():
        cores = [_find(records, core, variant, flow) for core in CORES]
        if all(cores):
            multiplier, _, divider = cores
            return Cost(sum(core["area"] for core in cores),
                        multiplier["delay_ns"] + divider["delay_ns"])
    return None
