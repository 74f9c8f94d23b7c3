"""`make variant`: compares one variant of arithmetic with binary32 on one card, from gates to image."""

import argparse
import json
import os
import pathlib
import sys

from host.lab.report import plots
from host.lab.report.document import number
from host.lab.rows import KEPT, ROOT, of, processors, scene_name
from host.lab.steps import Step
from host.lab.targets import bench, costs
from synth import brought, catalogue, report, store, tools

# The variants with which the program `lab` is built (host/lab/variants/CMakeLists.txt).
TABLE = KEPT / "variant.json"
# Options of make's command line: the column of variants.json, and its valid values.
WORDS = {"EXP_WIDTH": ("exponent_bits", range(3, 9)), "FRAC_WIDTH": ("digits", range(2, 24)),
         "QUOTIENT_BITS": ("quotient_digits", range(1, 25)), "ROUNDING": ("rounding", costs.ROUNDINGS),
         "UNIT": ("unit", tuple(costs.UNITS)), "ADDER": ("adder", None), **dict.fromkeys(("MULTIPLIER", "DIVIDER_ROW", "ROUNDER"), ("", ()))}
# Endings of files that replace a value: the file has a module to use in place of hw/'s.
FILES = (".sv", ".v")
# Rows of a card: name, value of a frame (targets/bench.py), format.
FIGURES = (("area, um2 in OSU 0.35 um", "area", ",.0f"), ("period, ns", "period_ns", ".2f"),
           ("clocks a frame", "clocks", ",.0f"), ("ms a frame", "frame_ms", ".3f"),
           ("wrong tests a million", "wrong", ".1f"), ("doubts a million", "doubtful", ".1f"),
           ("wrong rays", "decisions.wrong_rays", ",d"), ("P, ulp: median", "decisions.point_ulp.p50", ".3g"),
           ("P, ulp: 99 %", "decisions.point_ulp.p99", ".3g"), ("P, ulp: largest", "decisions.point_ulp.max", ".3g"),
           ("t, ulp: 99 %", "decisions.t_ulp.p99", ".3g"), ("RMSE", "rmse", ".3g"),
           ("FLIP", "flip", ".5f"))


def read_word(word: str) -> tuple[str, object]:
    """Returns the column and value of an option such as FRAC_WIDTH=15."""
    name, _, text = word.partition("=")
    if name not in WORDS:
        raise ValueError(f"{word}: expected one of {', '.join(WORDS)}")
    column, allowed = WORDS[name]
    if name == "ADDER":
        allowed = (*catalogue.adder_kinds(), catalogue.BEHAVIOURAL)
    value = int(text) if isinstance(allowed, range) and text.isdigit() else text.replace("_", "-")
    if value not in allowed:
        files = [f"a file ({', '.join(FILES)})"] * (name in brought.PLACES)
        known = f"{allowed[0]} to {allowed[-1]}" if isinstance(allowed, range) else ", ".join([*allowed, *files])
        raise ValueError(f"{word}: expected {known}")
    return column, value + 1 if name == "FRAC_WIDTH" else value  # the leading digit is not stored


def brought_files(words: list[str]) -> dict[str, str]:
    """Returns the files of user-supplied modules, by brought.PLACES."""
    return {name: text for name, _, text in (word.partition("=") for word in words) if name in brought.PLACES and text.endswith(FILES)}


def table(words: list[str]) -> list[dict]:
    """Returns rows as in variants.json: binary32; if the user's variant is serial, binary32 in the paper's unit; and the user's variant,
    which may also have an `adder`."""
    files = brought_files(words)
    mine: dict = dict(read_word(word) for word in words if word.partition("=")[0] not in files)
    if files:
        mine |= {"brought": str(brought.folder_of(files))} | ({"adder": "prefix"} if "ADDER" in files else {})
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
        mine["doubts"] = False  # no error bound is proven, so decisions of the unit are final
    parts = ["serial" if len(usual) > 1 else "", f"e{exponent_bits}p{digits}",
             f"q{mine.get('quotient_digits', '')}".removesuffix("q"), mine.get("rounding"), "" if "ADDER" in files else mine.get("adder"),
             *(pathlib.Path(name).stem for name in files.values())]
    return [*usual, {"variant": "-".join(part for part in parts if part), **mine}]


def prepare(words: list[str]) -> None:
    """Writes the table for the build. Leaves an unchanged table as it is, which avoids rebuilding."""
    text = json.dumps([{key: value for key, value in line.items() if key != "adder"} for line in table(words)], indent=1)
    if not TABLE.exists() or TABLE.read_text() != text:
        TABLE.parent.mkdir(parents=True, exist_ok=True)
        TABLE.write_text(text)


def judged(words: list[str]) -> list[dict]:
    """Returns the results of proofs of user-supplied modules, see brought.judge."""
    usual = {"unit": "pipeline", "exponent_bits": 8, "digits": 24, "quotient_digits": 0, "rounding": "nearest-even"}
    return brought.judge(brought_files(words), costs.design({**usual, **table(words)[-1]}))


def variants(given: argparse.Namespace) -> list[dict]:
    """Returns the rows of `lab variants`, each with its adder."""
    return [{**row, "adder": line.get("adder", "")} for row, line in zip(bench.variants(), table(given.variant), strict=True)]


def pictures(given: argparse.Namespace) -> list[Step]:
    """Returns the step that renders and audits the scene in each variant, and renders a small picture by the hardware to count clocks."""
    scene = pathlib.Path(given.scenes or "scenes/cornell.obj")
    return [Step("pictures", str(scene), ("pictures", scene, f"{bench.PICTURES}/card-{scene.stem}", "--integrator", "whitted", "--clocks"))]


