"""Area, delay and energy of each variant's unit, from what `make synth` and `make layout TOP=energy` have measured.

A unit that synthesis has measured in the variant's format counts as it is. For others the cores
are added up: multiplier, adder and divider for the paper's unit, whose slowest path is a
multiplication and a division.
"""

import dataclasses
import json
import sys

from host.lab.rows import ROOT
from synth import catalogue

LIBRARY = "osu035"  # the paper's era
FLOWS = ("parts", "fast", "small")  # the first that there is
UNITS = {"pipeline": "hit_test_pipeline", "serial": "hit_test_unit"}
CORES = ("fp_multiplier", "fp_adder", "fp_divider")
USUAL = {"ExpWidth": 8, "FracWidth": 23, "QuotientBits": 0, "RoundingMode": 0, "Adder": 2,
         "Arith": 0}
ROUNDINGS = ("nearest-even", "toward-zero", "down", "up", "nearest-away")  # as in fp_pkg


@dataclasses.dataclass(frozen=True)
class Cost:
    """What a unit takes."""

    area: float  # the library's units
    period_ns: float


def _parameters(variant: dict) -> dict[str, int]:
    kind = variant.get("adder", "")
    adder = {"Arith": 1} if kind == catalogue.BEHAVIOURAL else {"Adder": catalogue.adder_kinds()[kind]} if kind else {}
    return {"ExpWidth": variant["exponent_bits"], "FracWidth": variant["digits"] - 1,
            "QuotientBits": variant["quotient_digits"],
            "RoundingMode": ROUNDINGS.index(variant["rounding"]), **adder}


def synthesis(variants: list[dict], workers: int, measure: bool) -> list[dict]:
    """Rows of what `make synth` has kept and, with `measure`, of each unit in each format of the
    variants. What fails, or is missing to synthesise with, is said on standard error."""
    file = ROOT / "build" / "synth" / "results.json"
    records = json.loads(file.read_text())["results"] if file.exists() else []
    if measure:
        from synth import measure as synth, tools
        designs = {}
        for variant in variants:
            if variant["hardware"]:
                changed = {name: value for name, value in _parameters(variant).items()
                           if value != USUAL[name]}
                design = catalogue.design(UNITS[variant["unit"]], **changed)
                designs[design.name] = catalogue.Row("variants", design, {LIBRARY: FLOWS[:1]})
        try:
            made, failures = synth.measure(list(designs.values()),
                                           synth.Targets((LIBRARY,), workers))
            records = made + records
            print("\n".join(failures), file=sys.stderr)
        except tools.MissingTool as error:
            print(error, file=sys.stderr)
    return [{"table": "synthesis", **record} for record in records
            if record.get("target") == LIBRARY and "area" in record]


def energies() -> list[dict]:
    """Rows of what `make layout TOP=energy` has kept: a core's operation in a format, pJ, and how many a test has."""
    file = ROOT / "build" / "synth" / "energies.json"
    kept = json.loads(file.read_text()) if file.exists() else {"results": []}
    return [{"table": "energy", **record, "a_test": kept["operations"][record["top"]]}
            for record in kept["results"]]


def energy(records: list[dict], variant: dict) -> float | None:
    """nJ that the cores take for a test of the paper's unit in the variant's format, where that is known."""
    if variant["unit"] != "serial" or variant["flush"] or variant["fused"] or variant["quotient_digits"]:
        return None
    mine = {record["top"]: record["pj"] * record["a_test"] for record in records
            if (record["exponent"], record["significand"]) == (variant["exponent_bits"], variant["digits"])}
    return sum(mine.values()) / 1000 if mine.keys() == set(CORES) else None


def _number(record: dict, name: str) -> int:
    text = str(record.get("parameters", {}).get(name, USUAL[name]))
    return int(text.rpartition("'")[2].lstrip("dh") or 0) if "'" in text else int(text)


def _find(records: list[dict], top: str, variant: dict, flow: str) -> dict | None:
    wanted = {**USUAL, **_parameters(variant)}
    if top not in ("fp_divider", UNITS["serial"]):
        wanted["QuotientBits"] = 0
    if top in CORES:
        del wanted["RoundingMode"]  # they take it as an input
    return next((record for record in records if record["top"] == top and record["flow"] == flow
                 and all(_number(record, name) == value for name, value in wanted.items())), None)


def unit(records: list[dict], variant: dict) -> dict | None:
    """The record of the variant's unit in its format, if synthesis has measured it."""
    if variant["flush"] or variant["fused"]:
        return None  # no such hardware
    found = (_find(records, UNITS[variant["unit"]], variant, flow) for flow in FLOWS)
    return next((record for record in found if record), None)


def cost(records: list[dict], variant: dict) -> Cost | None:
    """The variant's cost; None where synthesis does not know its format or design."""
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
