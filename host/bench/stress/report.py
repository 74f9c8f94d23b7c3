"""Tables (Markdown) and plots of a stress run: report.py RUN.json FOLDER [SYNTH_RESULTS.json]."""

import json
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot as plt  # noqa: E402  (after the choice of its back end)

# Which rows of synthesis make up a variant's arithmetic: a suffix of the three cores' names.
CORES = ("fp-multiplier", "fp-adder", "fp-divider")
SUFFIXES = {"24": "-graded", "16": "-16-bits", "12": "-12-bits"}


def table(head: list[str], rows: list[list[str]]) -> str:
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" + "---:|" * (len(head) - 1)]
    lines += ["| " + " | ".join(row) + " |" for row in rows]
    return "\n".join(lines) + "\n"


def number(value: float | None, form: str) -> str:
    """JSON has no infinity: null stands for it."""
    return "infinite" if value is None else format(value, form)


def per_million(count: int, of: int) -> str:
    """A rate, 0 only where there was none."""
    if not of:
        return "-"
    rate = 1e6 * count / of
    return "0" if not count else f"{rate:,.0f}" if rate >= 10 else f"{rate:.2g}"


def costs(file: pathlib.Path | None) -> dict[str, tuple[str, str]]:
    """Area and delay for each significand width of which synthesis knows all three cores."""
    if file is None or not file.exists():
        return {}
    at = {(row["design"], row["target"], row["flow"]): row
          for row in json.loads(file.read_text())["results"]}
    known = {}
    for bits, suffix in SUFFIXES.items():
        cores = [at.get((core + suffix, "osu035", "small")) for core in CORES]
        if all(cores):
            known[bits] = (f"{sum(core['area'] for core in cores):,}",
                           f"{max(core['delay_ns'] for core in cores):.1f}")
    return known


def variants_table(run: dict, known: dict[str, tuple[str, str]]) -> str:
    rows = []
    for variant in run["variants"]:
        t = variant["total"]
        area, delay = known.get(variant["significand"], ("-", "-"))
        wrong = t["wrong"] + (t["wrong_ties"] if variant["exact"] else 0)
        nearest = t["wrong_nearest"] + (t["wrong_tied_nearest"] if variant["exact"] else 0)
        rows.append([variant["name"], f"{t['tests']:,}", f"{wrong:,}",
                     per_million(wrong, t["tests"]), f"{t['leaks']:,}", f"{t['escapes']:,}", f"{t['double_hits']:,}",
                     f"{nearest:,}", f"{100 * t['doubts'] / max(t['tests'], 1):.2f} %", area, delay])
    return table(["variant", "tests", "wrong", "wrong per million", "leaks", "of them escapes",
                  "double hits", "wrong nearest", "doubts", "cores, area", "slowest core, ns"], rows)


def suites_table(run: dict) -> str:
    """Wrong decisions per million tests."""
    rows = []
    for suite in run["suites"]:
        row = [suite["name"], f"{suite['variants'][0]['tests']:,}"]
        for variant, t in zip(run["variants"], suite["variants"], strict=True):
            wrong = t["wrong"] + (t["wrong_ties"] if variant["exact"] else 0)
            row.append(per_million(wrong, t["tests"]))
        rows.append(row)
    return table(["suite", "tests by the first", *(v["name"] for v in run["variants"])], rows)


def closed_table(run: dict) -> str:
    """Per million rays from inside closed meshes."""
    rows = []
    for suite in run["suites"]:
        if any(t["leaks"] or t["double_hits"] for t in suite["variants"]):
            rows.append([suite["name"], *(
                " / ".join(per_million(t[key], t["rays"])
                           for key in ("leaks", "escapes", "double_hits"))
                for t in suite["variants"])])
    return table(["suite", *(v["name"] for v in run["variants"])], rows)


def errors_table(run: dict) -> str:
    def cells(errors: dict, form: str) -> list[str]:
        return [number(errors[key], form) if errors["count"] else "-"
                for key in ("median", "p99", "max")]

    rows = []
    for suite_name in ("random", None):
        for i, variant in enumerate(run["variants"]):
            if suite_name is None:
                t = variant["total"]
            else:
                t = next((s["variants"][i] for s in run["suites"] if s["name"] == suite_name), None)
                if t is None:
                    continue
            rows.append([f"{variant['name']}, {suite_name or 'all suites'}",
                         *cells(t["t_ulp"], ".3g"), *cells(t["t_relative"], ".1e"),
                         *cells(t["point_ulp"], ".3g")])
    return table(["variant", *(f"{what} {key}" for what in ("t, ulp:", "t, relative:", "P, ulp:")
                               for key in ("median", "p99", "max"))], rows)


