"""`python3 -m host.lab.evidence [PAGE]`: how old the published results are, and what they depend on has changed since.

results/evidence.jsonl has a row for each published page: its command, the commit that it was measured at (of pages that did not
say so: the one that published the figures), date, machine, and the paths whose change makes it stale, ":(exclude)..." among them
for what does not; those of its own target's come from `publish`. Prints the table and writes it into results/README.md. PAGE's
figures are noted as this commit's, measured here, first. Exit status 1 where something is stale, 2 for a page without a row.
"""

import datetime
import pathlib
import subprocess
import sys

from host.lab import machine
from host.lab.rows import ROOT, read, write
from synth.tables import markdown

FILE = ROOT / "host" / "lab" / "results" / "evidence.jsonl"
PAGE = FILE.with_name("README.md")
# Words, tables of figures, tests and assertions change no figure.
WITHOUT = tuple(f":(exclude){path}" for path in ("*.md", "*.csv", "*/test/*", "sim/checks/*"))


def git(*words: str, root: pathlib.Path = ROOT) -> list[str]:
    """Lines of what git says; raises CalledProcessError."""
    return subprocess.run(["git", "-C", root, *words], check=True, capture_output=True, text=True).stdout.splitlines()


def changes(row: dict, root: pathlib.Path = ROOT) -> list[str]:
    """Commits since then that changed what the page depends on, "HASH SUBJECT", the newest first."""
    return git("log", "--format=%h %s", f"{row['commit']}..HEAD", "--", *row["paths"], *WITHOUT, root=root)


def renew(page: str, about: dict, command: str = "") -> None:
    """Notes that a page was published now, measured as `about` (machine.describe) says, by the last command if none is given."""
    rows = read(FILE)
    row = next((row for row in rows if row["page"] == page), None)
    if row is None:
        raise ValueError(f"{page}: expected one of " + ", ".join(row["page"] for row in rows))
    row |= {"command": command or row["command"], "commit": about["commit"], "date": about["date"],
            "machine": f"{about['processor']}, {about['processors']} processors"}
    write(FILE, rows)


def table(rows: list[dict], today: datetime.date) -> str:
    """Markdown: a line for each page, the oldest first."""
    cells = []
    for row in sorted(rows, key=lambda row: row["date"]):
        since = changes(row)
        age = (today - datetime.date.fromisoformat(row["date"])).days
        cells.append([f"[{row['page']}](../../../{row['page']})", f"`{row['command']}`", row["date"], age, f"`{row['commit'][:7]}`", len(since),
                      since[0].split(" ", 1)[0] if since else "", row["machine"] or "not noted"])
    return markdown(["page", "command", "date", "age, days", "commit", "commits to its paths since", "the last", "machine"], cells)


def main(page: str = "") -> int:
    """Prints and writes the table; `page` is renewed first."""
    if page:
        try:
            renew(page, machine.describe(ROOT))
        except ValueError as error:
            print(f"dates: {error}", file=sys.stderr)
            return 2
    rows = read(FILE)
    try:
        text = table(rows, datetime.date.today())
        stale = [row["page"] for row in rows if changes(row)]
    except (FileNotFoundError, subprocess.CalledProcessError) as error:
        print(f"error: no history of this repository: {getattr(error, 'stderr', '') or error}", file=sys.stderr)
        return 2
    PAGE.write_text("# Published results\n\nWritten by `make dates`, with which `make claims` begins, from [evidence.jsonl](evidence.jsonl). A commit counts where it changed\n"
                    "code (no test, no page) in one of the paths that the result depends on; `git log COMMIT..HEAD -- PATHS` has them.\n\n" + text)
    print(text)
    print(f"{len(stale)} of {len(rows)} pages are older than what they depend on" + (f": {', '.join(stale)}" if stale else ""))
    return 1 if stale else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:2]))
