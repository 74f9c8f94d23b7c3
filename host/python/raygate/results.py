"""Measurements of this repository, as pandas data frames.

    raygate.results.bench()["pictures"]       # a table of `make bench`
    raygate.results.synth()                   # from `make synth`: area and delay of each design and flow
    raygate.results.published("synth/results/README.md")["The 48-bit adders"]   # any table of a page

Needs pandas: pip install 'raygate[results]'. Paths are relative to the working directory; the defaults fit the root of
the repository. Raises InputError, which names the file and the line, for what cannot be read.
"""

from __future__ import annotations

import json
import os
import pathlib
import re
from typing import TYPE_CHECKING, Any, Sequence, Union

from ._raygate import InputError

if TYPE_CHECKING:
    import pandas  # type: ignore[import-untyped, unused-ignore]

_Path = Union[str, "os.PathLike[str]"]


def bench(file: _Path = "build/results/bench.jsonl") -> dict[str, pandas.DataFrame]:
    """Returns the tables of `make bench` (also of `make stress`, stress.jsonl): a dictionary of data frames by name.
    Nested columns are named outer.inner."""
    frames: dict[str, list[Any]] = {}
    for number, line in enumerate(_text(file, "make bench").splitlines(), 1):
        try:
            row = json.loads(line)
            frames.setdefault(row["table"], []).append(row)
        except (ValueError, KeyError, TypeError):
            raise InputError(f"{file}:{number}: found {line[:40]!r}, expected a JSON object with a "
                             "\"table\"") from None
    return {name: _pandas().json_normalize(rows) for name, rows in frames.items()}


def synth(file: _Path = "build/synth/results.json") -> pandas.DataFrame:
    """Returns the results of `make synth`: a row for each design, target and flow; `area` in the library's units,
    `delay_ns`, `luts`, `mhz`."""
    text = _text(file, "make synth")
    try:
        records = json.loads(text)["results"]
        if not all(isinstance(record, dict) for record in records):
            raise TypeError
    except (ValueError, KeyError, TypeError):
        raise InputError(f"{file}: found no \"results\", expected what make synth writes") from None
    return _pandas().DataFrame(records)


def published(page: _Path) -> dict[str, pandas.DataFrame]:
    """Returns the tables of a Markdown page: a dictionary of data frames by the headings above them (the first table
    below each). Cells are text without thousands separators; a column of numbers is float64."""
    frames: dict[str, pandas.DataFrame] = {}
    heading = ""
    rows: list[list[str]] = []
    for line in [*_text(page, "").splitlines(), ""]:
        if line.startswith("|"):
            rows.append([cell.strip() for cell in line.strip()[1:].removesuffix("|").split("|")])
            continue
        whole = len({len(row) for row in rows}) == 1
        if len(rows) > 2 and whole and heading not in frames:
            frames[heading] = _frame(rows[0], rows[2:])
        rows = []
        if line.startswith("#"):
            heading = line.lstrip("#").strip()
    return frames


def _frame(names: list[str], rows: list[list[str]]) -> pandas.DataFrame:
    columns = [[re.sub(r"(?<=\d),(?=\d{3})", "", row[i]) for row in rows]
               for i in range(len(names))]
    return _pandas().DataFrame(list(zip(*map(_numbers, columns))), columns=names)


def _numbers(cells: list[str]) -> Sequence[str | float]:
    try:
        return [float(cell) for cell in cells]
    except ValueError:
        return cells  # text


def _text(file: _Path, command: str) -> str:
    try:
        return pathlib.Path(file).read_text()
    except (OSError, UnicodeDecodeError) as error:
        hint = f"; `{command}` writes it" if command else ""
        raise InputError(f"{file}: cannot be read: {getattr(error, 'strerror', error)}{hint}") from None


def _pandas() -> Any:
    try:
        import pandas  # type: ignore[import-untyped, unused-ignore]
    except ImportError:
        raise ImportError("raygate.results needs pandas: pip install 'raygate[results]'") from None
    return pandas
