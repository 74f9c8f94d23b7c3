"""Rows of the lab: JSON objects, one per line, each with the command, commit and machine that produced it."""

import json
import os
import pathlib

ROOT = pathlib.Path(__file__).resolve().parents[2]
KEPT = ROOT / "build" / "results"


def read(file: pathlib.Path) -> list[dict]:
    """Returns all rows of a file."""
    return [json.loads(line) for line in file.read_text().splitlines()]


def write(file: pathlib.Path, rows: list[dict]) -> None:
    """Atomically replaces the file."""
    file.parent.mkdir(parents=True, exist_ok=True)
    unfinished = file.with_suffix(".unfinished")
    unfinished.write_text("".join(json.dumps(row) + "\n" for row in rows))
    os.replace(unfinished, file)


def of(rows: list[dict], table: str, **values: object) -> list[dict]:
    """Returns the rows of a table whose columns have these values."""
    return [row for row in rows if row["table"] == table
            and all(row.get(name) == value for name, value in values.items())]


def scene_name(row: dict) -> str:
    """Returns the scene's name, such as `cornell` for scenes/cornell.obj."""
    return pathlib.Path(row["scene"]).stem


def grouped(rows: list[dict], by: tuple[str, ...], over: str) -> list[dict]:
    """Returns one row for each value of the columns `by`; its `at` maps values of `over` to the rows with them."""
    found: dict[tuple, dict] = {}
    for row in rows:
        found.setdefault(tuple(row[key] for key in by), {**row, "at": {}})["at"][row[over]] = row
    return list(found.values())
