"""Tables and plots of a stress run; one of enough tests also renews the tables in README.md."""

import argparse
import json
import pathlib

import plots

# A run of all suites with so many tests in each may renew the README.
ENOUGH = 1_000_000
BEGIN, END = "<!-- begin of what `make stress` writes -->\n", "<!-- end of what `make stress` writes -->\n"

# Which rows of synthesis (see core_rows in synth/catalogue.py) make up a variant's arithmetic: what
# the names of multiplier, adder and divider end in, by the variant's name or else its significand.
CORES = ("fp-multiplier", "fp-adder", "fp-divider")
SUFFIXES = {"24": ("", "", ""), "16": ("-16-bits",) * 3, "12": ("-12-bits",) * 3,
            "truncate": ("-truncating",) * 3, "21-bit quotients": ("", "", "-21-bit-quotient")}
UNMEASURED = ("flush",)  # its cores are not written


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
    """Area and delay for each of SUFFIXES of which synthesis knows all three cores."""
    if file is None or not file.exists():
        return {}
    at = {(row["design"], row["target"], row["flow"]): row
          for row in json.loads(file.read_text())["results"]}
    known = {}
    for kind, suffixes in SUFFIXES.items():
        cores = [at.get((core + suffix, "osu035", "area"))
                 for core, suffix in zip(CORES, suffixes, strict=True)]
        if all(cores):
            known[kind] = (f"{sum(core['area'] for core in cores):,}",
                           f"{max(core['delay_ns'] for core in cores):.1f}")
    return known


def cost(variant: dict, known: dict[str, tuple[str, str]]) -> tuple[str, str]:
    name = variant["name"]
    kind = name if name in SUFFIXES else variant["significand"]
    return ("-", "-") if name in UNMEASURED else known.get(kind, ("-", "-"))


def variants_table(run: dict, known: dict[str, tuple[str, str]]) -> str:
    rows = []
    for variant in run["variants"]:
        t = variant["total"]
        area, delay = cost(variant, known)
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


def cells(errors: dict, form: str) -> str:
    return " / ".join(number(errors[key], form) for key in ("median", "p99", "max")) \
        if errors["count"] else "-"


def errors_table(run: dict, suite_name: str | None) -> str:
    """Median / p99 / max of one suite, or of all."""
    suite = next((s for s in run["suites"] if s["name"] == suite_name), None)
    rows = []
    for i, variant in enumerate(run["variants"]):
        t = suite["variants"][i] if suite else variant["total"]
        rows.append([variant["name"], cells(t["t_ulp"], ".3g"), cells(t["t_relative"], ".1e"),
                     cells(t["point_ulp"], ".3g"), cells(t["delivered_t_ulp"], ".4g"),
                     cells(t["delivered_point_ulp"], ".4g")])
    return table([f"{suite_name or 'all suites'}: median / p99 / max", "t, ulp", "t, relative",
                  "P, ulp", "delivered t, ulp", "delivered P, ulp"], rows)


def angles_table(run: dict) -> str:
    exact = [v for v in run["variants"] if v["exact"]]
    rows = []
    for decade in range(8):
        least = min(run["bounds"], key=lambda b: abs(b["sine"] - 10 ** -(decade + 1)))
        rows.append([f"1e-{decade + 1} to 1e-{decade}",
                     number(least["t_ulp"], ".3g"),
                     *(cells(v["total"]["t_ulp_by_angle"][decade], ".3g") for v in exact)])
    for what, key, errors in (("t", "t_of_bound", "t_ulp"), ("P", "point_of_bound", "point_ulp")):
        rows.append([f"largest part of its bound that {what} came to", "1",
                     *(number(v["total"][key], ".3f") if v["total"][errors]["count"] else "-"
                       for v in exact)])
    return table(["sine of the angle", "proven bound at the lower end",
                  *(v["name"] for v in exact)], rows)


def tables(run: dict, known: dict[str, tuple[str, str]]) -> str:
    about = "\n".join(f"* **{v['name']}**: {v['what']}" for v in run["variants"])
    suites = "\n".join(f"* **{s['name']}**: {s['what']}" for s in run["suites"])
    tests = {v["name"]: v["total"]["tests"] for v in run["variants"] if v["exact"]}
    seconds = sum(s["seconds"] for s in run["suites"])
    synthesis = "" if known else " (run `make synth` first: it has not measured them here)"
    return f"""**{"Passed" if run["passed"] else "FAILED"}**: {len(run["suites"])} suites{"" if run["complete"] else " (a part of them)"}, seed {run["seed"]},
{seconds:,.0f} s of processor time. Tests by {", ".join(f"{name}: {n:,}" for name, n in tests.items())}.
Broken claims (rays from inside that are not): {sum(s["broken_claims"] for s in run["suites"])}.

### Variants

{variants_table(run, known)}
Area and delay: multiplier, adder and divider of that significand, OSU 0.35 um, flow `area`{synthesis};
of truncate, cores that can do nothing else. A test takes 7 clocks in the paper's unit and 1 in the pipelined one, whatever the width.

{about}

### Wrong decisions per million tests

{suites_table(run)}
{suites}

### Rays from inside closed meshes: leaks / escapes among them / double hits per million

{closed_table(run)}
### Errors of t and P

{errors_table(run, "random")}
{errors_table(run, None)}
### Error of the unit's t by angle, sure hits: median / p99 / max, ulp

{angles_table(run)}"""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=pathlib.Path, help="with a run.json; the report goes there")
    parser.add_argument("--synth", type=pathlib.Path, help="results.json of `make synth`")
    parser.add_argument("--readme", type=pathlib.Path, help="renewed by a run of enough tests")
    options = parser.parse_args()
    run = json.loads((options.folder / "run.json").read_text())
    text = tables(run, costs(options.synth))
    plots.wrong_decisions(run, options.folder / "wrong.png")
    plots.error_by_angle(run, options.folder / "t_by_angle.png")
    (options.folder / "report.md").write_text(
        f"# Stress test\n\n{text}\n![wrong decisions](wrong.png)\n![error of t](t_by_angle.png)\n")
    if options.readme and run["tests"] >= ENOUGH and run["complete"]:
        old = options.readme.read_text()
        before, after = old.split(BEGIN)[0], old.split(END)[1]
        options.readme.write_text(f"{before}{BEGIN}\n{text}\n{END}{after}")
        print(f"Renewed: {options.readme}")


if __name__ == "__main__":
    main()