def angles_table(run: dict) -> str:
    exact = [v for v in run["variants"] if v["exact"]]
    rows = []
    for decade in range(8):
        row = [f"1e-{decade + 1} to 1e-{decade}"]
        for variant in exact:
            errors = variant["total"]["t_ulp_by_angle"][decade]
            row.append("-" if not errors["count"] else
                       " / ".join(number(errors[key], ".3g") for key in ("median", "p99", "max")))
        rows.append(row)
    rows.append(["largest part of the proven bound",
                 *(number(v["total"]["worst_of_bound"], ".3f") for v in exact)])
    return table(["sine of the angle", *(v["name"] for v in exact)], rows)


def plot_wrong(run: dict, file: pathlib.Path) -> None:
    suites = [suite["name"] for suite in run["suites"]]
    others = [(i, v["name"]) for i, v in enumerate(run["variants"]) if not v["exact"]]
    figure, axes = plt.subplots(figsize=(11, 6), layout="constrained")
    rates = [[100 * s["variants"][i]["wrong"] / max(s["variants"][i]["tests"], 1) for s in run["suites"]]
             for i, _ in others]
    image = axes.imshow(rates, aspect="auto", cmap="magma_r", vmin=0)
    axes.set_xticks(range(len(suites)), suites, rotation=60, ha="right")
    axes.set_yticks(range(len(others)), [name for _, name in others])
    axes.set_title("Wrong decisions, % of tests (the engines: 0 everywhere)")
    figure.colorbar(image)
    figure.savefig(file)
    plt.close(figure)


def plot_angles(run: dict, file: pathlib.Path) -> None:
    figure, axes = plt.subplots(figsize=(8, 5), layout="constrained")
    for variant in run["variants"]:
        points = [(10 ** -(d + 0.5), e["p99"])
                  for d, e in enumerate(variant["total"]["t_ulp_by_angle"])
                  if e["count"] > 100 and e["p99"] is not None]
        axes.loglog([x for x, _ in points], [y for _, y in points], marker="o", label=variant["name"])
    axes.set_xlabel("sine of the angle between ray and plane")
    axes.set_ylabel("error of t, 99th percentile, ulp")
    axes.legend(fontsize="small")
    axes.grid(True, alpha=0.3)
    figure.savefig(file)
    plt.close(figure)


def main() -> None:
    run = json.loads(pathlib.Path(sys.argv[1]).read_text())
    folder = pathlib.Path(sys.argv[2])
    known = costs(pathlib.Path(sys.argv[3]) if len(sys.argv) > 3 else None)
    folder.mkdir(parents=True, exist_ok=True)
    plot_wrong(run, folder / "wrong.svg")
    plot_angles(run, folder / "t_by_angle.svg")
    broken = sum(suite["broken_claims"] for suite in run["suites"])
    about = "\n".join(f"* **{v['name']}**: {v['what']}" for v in run["variants"])
    suites = "\n".join(f"* **{s['name']}**: {s['what']}" for s in run["suites"])
    (folder / "report.md").write_text(f"""# Stress test: {"passed" if run["passed"] else "FAILED"}

Seed {run["seed"]}, {len(run["suites"])} suites, {run["seconds"]:.0f} s. A test is one ray against one
triangle, judged by exact integers. Ties (the ray meets an edge exactly) count as wrong for the
engines alone: others may break them as they like. Broken claims (rays from inside, by the rule for
mirrored rays' origins, that are not): {broken}.

## Variants

{variants_table(run, known)}
Area and delay: multiplier, adder and divider of that significand, OSU 0.35 um, where synthesis has
measured them; a serial test takes 7 clocks whatever the width.

{about}

![wrong decisions](wrong.svg)

## Wrong decisions per million tests

{suites_table(run)}
{suites}

## Rays from inside closed meshes: leaks / escapes among them / double hits per million

A leak is an even number of hits, an escape none at all.

{closed_table(run)}
## Errors of t and P

{errors_table(run)}
## Error of t by angle: median / p99 / max, ulp

{angles_table(run)}
![error of t](t_by_angle.svg)
""")


if __name__ == "__main__":
    main()
