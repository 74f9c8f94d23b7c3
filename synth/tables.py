"""Writes tables as aligned Markdown and as CSV, and the line that names the command, commit and date of a measurement."""

import csv
import datetime
import functools
import io
import pathlib
import re
import subprocess

RESULTS = pathlib.Path(__file__).resolve().parent / "results"  # the folder that PUBLISH=1 writes


def markdown(header: list[str], rows: list[list[object]]) -> str:
    """Returns a Markdown table with columns padded to equal width. Columns of numbers are right-aligned."""
    text = [[str(cell) for cell in row] for row in [header, *rows]]
    if not rows:
        return ""
    widths = [max(len(row[i]) for row in text) for i in range(len(header))]
    right = [all(row[i][:1].isdigit() or row[i] in ("", "-") for row in text[1:]) for i in range(len(header))]
    lines = ["| " + " | ".join(cell.rjust(w) if r else cell.ljust(w)
                               for cell, w, r in zip(row, widths, right, strict=True)) + " |"
             for row in text]
    rule = "|" + "|".join("-" * (w + 1) + (":" if r else "-") for w, r in zip(widths, right, strict=True)) + "|"
    return "\n".join([lines[0], rule, *lines[1:]]) + "\n"


def unpadded(text: str) -> str:
    """Returns a page's text, with the padding of its tables removed."""
    return re.sub(r"(?m)^\|.*", lambda line: re.sub("-+", "---", line[0]) if line[0].startswith("|-") else re.sub(r" *\| *", "|", line[0]), text)


def comma_separated(rows: list[dict], columns: list[str]) -> str:
    """Returns CSV of the scalar `columns` of `rows`; missing values are left empty."""
    out = io.StringIO()
    writer = csv.DictWriter(out, columns, extrasaction="ignore", lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    return out.getvalue()


@functools.cache  # later, published files make the checkout dirty
def measured(command: str) -> str:
    """Returns the last line of a page: the command, the commit and the date."""
    commit = subprocess.run(["git", "describe", "--always", "--dirty"], cwd=RESULTS, capture_output=True, text=True, check=False).stdout.strip()
    return f"`{command}` at {commit}, {datetime.date.today().isoformat()}.\n"


def with_results(text: str, measured_by: dict[str, str] = {}) -> str:
    """Returns page `text` with its tables regenerated from the published CSV files. Each table is followed by the line of `measured`.

    A table is between `<!-- FILE: COLUMNS -->` and `<!-- end -->`. A table `<!-- synth.csv, SECTION: FLOWS -->` has area / ns of the
    section's designs in OSU 0.35 um. `measured_by`: new lines of `measured`, by file; other tables keep their lines."""
    def table(mark: re.Match) -> str:
        (file, _, section), heads = mark[2].partition(", "), mark[3].split(", ")
        rows = list(csv.DictReader((RESULTS / file).read_text().splitlines()))
        if section:
            designs: dict[str, dict] = {}
            for row in rows:
                if (row["section"], row["target"]) == (section, "osu035"):
                    designs.setdefault(row["design"], {"design": row["design"]})[row["flow"]] = f"{int(row['area']):,} / {float(row['delay_ns']):.2f}"
            rows, heads = list(designs.values()), ["design", *heads]
        return f"{mark[1]}{unpadded(markdown(heads, [[row.get(head, '') for head in heads] for row in rows]))}\n{measured_by.get(file, mark[4] or '')}"
    return re.sub(r"(<!-- (\S+\.csv[^:>]*): ([^>]*) -->\n).*?(`make [^\n]*\n)?(?=<!-- end -->)", table, text, flags=re.S)


def publish(file: str, text: str, command: str) -> None:
    """Writes `text` to a CSV file of results/ and updates this file's tables in results/README.md. `command`: as for `measured`."""
    results, line = RESULTS / "README.md", measured(command)
    (RESULTS / file).write_text(text)
    results.write_text(with_results(results.read_text(), {file: line}))
