"""Rows of the lab: a JSON object a line in build/results/, what their columns mean, and CSV."""

import collections
import json
import math
import pathlib
import re
import statistics

import pandas

ROOT = pathlib.Path(__file__).resolve().parents[3]
KEPT = ROOT / "build" / "results"

# What results.csv holds: "* `column`: explanation." A column of nested values is explained by the
# first part of its name.
COLUMNS = (pathlib.Path(__file__).parent / "columns.md").read_text()


def read(file: pathlib.Path) -> list[dict]:
    """All rows of a file."""
    return [json.loads(line) for line in file.read_text().splitlines()]


def write(file: pathlib.Path, rows: list[dict]) -> None:
    """The same back."""
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text("".join(json.dumps(row) + "\n" for row in rows))


def of(rows: list[dict], table: str, **values: object) -> list[dict]:
    """The rows of a table whose columns have these values."""
    return [row for row in rows if row["table"] == table
            and all(row.get(name) == value for name, value in values.items())]


def scene_name(row: dict) -> str:
    """`cornell` for scenes/cornell.obj."""
    return pathlib.Path(row["scene"]).stem


def comma_separated(rows: list[dict]) -> str:
    """CSV: nested values as name.name; of a list of numbers the median."""
    frame = pandas.json_normalize(rows)

    def scalar(value: object) -> object:
        return statistics.median(value) if isinstance(value, list) else value

    unknown = {name.split(".")[0] for name in frame.columns} - set(re.findall(r"^\* `(\w+)`", COLUMNS, re.MULTILINE))
    if unknown:
        raise ValueError(f"columns that nobody explains: {', '.join(sorted(unknown))}")
    return frame.map(scalar).to_csv(index=False)


def summary(binned: list[dict]) -> dict:
    """Median, 99th percentile and largest of errors that `lab stress` has counted in bins.

    Quantiles are rounded up to the end of their bins, by 1/64 at most; JSON's null is infinity.
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
        """Of the error with `rank` smaller ones."""
        seen = 0
        for end in sorted(counts):
            seen += counts[end]
            if seen > rank:
                return largest if end > 2.0**64 else min(end, largest)
        raise AssertionError("rank beyond the errors")

    return {"count": total, "median": quantile((total - 1) // 2),
            "p99": quantile((total - 1) - (total - 1) // 100), "max": largest}
