"""The energy of a test in each format: `python3 -m synth.layout.formats` (`make layout TOP=energy`).

Of cells alone, for wires are a few hundredths of it (synth/README.md); kept in build/synth/energies.json,
which `make bench` takes its energies from. A test of equation 10 is six multiplications, two additions and
one division (synth/layout/tests.py).
"""

import json
import sys

from synth import catalogue, runner, store, tables, tools, yosys
from synth.layout import energy, tests

FLOW = "small"
LIBRARY = catalogue.library("osu035")
SIGNIFICANDS = (24, 16, 12)  # bits, the leading one counted; exponents have 8


def designs() -> list[tuple[int, catalogue.Design]]:
    """Each core in each format: those of make synth."""
    rows = {row.design.name: row.design for row in catalogue.core_rows()}
    return [(bits, rows[top.replace("_", "-") + ("" if bits == 24 else f"-{bits}-bits")])
            for bits in SIGNIFICANDS for top in tests.OPERATIONS]


def main() -> int:
    """1 where a core fails, 2 for what the user can mend."""
    try:
        yosys.folder()
        for tool in ("sta", "iverilog"):
            tools.find(tool)
        _ = LIBRARY.liberty
        results, failures = runner.run_all([runner.Job(
            f"{design.name} energy", lambda d=design: energy.of_cells(d, LIBRARY, FLOW),
            lambda got: f"{got['pj']:.0f} pJ") for _, design in designs()], 2)
    except tools.MissingTool as error:
        print(f"energy: {error}", file=sys.stderr)
        return 2
    records = [{"top": design.top, "significand": bits, "exponent": 8, "target": LIBRARY.name, "flow": FLOW, **got}
               for (bits, design), got in zip(designs(), results, strict=True) if got]
    (store.OUT / "energies.json").write_text(json.dumps(
        {"operations": tests.OPERATIONS, "results": records}, indent=1) + "\n")
    print(table(records))
    for failure in failures:
        print("failed:", failure, file=sys.stderr)
    return 1 if failures else 0


def table(records: list[dict]) -> str:
    """A row for each format: pJ of each core's operation and of a test."""
    rows = []
    for bits in SIGNIFICANDS:
        spent = {got["top"]: got["pj"] for got in records if got["significand"] == bits}
        if len(spent) == len(tests.OPERATIONS):
            whole = sum(count * spent[top] for top, count in tests.OPERATIONS.items())
            rows.append([f"1+8+{bits - 1}", *(f"{spent[top]:,.0f}" for top in tests.OPERATIONS),
                         f"{whole / 1000:.2f}"])
    return tables.markdown(["format", "multiply, pJ", "add, pJ", "divide, pJ", "a test, nJ"], rows)


if __name__ == "__main__":
    sys.exit(main())
