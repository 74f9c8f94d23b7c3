"""`make variant`: one variant of arithmetic on one card, from its gates to its picture, beside binary32's."""

import argparse
import json
import pathlib
import sys

from host.lab.bench import costs
from host.lab.machine import processors
from host.lab.report import plots
from host.lab.report.document import number
from host.lab.rows import KEPT, ROOT, of, read, write
from host.lab.steps import Step
from host.lab.targets import bench
from synth import catalogue, report, store

# The table that `lab` is built with: host/lab/variants/CMakeLists.txt.
TABLE = KEPT / "variant.json"
# The cards made so far, by name and scene.
CARDS = KEPT / "cards.jsonl"
# Words of make's command line: the column of variants.json, and what it may be.
WORDS = {"EXP_WIDTH": ("exponent_bits", range(3, 9)), "FRAC_WIDTH": ("digits", range(2, 24)),
         "QUOTIENT_BITS": ("quotient_digits", range(1, 25)), "ROUNDING": ("rounding", costs.ROUNDINGS),
         "UNIT": ("unit", tuple(costs.UNITS)), "ADDER": ("adder", None)}
# Lines of the card: name, value of a frame, format.
FIGURES = (("area, OSU 0.35 um units", "area", ",.0f"), ("period, ns", "period_ns", ".2f"),
           ("clocks a frame", "clocks", ",.0f"), ("ms a frame", "frame_ms", ".3f"), ("uJ a frame, cores", "energy_uj", ".3g"),
           ("wrong tests a million", "wrong", ".1f"), ("doubts a million", "doubtful", ".1f"),
           ("wrong rays", "decisions.wrong_rays", ",d"), ("P, ulp: median", "decisions.point_ulp.p50", ".3g"),
           ("P, ulp: 99 %", "decisions.point_ulp.p99", ".3g"), ("P, ulp: largest", "decisions.point_ulp.max", ".3g"),
           ("t, ulp: 99 %", "decisions.t_ulp.p99", ".3g"), ("RMSE", "rmse", ".3g"), ("SSIM", "ssim", ".4f"),
           ("FLIP", "flip", ".5f"))
# Points of the Pareto plots.
COSTS = {"area": "area, OSU 0.35 um units", "frame_ms": "ms per frame at the clock of synthesis"}
ERRORS = {"wrong": "wrong hit decisions per million tests", "point": "error of P, 99th percentile, ulp of binary32"}


def read_word(word: str) -> tuple[str, object]:
    """Column and value of a word like FRAC_WIDTH=15."""
    name, _, text = word.partition("=")
    if name not in WORDS:
        raise ValueError(f"{word}: expected one of {', '.join(WORDS)}")
    column, allowed = WORDS[name]
    if name == "ADDER":
        allowed = (*catalogue.adder_kinds(), catalogue.BEHAVIOURAL)
    value = int(text) if isinstance(allowed, range) and text.isdigit() else text.replace("_", "-")
    if value not in allowed:
        known = f"{allowed[0]} to {allowed[-1]}" if isinstance(allowed, range) else ", ".join(allowed)
        raise ValueError(f"{word}: expected {known}")
    return column, value + 1 if name == "FRAC_WIDTH" else value  # the leading digit is not stored


def table(words: list[str]) -> list[dict]:
    """Lines of variants.json: binary32's, that of binary32 in the same unit, and the one that the words describe, which
    may have an `adder`, too."""
    mine: dict = dict(map(read_word, words))
    exponent_bits, digits = mine.get("exponent_bits", 8), mine.get("digits", 24)
    if digits - 1 > 2 ** (exponent_bits - 1) or mine.get("quotient_digits", 0) > digits:
        raise ValueError(f"found {exponent_bits} exponent bits, {digits - 1} fraction bits and {mine.get('quotient_digits', 0)} "
                         "quotient bits, expected at most 2^(EXP_WIDTH - 1) fraction bits, no more quotient bits than digits")
    if mine.get("quotient_digits") and mine.setdefault("unit", "serial") != "serial":
        raise ValueError("QUOTIENT_BITS: expected UNIT=serial; the pipelined unit rounds its quotients")
    usual = [{"variant": "binary32"}]
    if mine.get("unit") == "serial":
        usual.append({"variant": "serial", "unit": "serial"})
    elif mine.get("rounding", "nearest-even") != "nearest-even" or digits < 11:
        mine["doubts"] = False  # no bound of its errors is proven: what the unit says is taken as it comes
    parts = ["serial" if len(usual) > 1 else "", f"e{exponent_bits}p{digits}",
             f"q{mine.get('quotient_digits', '')}".removesuffix("q"), mine.get("rounding"), mine.get("adder")]
    return [*usual, {"variant": "-".join(part for part in parts if part), **mine}]


