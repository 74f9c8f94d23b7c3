"""Rows of the lab: JSON objects, one a line. Each says which command found it, at which commit, on which machine."""

import json
import os
import pathlib

ROOT = pathlib.Path(__file__).resolve().parents[2]
KEPT = ROOT / "build" / "results"


def read(file: pathlib.Path) -> list[dict]:
    """All rows of a file."""
    return [json.loads(line) for line in file.read_text().splitlines()]


def write(file: pathlib.Path, rows: list[dict]) -> None:
    """Replaces the file at once: it is never there in part."""
    file.parent.mkdir(parents=True, exist_ok=True)
    unfinished = file.with_suffix(".unfinished")
    unfinished.write_text("".join(json.dumps(row) + "\n" for row in rows))
    os.replace(unfinished, file)


def of(rows: list[dict], table: str, **values: object) -> list[dict]:
    """The rows of a table whose columns have these values."""
    return [row for row in rows if row["table"] == table
            and all(row.get(name) == value for name, value in values.items())]


def scene_name(row: dict) -> str:
    """`cornell` for scenes/cornell.obj."""
    return pathlib.Path(row["scene"]).stem


def grouped(rows: list[dict], by: tuple[str, ...], over: str) -> list[dict]:
    """One row for each value of the columns `by`; its `at` has the others by their value of `over`."""
    found: dict[tuple, dict] = {}
    for row in rows:
        found.setdefault(tuple(row[key] for key in by), {**row, "at": {}})["at"][row[over]] = row
    return list(found.values())
