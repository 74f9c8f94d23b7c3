"""`make stress`: every engine and variant of arithmetic on suites of hard cases, checked by exact integers."""

import argparse
import collections
import math
import pathlib
import subprocess

from host.lab.report import plots
from host.lab.rows import grouped, of
from host.lab.steps import LAB, Step

# Minimum number of tests per suite of a published report.
ENOUGH = 1_000_000
COUNTS = ("tests", "rays", "refused", "wrong", "wrong_ties", "escapes", "double_hits",
          "wrong_nearest", "wrong_tied_nearest", "orders", "wrong_order", "doubts")
ERRORS = ("t_ulp", "t_relative", "point_ulp", "delivered_t_ulp", "delivered_point_ulp")
LARGEST = ("t_of_bound", "point_of_bound", "point_of_said")
# Kinds of wrong results per ray, reported separately.
KINDS = ("escapes", "double_hits", "wrong_nearest")


def steps(part: str, given: argparse.Namespace, tests: int, *words: object) -> list[Step]:
    """Returns a step for each suite. Raises ValueError if there are too few tests to publish."""
    tests = given.tests or (20_000 if given.quick else tests)
    if given.publish and tests < ENOUGH:
        raise ValueError(f"found {tests:,} tests in each suite, expected {ENOUGH:,} to publish")
    suites = subprocess.run([LAB, "stress", "--list"], stdout=subprocess.PIPE, text=True, check=True).stdout.splitlines()
    return [Step(part, suite, ("stress", "--suite", suite, "--tests", tests, "--seed", given.seed, "--threads", 1, *words))
            for suite in suites]


def watertight(given: argparse.Namespace) -> Step:
    """Returns the step of the public tests of watertightness."""
    return Step("all", "watertight", ("watertight", *(("--triangles", 4096, "--seeds", 1) if given.quick else ())))


# Half a million tests per suite on the core's reference model, 50,000 on the simulated hardware.
PARTS = {"all": lambda given: [*steps("all", given, 10_000_000), watertight(given)],
         "core": lambda given: steps("core", given, 2_500_000, "--subject", "model core", "rtl core",
                                     "model exact core", "rtl exact core")}
USUAL = ("all",)


def summary(binned: list[dict]) -> dict:
    """Returns median, 99th percentile and largest of errors that `lab stress` has counted in bins.

    Quantiles are rounded up to the end of their bins, by at most 1/64; JSON's null is infinity.
    """
    counts: collections.Counter = collections.Counter()
    largest = 0.0
    for errors in binned:
        counts.update(dict(map(tuple, errors["bins"])))
        largest = max(largest, math.inf if errors["max"] is None else errors["max"])
    total = sum(counts.values())
    if not total:
        return {"count": 0, "median": None, "p99": None, "max": None}

    def quantile(rank: int) -> float:
        """Returns the error with `rank` smaller ones."""
        seen = 0
        for end in sorted(counts):
            seen += counts[end]
            if seen > rank:
                return largest if end > 2.0**64 else min(end, largest)
        raise AssertionError("rank beyond the errors")

    return {"count": total, "median": quantile((total - 1) // 2),
            "p99": quantile((total - 1) - (total - 1) // 100), "max": largest}


def total(rows: list[dict]) -> dict:
    """Returns the sum of a subject's rows over all suites."""
    return {**rows[0], **{key: sum(row[key] for row in rows) for key in COUNTS},
            **{key: max(row[key] for row in rows) for key in LARGEST},
            **{key: summary([row[key] for row in rows]) for key in ERRORS}}


def cases(rows: list[dict], key: str) -> int:
    """Returns the number of distinct cases of the subjects with this key. Each sees a prefix of its suite's sequence."""
    most: dict[str, int] = {}
    for row in rows:
        most[row["suite"]] = max(most.get(row["suite"], 0), row["tests"] if row[key] else 0)
    return sum(most.values())


def with_errors(totals: list[dict]) -> list[dict]:
    """Returns the subjects that report any t or P."""
    return [found for found in totals if any(found[key]["count"] for key in ERRORS)]


def heat_map(suites: list[dict], totals: list[dict], folder: pathlib.Path) -> pathlib.Path | None:
    """Draws the heat map of wrong decisions of subjects that are not exact; None without any."""
    others = [subject["subject"] for subject in totals if not subject["exact"]]
    shares = [[suite["at"][name]["wrong"] / max(suite["at"][name]["tests"], 1) for suite in suites] for name in others]
    return plots.heat_map(shares, others, [suite["suite"] for suite in suites],
                          "Wrong decisions, % of tests (the exact ones: 0 everywhere)", folder / "stress-wrong.png") if others else None


def values(rows: list[dict], folder: pathlib.Path) -> dict:
    """Returns the sums by subject and by suite, and the heat map."""
    # Exact subjects must also decide ties correctly.
    mine = [row | {"wrong": row["wrong"] + row["exact"] * row["wrong_ties"]} for row in of(rows, "stress")]
    suites = grouped(mine, ("suite",), "subject")
    totals = [total([suite["at"][name] for suite in suites]) for name in suites[0]["at"]]
    return {"suites": suites, "totals": totals, "names": list(suites[0]["at"]),
            "passed": not failures(rows), "watertight": of(rows, "watertight"),
            "all_errors": with_errors(totals),
            "random_errors": with_errors([total([row]) for row in mine if row["suite"] == "random"]),
            "cases": cases(mine, "exact"), "simulated_cases": cases(mine, "simulated"),
            "kinds": [{**suite, "key": key} for suite in suites for key in KINDS
                      if any(row[key] for row in suite["at"].values())],
            "wrong_plot": heat_map(suites, totals, folder)}


def failures(rows: list[dict]) -> list[str]:
    """Returns exact subjects with wrong decisions, and suites whose claims of being inside a mesh are wrong."""
    return [f"{row['subject']}, suite {row['suite']}: wrong, or beyond a proven bound"
            for row in of(rows, "stress") if row["exact"] and not (row["spotless"] and row["tests"])] + \
        [f"{row['by']}, {row['test']}: {row['escapes']} escapes, {row['double_hits'] or 0} double hits"
         for row in of(rows, "watertight") if row["exact"] and (row["escapes"] or row["double_hits"])] + \
        [f"suite {suite['suite']}: {suite['broken_claims']} rays are not inside their mesh"
         for suite in grouped(of(rows, "stress"), ("suite",), "subject") if suite["broken_claims"]]