PARTS = {
    "variants": lambda given: [Step("variants", "names", measure=lambda: variants(given))],
    "proofs": lambda given: [Step("proofs", "of modules brought along", measure=lambda: judged(given.variant))] if brought_files(given.variant) else [],
    "checks": lambda given: [Step("checks", "models against hardware", ("check", "--tests", 100_000))],
    "pictures": pictures,
    "synthesis": lambda given: [Step("synthesis", "area and clock", measure=lambda: costs.synthesis(
        variants(given)[-2:], processors(), measure=True))]}  # the two variants on the card
finish = bench.judge_pictures


def _value(frame: dict, path: str) -> float | None:
    for key in path.split("."):
        frame = frame.get(key) if isinstance(frame, dict) else None
    return frame


def figures(usual: dict, mine: dict) -> list[dict]:
    """Returns a row for each figure of a card: its values for `usual` and `mine` as text, or a dash, and their ratio."""
    found = []
    for name, path, form in FIGURES:
        numbers = [_value(usual, path), _value(mine, path)]
        if numbers[1] is not None:
            found.append({"figure": name, "ratio": numbers[1] / numbers[0] if numbers[0] else None,
                          **dict(zip(("usual", "mine"), (number(each, form) for each in numbers), strict=True))})
    return found


def values(rows: list[dict], folder: pathlib.Path) -> dict:
    """Returns frames of binary32 and the variant, the critical path, the folder of the synthesis run, and images."""
    frames = bench.frames(rows)
    usual, mine = frames[max(len(frames) - 2, 0)], frames[-1]
    record = costs.unit(of(rows, "synthesis"), of(rows, "variants")[-1])
    shown = [(usual["variant"], ROOT / f"{usual['picture']}.png"), (mine["variant"], ROOT / f"{mine['picture']}.png"),
             (f"FLIP {mine['flip']:.5f}", ROOT / mine["map"])]
    made = {"path": "", "run": ""}
    if record:
        run = (pathlib.Path(record["brought"], "synth") if record.get("brought") else store.OUT) / "runs" / (
            f"{record['design']}.{record['target']}.{record['flow']}")
        made = {"path": report.path_table(record), "run": os.path.relpath(run, folder)}
    return {"usual": usual, "mine": mine, "figures": figures(usual, mine),
            "pictures": plots.gallery(shown, folder / "pictures.png", 3), **made}


def own_folder(rows: list[dict]) -> str:
    """Returns the name of the card's folder."""
    return f"{of(rows, 'variants')[-1]['variant']}-{scene_name(of(rows, 'pictures')[0])}"


def failures(rows: list[dict]) -> list[str]:
    """Returns differences between model and hardware, refuted proofs, and failed synthesis."""
    missing = costs.unit(of(rows, "synthesis"), of(rows, "variants")[-1]) is None
    return ([f"{row['file']}: {row['counterexample']}" for row in of(rows, "proofs") if not row["holds"]]
            + [f"{row['variant']}: model and hardware differ: {row['difference'].split('; direction')[0]}"
               for row in of(rows, "checks") if row["difference"] != "none"]
            + ["the unit could not be synthesised"] * missing)


PAGE = """# {{ mine.variant }}

{{ usual.scene|capitalize }}, {{ usual.width }} x {{ usual.height }} pixels, integrator `whitted`, one sample per pixel.

{% if of("proofs") %}
{{ table(of("proofs"), "module = file", "claim", "by = how", "outcome = 'holds' if holds else 'REFUTED'", "s = seconds :.1f") }}
{% for row in of("proofs") if not row.holds %}
**{{ row.file }} is refuted.** {{ row.counterexample }}.

{% endfor %}
{% endif %}
{{ table(figures, "figure", usual.variant ~ " = usual :s", mine.variant ~ " = mine :s", "ratio = ratio :.3f") }}
Area and period: `make synth`, OSU 0.35 um, cells without wires. Clocks: simulation of this unit. Wrong: tests of camera rays that differ from exact arithmetic.
{% if mine.engine == "unit" %}
Picture and tests are computed by the Verilated unit with your modules.
{% endif %}
{% if of("checks")[-1].difference == "none" %}
Reference model and hardware returned the same words in {{ "{:,}".format(of("checks")[-1].tests) }} tests.
{% else %}
Reference model and hardware differ: {{ of("checks")[-1].difference.split("; direction")[0] }}.
{% endif %}

{{ figure(pictures, "The picture by " ~ usual.variant ~ ", by this variant, and their difference (FLIP; black: none).") }}
{% if path %}
## Critical path

{{ path }}
From [netlist]({{ run }}/netlist.v), [timing]({{ run }}/timing.txt), [log]({{ run }}/yosys.log).
{% endif %}
"""


@tools.command("error")
def main() -> int:
    """Parses the options, proves user-supplied modules and prepares the build. Returns 1 if a proof is refuted, 2 for invalid options."""
    keep_going = "--keep-going" in sys.argv
    words = [word for word in sys.argv[1:] if word != "--keep-going"]
    brought.bring(brought_files(words))
    refuted = [f"{row['file']}: {row['counterexample']}" for row in judged(words) if not row["holds"]]
    prepare(words)
    for text in refuted:
        print(f"{text}{'' if keep_going else '; KEEP_GOING=1 draws it all the same'}", file=sys.stderr)
    return 1 if refuted and not keep_going else 0


if __name__ == "__main__":
    sys.exit(main())
