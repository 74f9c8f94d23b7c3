"""`make stress`: every engine and variant of arithmetic on suites of hard cases, checked by exact integers."""

import argparse
import math
import pathlib
import subprocess

from host.lab.rows import grouped, of
from host.lab.steps import LAB, Step

# Minimum number of tests per suite of a published report.
ENOUGH = 1_000_000
COUNTS = ("tests", "rays", "refused", "wrong", "wrong_ties", "escapes", "double_hits",
          "wrong_nearest", "wrong_tied_nearest", "orders", "wrong_order", "doubts")
LARGEST = ("t_ulp", "point_ulp", "delivered_t_ulp", "delivered_point_ulp", "t_of_bound", "point_of_bound", "point_of_said")
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


def total(rows: list[dict]) -> dict:
    """Returns the sum of a subject's rows over all suites."""
    return {**rows[0], **{key: sum(row[key] for row in rows) for key in COUNTS},
            **{key: max(math.inf if row[key] is None else row[key] for row in rows) for key in LARGEST}}


def cases(rows: list[dict], key: str) -> int:
    """Returns the number of distinct cases of the subjects with this key. Each sees a prefix of its suite's sequence."""
    most: dict[str, int] = {}
    for row in rows:
        most[row["suite"]] = max(most.get(row["suite"], 0), row["tests"] if row[key] else 0)
    return sum(most.values())


def values(rows: list[dict], _: pathlib.Path) -> dict:
    """Returns the sums by subject and by suite, side by side."""
    # Exact subjects must also decide ties correctly.
    mine = [row | {"wrong": row["wrong"] + row["exact"] * row["wrong_ties"]} for row in of(rows, "stress")]
    suites = grouped(mine, ("suite",), "subject")
    totals = [total([suite["at"][name] for suite in suites]) for name in suites[0]["at"]]
    return {"suites": suites, "totals": totals, "names": list(suites[0]["at"]),
            "passed": not failures(rows), "watertight": of(rows, "watertight"),
            "cases": cases(mine, "exact"), "simulated_cases": cases(mine, "simulated"),
            "kinds": [{**suite, "key": key} for suite in suites for key in KINDS
                      if any(row[key] for row in suite["at"].values())]}


def failures(rows: list[dict]) -> list[str]:
    """Returns exact subjects with wrong decisions, and suites whose claims of being inside a mesh are wrong."""
    return [f"{row['subject']}, suite {row['suite']}: wrong, or beyond a proven bound"
            for row in of(rows, "stress") if row["exact"] and not (row["spotless"] and row["tests"])] + \
        [f"{row['by']}, {row['test']}: {row['escapes']} escapes, {row['double_hits'] or 0} double hits"
         for row in of(rows, "watertight") if row["exact"] and (row["escapes"] or row["double_hits"])] + \
        [f"suite {suite['suite']}: {suite['broken_claims']} rays are not inside their mesh"
         for suite in grouped(of(rows, "stress"), ("suite",), "subject") if suite["broken_claims"]]
