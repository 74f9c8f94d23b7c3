"""What this repository's own measurements have found, as pandas data frames.

    raygate.results.bench()["pictures"]       # of `make bench`, by table
    raygate.results.synth()                   # of `make synth`: area, delay of each design and flow
    raygate.results.published("synth/results/README.md")["The 48-bit adders"]   # any table of a page

pandas is needed: pip install 'raygate[results]'. Paths are relative to the repository's root.
"""

import json
import pathlib
import re

from ._raygate import InputError


def bench(file="build/results/bench.jsonl"):
    """The tables of `make bench` (also of `make stress`, stress.jsonl): a dictionary of data
    frames by name. Nested columns are named
    outer.inner."""
    frames = {}
    for number, line in enumerate(_text(file, "make bench").splitlines(), 1):
        try:
            row = json.loads(line)
            frames.setdefault(row["table"], []).append(row)
        except (ValueError, KeyError, TypeError):
            raise InputError(f"{file}:{number}: found {line[:40]!r}, expected a JSON object with a "
                             "\"table\"") from None
    return {name: _pandas().json_normalize(rows) for name, rows in frames.items()}


def synth(file="build/synth/results.json"):
    """The designs that `make synth` has measured: a row for each design, target and flow; `area` in
    the library's units, `delay_ns`, `luts`, `mhz`."""
    text = _text(file, "make synth")
    try:
        records = json.loads(text)["results"]
        if not all(isinstance(record, dict) for record in records):
            raise TypeError
    except (ValueError, KeyError, TypeError):
        raise InputError(f"{file}: found no \"results\", expected what make synth writes") from None
    return _pandas().DataFrame(records)


def published(page):
    """The tables of a Markdown page: a dictionary of data frames by the headings above them (the
    first table below each). Cells are text, without thousands' commas; numbers where all are."""
    frames, heading, rows = {}, "", []
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


def _frame(names, rows):
    columns = [[re.sub(r"(?<=\d),(?=\d{3})", "", row[i]) for row in rows]
               for i in range(len(names))]
    rows = zip(*(_numbers(column) for column in columns))
    return _pandas().DataFrame(list(rows), columns=names)


def _numbers(cells):
    try:
        return [float(cell) for cell in cells]
    except ValueError:
        return cells  # text


def _text(file, command):
    try:
        return pathlib.Path(file).read_text()
    except (OSError, UnicodeDecodeError) as error:
        hint = f"; `{command}` writes it" if command else ""
        raise InputError(f"{file}: cannot be read: {getattr(error, 'strerror', error)}{hint}") from None


def _pandas():
    try:
        import pandas
    except ImportError:
        raise ImportError("raygate.results needs pandas: pip install 'raygate[results]'") from None
    return pandas
