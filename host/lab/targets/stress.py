"""`make stress`: every engine and variant of arithmetic on suites of hard cases, checked by exact integers."""

import argparse
import math
import pathlib
import subprocess

from host.lab.rows import grouped, of
from host.lab.steps import LAB, Step

COUNTS = ("tests", "rays", "refused", "wrong", "wrong_ties", "escapes", "double_hits", "wrong_nearest", "wrong_tied_nearest", "orders", "wrong_order", "doubts")
LARGEST = ("delivered_t_ulp", "delivered_point_ulp", "t_of_bound", "point_of_bound", "point_of_said")
FAULTS = ("wrong", "escapes", "double_hits", "wrong_nearest", "wrong_tied_nearest", "wrong_order")
KINDS = FAULTS[1:4]  # reported separately, per ray


def steps(part: str, given: argparse.Namespace, tests: int, *words: object) -> list[Step]:
    """Returns a step for each suite, with `tests` tests per suite unless `given` says otherwise. `words`: more arguments of `lab`."""
    tests = given.tests or (100_000 if given.quick else tests)
    suites = subprocess.run([LAB, "stress", "--list"], stdout=subprocess.PIPE, text=True, check=True).stdout.splitlines()
    return [Step(part, suite, ("stress", "--suite", suite, "--tests", tests, "--seed", given.seed, *words)) for suite in suites]


def watertight(given: argparse.Namespace) -> Step:
    """Returns the step of the public tests of watertightness."""
    return Step("all", "watertight", ("watertight", *(("--triangles", 4096, "--seeds", 1) if given.quick else ())))


# In part "core", half a million tests per suite run on the core's reference model, 50,000 on the simulated hardware.
PARTS = {"all": lambda given: [*steps("all", given, 10_000_000), watertight(given)],
         "core": lambda given: steps("core", given, 2_500_000, "--subject", "model core", "rtl core", "model exact core", "rtl exact core")}
USUAL = ("all",)


def total(rows: list[dict]) -> dict:
    """Returns a row with the sums, and the largest errors, of a subject's rows over all suites."""
    return {**rows[0], **{key: sum(row[key] for row in rows) for key in COUNTS},
            **{key: max(math.inf if row[key] is None else row[key] for row in rows) for key in LARGEST}}


def cases(rows: list[dict], key: str) -> int:
    """Returns the number of distinct tests of subjects whose column `key` is true. Per suite, the one with most tests counts."""
    most: dict[str, int] = {}
    for row in rows:
        most[row["suite"]] = max(most.get(row["suite"], 0), row["tests"] if row[key] else 0)
    return sum(most.values())


def values(rows: list[dict], _: pathlib.Path) -> dict:
    """Returns the sums by subject, the rows by suite with subjects side by side, and totals."""
    # Exact subjects must also decide ties correctly.
    mine = [row | {"wrong": row["wrong"] + row["exact"] * row["wrong_ties"]} for row in of(rows, "stress")]
    suites = grouped(mine, ("suite",), "subject")
    totals = [total([suite["at"][name] for suite in suites if name in suite["at"]]) for name in suites[0]["at"]]
    return {"suites": suites, "totals": totals, "names": list(suites[0]["at"]),
            "passed": not failures(rows),
            "faults": sum(row[key] for row in totals if row["exact"] for key in FAULTS),
            "watertight": grouped(of(rows, "watertight"), ("test", "triangles"), "by"),
            "leaks": sum(row["escapes"] + (row["double_hits"] or 0) for row in of(rows, "watertight") if row["exact"]),
            "cases": {key: cases(mine, key) for key in ("exact", "binary64", "simulated")},
            "kinds": [{**suite, "key": key} for suite in suites for key in KINDS if any(row[key] for row in suite["at"].values())]}


def failures(rows: list[dict]) -> list[str]:
    """Returns a message for each failure: an exact subject that is wrong in a suite, with lines of regressions.txt; an exact hit test with
    an escape or a double hit in a watertightness test; a suite whose rays do not start inside a mesh as claimed."""
    return [f"{row['subject']}, suite {row['suite']}: wrong, or beyond a proven bound" + "".join(f"\n{line}" for line in row["failures"])
            for row in of(rows, "stress") if row["exact"] and not (row["spotless"] and row["tests"])] + \
        [f"{row['by']}, {row['test']}: {row['escapes']} escapes, {row['double_hits'] or 0} double hits"
         for row in of(rows, "watertight") if row["exact"] and (row["escapes"] or row["double_hits"])] + \
        [f"suite {suite['suite']}: {suite['broken_claims']} rays are not inside their mesh"
         for suite in grouped(of(rows, "stress"), ("suite",), "subject") if suite["broken_claims"]]