def prepare(words: list[str]) -> None:
    """Writes the table that the build reads; not where it is the same, so that nothing is built again."""
    text = json.dumps([{key: value for key, value in line.items() if key != "adder"} for line in table(words)], indent=1)
    if not TABLE.exists() or TABLE.read_text() != text:
        TABLE.parent.mkdir(parents=True, exist_ok=True)
        TABLE.write_text(text)


def variants(given: argparse.Namespace) -> list[dict]:
    """The rows of `lab variants`, with the adder."""
    return [{**row, "adder": line.get("adder", "")}
            for row, line in zip(bench.variants(), table(given.variant), strict=True)]


def pictures(given: argparse.Namespace) -> list[Step]:
    """The scene by each variant's reference model, judged exactly, and in small by its hardware, for the clocks."""
    (ROOT / "build/bench/pictures").mkdir(parents=True, exist_ok=True)
    scene = str(pathlib.Path(given.scenes or "scenes/cornell.obj"))
    names = [row["variant"] for row in bench.variants()]
    stem = f"build/bench/pictures/card-{pathlib.Path(scene).stem}"
    file = KEPT / "runs-card.json"
    file.write_text(json.dumps(
        [{"section": "variants", "scene": scene, "width": 320, "height": 240, "integrator": "whitted", "audit": True,
          "variant": name, "engine": "model", "picture": f"{stem}-{name}", "against": f"{stem}-binary32"} for name in names]
        + [{"section": "variants", "scene": scene, "width": 80, "height": 60, "variant": name, "engine": "unit"}
           for name in names]))
    return [Step("pictures", scene, ("pictures", "--runs", file))]


PARTS = {
    "variants": lambda given: [Step("variants", "names", measure=lambda: variants(given))],
    "checks": lambda given: [Step("checks", "models against hardware", ("check", "--tests", 100_000))],
    "pictures": pictures,
    "synthesis": lambda given: [Step("synthesis", "area and clock", measure=lambda: costs.synthesis(
        variants(given), processors(), measure=True))],
    "energy": lambda given: [Step("energy", "of operations", measure=costs.energies)]}
finish = bench.judge_pictures


def kept_cards(mine: dict) -> list[dict]:
    """All cards of the same scene, this one new."""
    others = [card for card in (read(CARDS) if CARDS.exists() else [])
              if (card["variant"], card["scene"]) != (mine["variant"], mine["scene"])]
    write(CARDS, [*others, mine])
    return [*(card for card in others if card["scene"] == mine["scene"]), mine]


def figures(usual: dict, mine: dict) -> list[dict]:
    """Lines of the card: both values as text, a dash where there is none, and their ratio."""
    def value(frame: dict, path: str) -> float | None:
        for key in path.split("."):
            frame = frame.get(key) if isinstance(frame, dict) else None
        return frame

    found = []
    for name, path, form in FIGURES:
        numbers = [value(usual, path), value(mine, path)]
        if numbers[1] is not None:
            found.append({"figure": name, "ratio": numbers[1] / numbers[0] if numbers[0] else None,
                          **dict(zip(("usual", "mine"), (number(each, form) for each in numbers), strict=True))})
    return found


def values(rows: list[dict], folder: pathlib.Path) -> dict:
    """Frames of binary32 and the variant, its critical path and the files behind it, pictures, plots."""
    frames = bench.frames(rows)
    usual, mine = frames[max(len(frames) - 2, 0)], frames[-1]
    record = costs.unit(of(rows, "synthesis"), of(rows, "variants")[-1])
    shown = [(usual["variant"], ROOT / f"{usual['picture']}.png"), (mine["variant"], ROOT / f"{mine['picture']}.png"),
             (f"FLIP {mine['flip']:.5f}", ROOT / mine["map"])]
    cards = [{**frame, "name": frame["variant"]} for frame in [usual, *kept_cards(mine)]]
    plots_made = [(plots.pareto([{**card, "error": card[error]} for card in cards], COSTS, label,
                                f"{mine['scene']}: {label}", folder / f"pareto-{error}.png"), label)
                  for error, label in ERRORS.items() if all(card.get("area") for card in cards)]
    return {"usual": usual, "mine": mine, "figures": figures(usual, mine), "pareto": plots_made,
            "pictures": plots.gallery(shown, folder / "pictures.png", 3), "path": report.path_table(record) if record else "",
            "files": store.OUT.relative_to(ROOT) / "runs" / f"{record['design']}.{record['target']}.{record['flow']}"
            if record else ""}


def failures(rows: list[dict]) -> list[str]:
    """A model that is not its hardware; a unit that could not be synthesised."""
    missing = costs.unit(of(rows, "synthesis"), of(rows, "variants")[-1]) is None
    return bench.failures(rows) + ["the unit could not be synthesised"] * missing


if __name__ == "__main__":
    try:
        prepare(sys.argv[1:])
    except ValueError as error:
        sys.exit(print(f"error: {error}", file=sys.stderr) or 2)
