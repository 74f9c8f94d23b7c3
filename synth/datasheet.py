"""Writes the table of modules, from the sources and from what was measured.

`python3 -m synth.datasheet` writes it; with `--check` it changes nothing, and its exit status is 1 where the table or what is made
of the registers' page is out of date, or where the example of hw/README.md does not pass Verilator.

hw/modules.csv has all modules: what each is, its latency, and where `make synth` measures it area and time, measured
again where they have changed. The registers' package and header are made of their page, see `synth.registers`.
"""

import csv
import dataclasses
import difflib
import re
import sys

from synth import catalogue, cores, measure, registers, tables, tools

MODULES = cores.HW / "modules.csv"
FIGURES = ["mm2", "ns", "MHz"]
# Design of the catalogue -> the flow that is shown. Adders have look-ahead groups, as in the units.
SHOWN = {"adder-graded-look-ahead": "fast", "booth-graded": "fast", "fp-multiplier": "fast",
         "fp-adder": "fast", "fp-divider": "area", "hit_test_unit": "parts", "general_hit_test_unit": "parts",
         "hit_test_pipeline": "parts", "iterative_hit_test_unit": "parts", "exact_unit": "blocks"}


def header(text: str) -> str:
    """The comment that a file begins with, as one text with a newline between paragraphs."""
    lines = [line[2:].strip() for line in re.match(r"(?://.*\n)*", text)[0].splitlines()]
    return re.sub(r"\s*\n\s*\n\s*|(?<=\S)\n(?=\S)",
                  lambda gap: " " if gap[0] == "\n" else "\n", "\n".join(lines)).strip()


def sentences(text: str) -> list[str]:
    """Its sentences, without the full stop; the one in `I . N` ends none."""
    return [part.strip() for part in re.split(r"(?<=[^\s.])\.(?=\s|$)|\n", text) if part.strip()]


def modules(figures: dict[str, list[str]]) -> str:
    """MODULES: what each module is and what its header says of its latency; `figures`: of the last columns."""
    rows = []
    for core in cores.names():
        for file in cores.files(core):
            if file.parent.name != core or file.stem.endswith("_pkg"):
                continue
            said = sentences(header(file.read_text()))
            latency = next((part for part in said[1:] if re.match(r"(Combinational|Latency|As many clocks)\b", part)), "")
            rows.append({"folder": core, "module": file.stem, "what it is": said[0], "latency": latency.removeprefix("Latency: "),
                         **dict(zip(FIGURES, figures.get(file.stem, ["", "", ""]), strict=True))})
    return tables.comma_separated(rows, ["folder", "module", "what it is", "latency", *FIGURES])


def published(text: str) -> dict[str, list[str]]:
    """The figures in a table that `modules` wrote."""
    return {row["module"]: [row[name] for name in FIGURES] for row in csv.DictReader(text.splitlines())}


def measured_figures() -> dict[str, list[str]]:
    """Area, slowest path and clock rate of some modules; what was measured before is not measured again."""
    library = catalogue.LIBRARIES[0]
    rows = [dataclasses.replace(row, flows={library.name: (SHOWN[row.design.name],)})
            for row in catalogue.report_rows() if row.design.name in SHOWN]
    top = {row.design.name: row.design.top for row in rows}
    records, failures = measure.records(rows, measure.Targets((library.name,)))
    if failures:
        raise tools.ToolFailed("\n".join(failures))
    return {top[record["design"]]: [f"{record['area'] / 1e6:.3f}", f"{record['delay_ns']:.2f}",
                                    f"{1000 / record['delay_ns']:.1f}" if "from" in record else ""]
            for record in records}


def lint(text: str) -> None:
    """The module of the text's first block of SystemVerilog passes Verilator; raises ToolFailed where it doesn't."""
    module, top = re.search(r"```systemverilog\n(module (\w+).*?)```", text, re.S).groups()
    file = tools.ROOT / "build" / "datasheet" / "example.sv"
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(module)
    tools.run(["verilator", "--lint-only", "-Wall", "-Wno-DECLFILENAME", "-Wno-PINCONNECTEMPTY", "--top-module", top,
               *cores.files("hit_test"), file], file.with_suffix(".log"))


def write() -> None:
    """Writes the table of modules and the registers' files."""
    for file, text in registers.made(registers.PAGE.read_text()).items():
        file.write_text(text)
    print(f"datasheet: measuring {len(SHOWN)} designs for {MODULES.relative_to(tools.ROOT)}: several minutes the first time",
          file=sys.stderr, flush=True)
    MODULES.write_text(modules(measured_figures()))


def check() -> list[str]:
    """What is out of date."""
    lines = []
    for file, new in (registers.made(registers.PAGE.read_text()) | {MODULES: modules(published(MODULES.read_text()))}).items():
        lines += difflib.unified_diff(file.read_text().splitlines(), new.splitlines(),
                                      str(file.relative_to(tools.ROOT)), "the sources", n=0, lineterm="")
    lint((cores.HW / "README.md").read_text())
    return lines


@tools.command("datasheet")
def main() -> int:
    """Runs the command line."""
    if sys.argv[1:] not in ([], ["--check"]):
        raise ValueError(f"found {' '.join(sys.argv[1:])}, expected --check or nothing")
    wrong = check() if sys.argv[1:] else write() or []
    if wrong:
        print(*wrong, "Out of date: make synth DATASHEET=1", sep="\n")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
