"""The tables and plots of `make stress`, for stress.md.j2."""

import pathlib

from host.lab.report import plots, rows as kept
from host.lab.report.document import render, table
from host.lab.report.rows import summary

COUNTS = ("tests", "rays", "wrong", "wrong_ties", "leaks", "escapes", "double_hits",
          "wrong_nearest", "wrong_tied_nearest", "orders", "wrong_order", "doubts")
ERRORS = ("t_ulp", "t_relative", "point_ulp", "delivered_t_ulp", "delivered_point_ulp")
QUANTILES = ("median", "p99", "max")
DECADES = 8


def wrong(row: dict) -> int:
    """Tests decided wrongly; where only the tie-break decides, exact subjects alone count."""
    return row["wrong"] + row["exact"] * row["wrong_ties"]


def rate(count: int, of: int) -> str:
    """Per million; 0 only where there was none."""
    value = 1e6 * count / of if of else 0.0
    return "-" if not of else "0" if not count else f"{value:,.0f}" if value >= 10 else f"{value:.2g}"


def total(rows: list[dict]) -> dict:
    """A subject's rows of all suites as one."""
    return {**rows[0], **{key: sum(row[key] for row in rows) for key in COUNTS},
            **{key: max(row[key] for row in rows) for key in ("t_of_bound", "point_of_bound",
                                                        "point_of_said")},
            **{key: summary([row[key] for row in rows]) for key in ERRORS},
            "t_ulp_by_angle": [summary([row["t_ulp_by_angle"][decade] for row in rows])
                               for decade in range(DECADES)]}


def subjects_table(totals: list[dict]) -> str:
    """What each subject did in all suites."""
    return table({"subject": "", "tests": ",", "wrong": ",", "wrong per million": ",", "leaks": ",",
                  "of them escapes": ",", "double hits": ",", "wrong nearest": ",", "wrong order": ",",
                  "doubts, %": ".2f", "largest t over bound": ".3f", "largest P over bound": ".3f",
                  "largest P over what the hit says": ".3f"},
                 [[t["subject"], t["tests"], wrong(t), rate(wrong(t), t["tests"]), t["leaks"],
                   t["escapes"], t["double_hits"],
                   t["wrong_nearest"] + t["exact"] * t["wrong_tied_nearest"],
                   t["wrong_order"] if t["orders"] else None,
                   100 * t["doubts"] / max(t["tests"], 1), t["t_of_bound"] or None,
                   t["point_of_bound"] or None, t["point_of_said"] or None] for t in totals])


def by_suite(suites: dict[str, dict], subjects: list[str], cell: object) -> str:
    """A row for each suite, a column for each subject."""
    return table({"suite": "", **dict.fromkeys(subjects, ",")},
                 [[suite, *(cell(rows[subject]) for subject in subjects)]
                  for suite, rows in suites.items()])


def closed_table(suites: dict[str, dict], subjects: list[str]) -> str:
    """Per million rays from inside closed meshes."""
    cells = []
    for suite, rows in suites.items():
        if any(row["leaks"] or row["double_hits"] for row in rows.values()):
            cells += [[suite, key.replace("_", " "),
                       *(rate(rows[subject][key], rows[subject]["rays"]) for subject in subjects)]
                      for key in ("leaks", "escapes", "double_hits")]
    return table({"suite": "", "per million rays": "", **dict.fromkeys(subjects, ",")}, cells)


def errors_table(totals: list[dict]) -> str:
    """Quantiles of the errors of t and P."""
    heads = {"t_ulp": "t, ulp", "t_relative": "t, relative", "point_ulp": "P, ulp",
             "delivered_t_ulp": "delivered t, ulp", "delivered_point_ulp": "delivered P, ulp"}
    names = {"median": "median", "p99": "99 %", "max": "largest"}
    return table({"subject": "", **{f"{heads[key]}: {names[quantile]}": ".3g"
                                    for key in ERRORS for quantile in QUANTILES}},
                 [[t["subject"], *(t[key][quantile] for key in ERRORS for quantile in QUANTILES)]
                  for t in totals if any(t[key]["count"] for key in ERRORS)])


def angles_table(unit: dict, bounds: dict) -> str:
    """The unit's t by the angle between ray and plane, and its proven bound."""
    return table({"sine from": ".0e", "to": ".0e", "proven bound, ulp": ".3g", "median, ulp": ".3g",
                  "99 %, ulp": ".3g", "largest, ulp": ".3g"},
                 [[10 ** -(decade + 1), 10 ** -decade, bounds["t_ulp"][10 * (decade + 1)],
                   *(unit["t_ulp_by_angle"][decade][quantile] for quantile in QUANTILES)]
                  for decade in range(DECADES)])


def _curve(subject: dict, key: str) -> list[tuple[float, float]]:
    return [(10 ** -(decade + 0.5), errors[key])
            for decade, errors in enumerate(subject["t_ulp_by_angle"])
            if errors["count"] > 100 and errors[key]]


def build(rows: list[dict], folder: pathlib.Path) -> str:
    """The report in Markdown; draws the plots into `folder`."""
    mine = kept.of(rows, "stress")
    (bounds,) = kept.of(rows, "bounds")
    subjects = list(dict.fromkeys(row["subject"] for row in mine))
    suites: dict[str, dict] = {}
    for row in mine:
        suites.setdefault(row["suite"], {})[row["subject"]] = row
    by_subject = {name: [row for row in mine if row["subject"] == name] for name in subjects}
    totals = [total(found) for found in by_subject.values()]
    first = [next(iter(found.values())) for found in suites.values()]  # what is the suite's alone
    unit = next(t for t in totals if t["exact"] and t["t_ulp"]["count"])
    others = [t for t in totals if not t["exact"]]
    shares = plots.heat_map([[wrong(suites[suite][t["subject"]]) /
                            max(suites[suite][t["subject"]]["tests"], 1) for suite in suites]
                           for t in others], [t["subject"] for t in others], list(suites),
                          "Wrong decisions, % of tests (the exact ones: 0 everywhere)",
                          folder / "stress-wrong.png")
    angles = plots.error_by_angle(
        {t["subject"]: _curve(t, "p99") for t in others if len(_curve(t, "p99")) > 1},
        _curve(unit, "p99"), _curve(unit, "max"),
        [(sine, ulp) for sine, ulp in zip(bounds["sine"], bounds["t_ulp"], strict=True)
         if ulp is not None], folder / "stress-angles.png")
    claims = sum(row["broken_claims"] for row in first)
    passed = claims == 0 and all(row["spotless"] for row in mine if row["exact"])
    return render(
        "stress.md.j2", folder, passed=passed, suites=suites, totals=totals, first=first,
        run=first[0]["run"], broken_claims=claims, seconds=sum(row["seconds"] for row in first),
        engines=sum(t["tests"] for t in totals if t["exact"]), unit=unit["subject"],
        subjects=subjects_table(totals), by_suite=by_suite(
            suites, subjects, lambda row: rate(wrong(row), row["tests"])),
        closed=closed_table(suites, subjects), errors=errors_table(totals),
        random=errors_table([total([row]) for row in suites.get("random", {}).values()]),
        angles=angles_table(unit, bounds), wrong_plot=shares, angle_plot=angles)
