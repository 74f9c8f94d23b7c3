"""Fills what the pages of hw/ hold between their marks, from the sources and from what was measured.

`python3 -m synth.datasheet` writes the text and draws the diagrams; with `--check` it changes nothing, and
its exit status is 1 where the table of modules or a timing diagram is out of date, or where the example of
hw/fp does not pass Verilator. A mark is `<!-- KIND -->`, its text ends at `<!-- end -->`:

  fpga      the units that `make fpga` has placed; where none are, the old text stays

hw/modules.csv has all modules: what each is, its latency, and where `make synth` measures it area and time, measured
again where they have changed. The registers' package and header are made of their page, see `synth.registers`.
"""

import csv
import dataclasses
import difflib
import pathlib
import re
import subprocess
import sys

from synth import catalogue, cores, fpga, measure, registers, store, tables, tools, waveform

DIAGRAMS = cores.HW / "diagrams"
MARK = re.compile(r"<!-- (?!end)(\w+) -->\n(.*?)<!-- end -->", re.S)
MODULES = cores.HW / "modules.csv"
FIGURES = ["mm2", "ns", "MHz"]
# Design of the catalogue -> the flow that is shown. Adders have look-ahead groups, as in the units.
SHOWN = {"adder-graded-look-ahead": "fast", "booth-graded": "fast", "fp-multiplier": "fast",
         "fp-adder": "fast", "fp-divider": "area", "hit_test_unit": "parts", "general_hit_test_unit": "parts",
         "hit_test_pipeline": "parts", "iterative_hit_test_unit-RowsPerClock1": "parts", "exact_unit": "blocks"}


def pages() -> list[pathlib.Path]:
    """The pages of hw/: one for the whole and one a folder."""
    return [cores.HW / "README.md", *(cores.HW / core / "README.md" for core in cores.names())]


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
    records, failures = measure.measure(rows, measure.Targets((library.name,)))
    if failures:
        raise tools.ToolFailed("\n".join(failures))
    return {top[record["design"]]: [f"{record['area'] / 1e6:.3f}", f"{record['delay_ns']:.2f}",
                                    f"{1000 / record['delay_ns']:.1f}" if "from" in record else ""]
            for record in records}


def filled(page: pathlib.Path, text: str, fpgas: str = "") -> str:
    """The text of a page with what its marks stand for; what was not measured stays. Raises ValueError for another mark."""
    def fill(mark: re.Match) -> str:
        kind, old = mark.groups()
        if kind != "fpga":
            raise ValueError(f"{page}: found the mark {kind}, expected fpga")
        return f"<!-- {kind} -->\n{fpgas or old}<!-- end -->"

    return MARK.sub(fill, text)


def example(text: str) -> str:
    """The module of the text's first block of SystemVerilog."""
    return re.search(r"```systemverilog\n(module .*?)```", text, re.S)[1]


def lint(text: str) -> None:
    """The example passes Verilator; raises ToolFailed where it doesn't."""
    file = tools.ROOT / "build" / "datasheet" / "example.sv"
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(example(text))
    top = re.search(r"module (\w+)", example(text))[1]
    tools.run(["verilator", "--lint-only", "-Wall", "-Wno-DECLFILENAME", "--top-module", top,
               *cores.files("hit_test"), file], file.with_suffix(".log"))


def say(what: str) -> None:
    """A line of progress."""
    print(f"datasheet: {what}", file=sys.stderr, flush=True)


def write() -> None:
    """Fills the text and draws the diagrams."""
    from synth import diagram  # by graphviz

    for file, text in registers.made(registers.PAGE.read_text()).items():
        file.write_text(text)
    say(f"measuring {len(SHOWN)} designs for {MODULES.relative_to(tools.ROOT)}: several minutes the first time")
    MODULES.write_text(modules(measured_figures()))
    say("filling the pages of hw, drawing timing and block diagrams: about a minute")
    fpgas = fpga.table()
    for page in pages():
        page.write_text(filled(page, page.read_text(), fpgas))
    program = tools.ROOT / "build" / "sim" / "worked_example"
    trace = program.with_suffix(".vcd")
    subprocess.run([program, "--trace", trace], check=True, stdout=subprocess.DEVNULL)
    waveform.draw(trace, tools.ROOT / "sim" / "worked_example.gtkw", DIAGRAMS / "worked_example")
    for file in DIAGRAMS.glob("*.json"):
        file.with_suffix(".svg").write_text(waveform.render(file))
    for unit in ("hit_test_unit", "hit_test_pipeline"):
        diagram.draw(unit, store.OUT / unit)
        (DIAGRAMS / f"{unit}.svg").write_text((store.OUT / f"{unit}.svg").read_text())
    diagram.draw("ray_core", store.OUT / "ray_core", 28, diagram.units)  # a line's number has 28 bits
    (DIAGRAMS / "ray_core.svg").write_text((store.OUT / "ray_core.svg").read_text())


def check() -> list[str]:
    """What is out of date."""
    lines = []
    made = registers.made(registers.PAGE.read_text())
    made[MODULES] = modules(published(MODULES.read_text()))
    for file, new in [*made.items(), *((page, filled(page, page.read_text())) for page in pages())]:
        lines += difflib.unified_diff(file.read_text().splitlines(), new.splitlines(),
                                      str(file.relative_to(tools.ROOT)), "the sources", n=0, lineterm="")
    for file in DIAGRAMS.glob("*.json"):
        if file.with_suffix(".svg").read_text() != waveform.render(file):
            lines.append(f"{file.with_suffix('.svg')}: is not what WaveDrom makes of {file.name}")
    lint((cores.HW / "fp" / "README.md").read_text())
    return lines


def main() -> int:
    """Runs the command line."""
    try:
        if sys.argv[1:] not in ([], ["--check"]):
            raise ValueError(f"found {' '.join(sys.argv[1:])}, expected --check or nothing")
        wrong = check() if sys.argv[1:] else write() or []
    except (tools.MissingTool, tools.ToolFailed, OSError, ValueError) as error:
        print(f"datasheet: {error}", file=sys.stderr)
        return 2
    if wrong:
        print(*wrong, "Out of date: make synth DATASHEET=1", sep="\n")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
