"""Area and delay of each variant's unit, as measured by `make synth`."""

import concurrent.futures
import contextlib
import functools
import json
import pathlib
import sys

from host.lab.rows import ROOT
from synth import brought, catalogue, measure as synth, tools

LIBRARY = "osu035"  # OSU 0.35 um, a process as old as the paper
FLOWS = ("parts", "small")  # the first available one is used
UNITS = {"pipeline": "hit_test_pipeline", "serial": "hit_test_unit"}
USUAL = {"ExpWidth": 8, "FracWidth": 23, "QuotientBits": 0, "RoundingMode": 0, "Arith": 0}
ROUNDINGS = ("nearest-even", "toward-zero", "down", "up", "nearest-away")  # in the order of fp_pkg


def _parameters(variant: dict) -> dict[str, int]:
    kind = variant.get("adder", "")
    adder = {"Arith": 1 if kind == catalogue.BEHAVIOURAL else catalogue.adder_kinds()[kind]} if kind else {}
    return {"ExpWidth": variant["exponent_bits"], "FracWidth": variant["digits"] - 1,
            "QuotientBits": variant["quotient_digits"],
            "RoundingMode": ROUNDINGS.index(variant["rounding"]), **adder}


def design(variant: dict) -> catalogue.Design:
    """Returns the design of the variant's unit."""
    return catalogue.design(UNITS[variant["unit"]], **{name: value for name, value in _parameters(variant).items() if value != USUAL[name]})


def measured(folder: str, rows: dict[str, catalogue.Row], workers: int) -> list[dict]:
    """Synthesises the designs of `rows` (by name) with the user's modules in `folder` or, if it is "", with hw/'s. Returns the results."""
    with brought.in_place(pathlib.Path(folder)) if folder else contextlib.nullcontext():
        failures: list[str] = []
        made = [{**record, "brought": folder} for _, records in synth.measure(list(rows.values()), synth.Targets((LIBRARY,), workers), failures)
                for record in records]
    print(*failures, sep="\n", end="\n" * bool(failures), file=sys.stderr)
    return made


def synthesis(variants: list[dict], workers: int, measure: bool) -> list[dict]:
    """Returns the results of `make synth` as rows. With `measure`, synthesises each variant's unit in its format first. Reports failures
    and missing tools on standard error."""
    file = ROOT / "build" / "synth" / "results.json"
    records = json.loads(file.read_text())["results"] if file.exists() else []
    if measure:
        designs = {variant["brought"]: {} for variant in variants}
        for variant in variants:
            if variant["hardware"]:
                designs[variant["brought"]][design(variant).name] = catalogue.Row("variants", design(variant), {LIBRARY: FLOWS[:1]})
        try:
            with concurrent.futures.ProcessPoolExecutor() as pool:  # user-supplied files are chosen per process
                for made in pool.map(functools.partial(measured, workers=-(-workers // len(designs))), *zip(*designs.items())):
                    records = made + records
        except (tools.MissingTool, tools.ToolFailed) as error:
            print(error, file=sys.stderr)
    return [{"table": "synthesis", **record} for record in records if record.get("target") == LIBRARY and "area" in record]


def _number(record: dict, name: str) -> int:
    text = str(record.get("parameters", {}).get(name, USUAL[name]))
    return int(text.rpartition("'")[2].lstrip("dh") or 0) if "'" in text else int(text)


def unit(records: list[dict], variant: dict) -> dict | None:
    """Returns the record of the variant's unit in its format, or None if synthesis has not measured it."""
    if variant["flush"] or variant["fused"]:
        return None  # not supported by the hardware
    wanted = {**USUAL, **_parameters(variant)}
    if variant["unit"] == "pipeline":
        wanted["QuotientBits"] = 0
    mine = [record for record in records if record["top"] == UNITS[variant["unit"]] and record["flow"] in FLOWS
            and record.get("brought", "") == variant.get("brought", "")
            and all(_number(record, name) == value for name, value in wanted.items())]
    return min(mine, key=lambda record: FLOWS.index(record["flow"]), default=None)
