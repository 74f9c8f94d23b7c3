"""Tables of a report: Markdown that is aligned in a terminal too, and CSV; and what measured them."""

import csv
import datetime
import io
import pathlib
import subprocess

RESULTS = pathlib.Path(__file__).resolve().parent / "results"  # what PUBLISH=1 writes


def markdown(header: list[str], rows: list[list[object]]) -> str:
    """A Markdown table whose columns line up; numbers to the right."""
    text = [[str(cell) for cell in row] for row in [header, *rows]]
    if not rows:
        return ""
    widths = [max(len(row[i]) for row in text) for i in range(len(header))]
    right = [all(row[i][:1].isdigit() or row[i] in ("", "-") for row in text[1:])
             for i in range(len(header))]
    lines = ["| " + " | ".join(cell.rjust(w) if r else cell.ljust(w)
                               for cell, w, r in zip(row, widths, right, strict=True)) + " |"
             for row in text]
    rule = "|" + "|".join("-" * (w + 1) + (":" if r else "-")
                          for w, r in zip(widths, right, strict=True)) + "|"
    return "\n".join([lines[0], rule, *lines[1:]]) + "\n"


def comma_separated(rows: list[dict], columns: list[str]) -> str:
    """CSV of the scalar `columns` of `rows`; what a row has not is left empty."""
    out = io.StringIO()
    writer = csv.DictWriter(out, columns, extrasaction="ignore", lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    return out.getvalue()


def measured(command: str) -> str:
    """The last line of a page: the command, the commit and the date."""
    commit = subprocess.run(["git", "describe", "--always", "--dirty"], cwd=RESULTS, capture_output=True, text=True, check=False).stdout.strip()
    return f"`{command}` at {commit}, {datetime.date.today().isoformat()}.\n"