PAGE = """# Stress test

**{{ "Passed" if passed else "FAILED" }}**: {{ suites|length }} suites, {{ "{:,}".format(cases.exact) }} cases, {{ "{:,}".format(cases.binary64) }} of them with binary64 vertices, {{ "{:,}".format(cases.simulated) }} by the simulated hardware, by `{{ machine.command }}`,
{{ "{:,.0f}".format(suites|sum("seconds")) }} s of processor time. Rays that a suite places inside a mesh but that start outside: {{ suites|sum("broken_claims") }}.

A case is a ray and a triangle; a subject is an engine, a variant or another hit test. All subjects see the same cases, slow subjects only the first ones
of each suite; cases are counted once. Suites `... 64` have binary64 vertices and, for half of the origins, binary64 rays. Ray cores and variants skip
these suites; of the exact subjects, only `trace` takes binary64 rays. Float32 tests and Embree get rounded vertices and rays.

## Subjects that promise to be exact

{{ totals|selectattr("exact")|map(attribute="subject")|join(", ") }}: {{ faults }} wrong decisions, escapes, double hits, wrong nearest hits or wrong orders, in {{ "{:,}".format(totals|selectattr("exact")|map(attribute="tests")|min) }} to
{{ "{:,}".format(totals|selectattr("exact")|map(attribute="tests")|max) }} cases each.

* **wrong**: a decision that differs from the exact one, or a hit whose interval does not contain the exact t. If a ray meets
an edge exactly (a tie), exact subjects must follow their tie rule; for others, any decision is right.
* **escape**: a ray from inside a closed mesh that hits nothing. **double hit**: a ray from inside with too many hits. **wrong nearest**: the nearest triangle is wrong, except for ties.

{{ saved("stress-subjects", totals, "subject", "what it is = subject_is", "cases = tests :d", "doubts, % = 100 * doubts / tests :.2f", "rays out of its range = refused :d", "delivered t, ulp = delivered_t_ulp or none :.3g",
         "delivered P, ulp = delivered_point_ulp or none :.3g", "largest t over bound = t_of_bound or none :.3f",
         "largest P over bound = point_of_bound or none :.3f", "largest P over what the hit says = point_of_said or none :.3f") }} describes each subject, and has doubts and the largest errors, in ulps and relative to their bounds.

{% if watertight %}
## Public tests of watertightness

Each ray must hit the mesh exactly once. Tests `... 64` have binary64 vertices. `nomiss` and `singlehit` follow the Vulkan conformance tests (`ray_tracing_pipeline.watertightness`),
`sphere` follows Embree's `verify`. `edges` and `vertices` aim rays from inside a sphere at its edges and vertices, as Woop, Benthin and Wald did. Meshes and random numbers differ from
the originals. Embree's counts depend on the processor's vector instructions. `model` and the simulated hardware find only the nearest hit.

{{ watertight[0].at.values()|selectattr("exact")|map(attribute="by")|join(", ") }}: {{ leaks }} escapes and double hits. Embree, in binary32:

{{ table(watertight|selectattr("at.Embree", "defined")|list, "test", "triangles :,", "rays = at['Embree'].rays :,", each(["Embree", "Embree robust"],
         "escapes, {} = at['{}'].escapes :,", "double hits, {} = at['{}'].double_hits :,")) }}
{% endif %}
## Other subjects, by suite

The suites are chosen to be hard, so a mean over suites is meaningless. Watertight tests and Embree's robust mode accept both triangles at
an edge; they promise no escapes, but allow double hits. Rays and triangles outside a subject's range are not counted.

{{ saved("stress-wrong", suites, "suite", "what it is = suite_is", each(names, "{} = rate(at['{}'].wrong, at['{}'].tests)|replace(',', '')")) }}: wrong decisions per million cases.
{{ saved("stress-rays", kinds, "suite", "per million rays = key|replace('_', ' ')", each(names, "{} = rate(at['{}'][key], at['{}'].rays)|replace(',', '')")) }}: escapes, double hits and wrong nearest hits per million rays.
"""
