"""Checks the figures of host/lab/claims.csv: runs each command and looks for the figure in what it prints.

The numbers of a figure must stand in the output in
this order, commas aside. A figure that begins with ~ depends on the machine: what its command prints is
shown, not judged. Exit status 1 where a figure is not there, 2 where no command was asked for.

quotes.csv has what pages quote from published results: `misquoted` finds what is not in its result.
"""

import argparse
import csv
import decimal
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
CLAIMS = ROOT / "host/lab/claims.csv"
QUOTES = ROOT / "host/lab/quotes.csv"
NUMBER = re.compile(r"0x[0-9A-Fa-f]+|\d[\d,]*\.?\d*")


def rows() -> list[tuple[str, str, str]]:
    """What is claimed, the figure, and the command that prints it."""
    with CLAIMS.open(newline="") as file:
        return [(row["what"], row["figure"], row["command"]) for row in csv.DictReader(file)]


def numbers(text: str) -> list[str]:
    """The numbers of a text, as plain decimals or upper-case hexadecimal digits."""
    words = (word.removeprefix("0x").upper().replace(",", "") for word in NUMBER.findall(text))
    return [word.rstrip(".") for word in words]


def holds(output: str, figure: str) -> bool:
    """Whether the figure's numbers stand in the output one after the other (others may lie between)."""
    words = iter(re.findall(r"[0-9A-Fa-f.]+", output.replace(",", "").upper().replace("0X", "")))
    words = (word.rstrip(".") for word in words)
    return all(number in words for number in numbers(figure))


def rounds_to(number: str, figure: str) -> bool:
    """Whether a number, to as many digits as a figure has, is that figure, which may be in millions."""
    wanted = decimal.Decimal(figure.split()[0])
    value = decimal.Decimal(number) / (1_000_000 if figure.endswith("million") else 1)
    return value.quantize(wanted, decimal.ROUND_HALF_UP) == wanted


def misquoted(quotes: list[dict], root: pathlib.Path) -> list[str]:
    """What pages quote and do not have, or their results don't; of each quote `page`, `quote`, `result`, and the `line` of it, "text, text"."""
    wrong = []
    for row in quotes:
        page, quote, result = row["page"], row["quote"], row["result"]
        if " ".join(quote.split()) not in " ".join((root / page).read_text().split()):
            wrong.append(f"{page}: no longer has: {quote}")
        figures = re.findall(r"\d+(?:\.\d+)?(?: million)?", quote.replace(",", ""))
        lines = [line for line in (root / result).read_text().splitlines() if all(mark in line for mark in row["line"].split(", "))]
        if not figures or not any(all(figure in found for figure in figures) for found in (
                [figure for figure in figures for number in numbers(line) if rounds_to(number, figure)] for line in lines)):
            wrong.append(f"{page}: {quote}: {result} has no such line with: {row['line']}")
    return wrong


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", default="", metavar="TEXT", help="commands that hold TEXT")
    parser.add_argument("--judged", action="store_true", help="leave out what depends on the machine")
    wish = parser.parse_args()
    wanted = [row for row in rows() if wish.only in row[2]
              and not (wish.judged and row[1].startswith("~"))]
    if not wanted:
        print("no such command in host/lab/claims.csv", file=sys.stderr)
        return 2
    outputs, missing = {}, 0
    for what, figure, command in wanted:
        if command not in outputs:
            done = subprocess.run(command, shell=True, cwd=ROOT, capture_output=True, text=True, check=False)
            outputs[command] = done.stdout + done.stderr
        judged = not figure.startswith("~")
        good = not judged or holds(outputs[command], figure)
        missing += not good
        verdict = "shown" if not judged else "ok" if good else "MISSING"
        print(f"{verdict:8}{what}: {figure}  ({command})")
        if not judged:
            print(outputs[command])
    print(f"{len(wanted) - missing} passed, {missing} failed")
    return int(missing > 0)


if __name__ == "__main__":
    sys.exit(main())
