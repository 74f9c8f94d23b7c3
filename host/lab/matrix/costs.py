"""Area and delay of each variant's arithmetic, from what `make synth` has measured.

A unit that synthesis has measured in the variant's format counts as it is. For others the cores
are added up: multiplier, adder and divider for the paper's unit, whose slowest path is a
multiplication and a division.
"""

import dataclasses
import json
import pathlib

LIBRARY = "osu035"  # the paper's era
FLOWS = ("parts", "fast", "small")  # the first that there is
UNITS = {"pipeline": "hit_test_pipeline", "serial": "hit_test_unit"}
CORES = ("fp_multiplier", "fp_adder", "fp_divider")


@dataclasses.dataclass(frozen=True)
class Cost:
    """What a unit takes; `origin` says how that is known."""

    area: float  # the library's units
    period_ns: float
    origin: str


def read(file: pathlib.Path) -> list[dict]:
    """The records of a synthesis in LIBRARY, none if there was none."""
    records = json.loads(file.read_text())["results"] if file.exists() else []
    return [record for record in records if record.get("target") == LIBRARY]


def synthesise(variants: list[dict], workers: int) -> tuple[list[dict], list[str]]:
    """Records of each unit in each format of the variants, and what failed; kept between runs as
    `make synth` keeps them. Where Yosys, OpenSTA or the library is missing: no records."""
    from synth import catalogue, measure, tools
    rows = {}
    for variant in variants:
        parameters = {"ExpWidth": variant["exponent_bits"], "FracWidth": variant["digits"] - 1,
                      "QuotientBits": variant["quotient_digits"],
                      "RoundingMode": variant["rounding"]}
        usual = {"ExpWidth": 8, "FracWidth": 23, "QuotientBits": 0, "RoundingMode": 0}
        changed = {name: value for name, value in parameters.items() if value != usual[name]}
        if variant["hardware"]:
            design = catalogue.design(UNITS[variant["unit"]], **changed)
            rows[design.name] = catalogue.Row("variants", design, {LIBRARY: (FLOWS[0],)})
    try:
        return measure.measure(list(rows.values()), measure.Targets((LIBRARY,), workers))
    except tools.MissingTool as error:
        return [], [str(error)]


def _number(record: dict, name: str, default: int) -> int:
    text = str(record.get("parameters", {}).get(name, default))
    return int(text.rpartition("'")[2].lstrip("dh") or 0) if "'" in text else int(text)


def _find(records: list[dict], top: str, variant: dict, flow: str) -> dict | None:
    divides = top in ("fp_divider", UNITS["serial"])
    for record in records:
        if (record.get("top") == top and record.get("target") == LIBRARY
                and record.get("flow") == flow and "area" in record
                and _number(record, "ExpWidth", 8) == variant["exponent_bits"]
                and _number(record, "FracWidth", 23) == variant["digits"] - 1
                and _number(record, "QuotientBits", 0) == divides * variant["quotient_digits"]
                and (top in CORES or _number(record, "RoundingMode", 0) == variant["rounding"])
                and _number(record, "Adder", 2) == 2):
            return record
    return None


def cost(records: list[dict], variant: dict) -> Cost | None:
    """The variant's cost; None where synthesis does not know its format or design."""
    if variant["flush"] or variant["fused"]:
        return None  # no such hardware
    for flow in FLOWS:
        unit = _find(records, UNITS[variant["unit"]], variant, flow)
        if unit:
            return Cost(unit["area"], unit["delay_ns"], f"{unit['design']}, {flow}")
    for flow in FLOWS:
        cores = [_find(records, core, variant, flow) for core in CORES]
        if all(cores) and variant["unit"] == "serial":
            multiplier, _, divider = cores
            return Cost(sum(core["area"] for core in cores),
                        multiplier["delay_ns"] + divider["delay_ns"], f"its cores, {flow}")
    return None
