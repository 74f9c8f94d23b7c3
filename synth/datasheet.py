"""Fills what hw/README.md holds between its marks, from the sources and from what was measured.

`python3 -m synth.datasheet` writes the text and draws the diagrams; with `--check` it changes nothing, and
its exit status is 1 where a declaration, a table of modules, a quotation or a timing diagram is out of
date, or where the example does not pass Verilator. A mark is `<!-- KIND ARGUMENTS -->`, its text ends at
`<!-- end -->`:

  modules CORE               a table of the modules of a core
  declaration MODULE         its header and its declaration, word for word
  section FILE | TITLE       what stands in FILE under the comment `// ---- TITLE`
  lines FILE | EXPRESSION    the lines of FILE that match
  figures                    area and time of some designs, measured where they have changed
  fpga                       the units that `make fpga` has placed; where none are, the old text stays
"""

import dataclasses
import difflib
import pathlib
import re
import subprocess
import sys

from synth import catalogue, cores, fpga, measure, store, tables, tools, waveform

README = cores.HW / "README.md"
DIAGRAMS = cores.HW / "diagrams"
MARK = re.compile(r"<!-- (\w+)((?: [^\n]*?)?) -->\n(.*?)<!-- end -->", re.S)


def source(module: str) -> pathlib.Path:
    """The file of a module or package; raises ValueError where there is none."""
    for core in cores.names():
        file = cores.HW / core / f"{module}.sv"
        if file.exists():
            return file
    raise ValueError(f"{README}: no module {module} in hw/")


def header(text: str) -> str:
    """The comment that a file begins with, as one text with a newline between paragraphs."""
    lines = [line[2:].strip() for line in re.match(r"(?://.*\n)*", text)[0].splitlines()]
    return re.sub(r"\s*\n\s*\n\s*|(?<=\S)\n(?=\S)",
                  lambda gap: " " if gap[0] == "\n" else "\n", "\n".join(lines)).strip()


def sentences(text: str) -> list[str]:
    """Its sentences, without the full stop; the one in `I . N` ends none."""
    return [part.strip() for part in re.split(r"(?<=[^\s.])\.(?=\s|$)|\n", text) if part.strip()]


def modules(core: str) -> str:
    """What each module of a core is, and what its header says of its latency."""
    rows = []
    for file in cores.files(core):
        if file.parent.name != core or file.stem.endswith("_pkg"):
            continue
        said = sentences(header(file.read_text()))
        latency = next((part for word in ("latency", "^combinational", "throughput") for part in said[1:]
                        if re.search(rf"{word}\b", part, re.I)), "")
        rows.append([f"[{file.stem}]({core}/{file.name})", *(re.sub(r"([|*])", r"\\\1", text)
                                                           for text in (said[0], latency))])
    return "\n".join(f"| {' | '.join(row)} |" for row in [
        ["module", "what it is", "latency"], ["---"] * 3, *rows]) + "\n"


def declaration(module: str) -> str:
    """The header and the declaration, as code."""
    text = source(module).read_text()
    found = re.match(rf".*?^module {module}\b.*?^\);$", text, re.M | re.S)
    if not found:
        raise ValueError(f"{source(module)}: expected the declaration of {module}")
    return (f"<details><summary><code>{module}</code></summary>\n\n```systemverilog\n{found[0]}\n```\n\n"
            "</details>\n")


def quoted(argument: str, pattern: str) -> str:
    """What matches in a file, as code; `argument` is FILE | WHAT, WHAT takes the place of %s."""
    file, what = (part.strip() for part in argument.split("|"))
    found = re.findall(pattern % what, (tools.ROOT / file).read_text(), re.M | re.S)
    if not found:
        raise ValueError(f"{README}: {file} holds no {what}")
    language = {".sv": "systemverilog", ".h": "cpp", ".cpp": "cpp"}[pathlib.Path(file).suffix]
    lines = "\n".join(found).strip("\n").splitlines()
    margin = min(len(line) - len(line.lstrip()) for line in lines if line)
    return f"```{language}\n" + "\n".join(line[margin:] for line in lines) + "\n```\n"


# Design of the catalogue -> the flow that is shown.
SHOWN = {"adder-graded": "fast", "booth-graded-ripple-groups": "fast", "fp-multiplier": "fast",
         "fp-adder": "fast", "fp-divider": "area", "hit_test_unit": "parts", "general_hit_test_unit": "parts",
         "hit_test_pipeline": "parts"}


def figures() -> str:
    """Area and slowest path of some designs; what was measured before is not measured again."""
    library = catalogue.LIBRARIES[0]
    rows = [dataclasses.replace(row, flows={library.name: (SHOWN[row.design.name],)})
            for row in catalogue.report_rows() if row.design.name in SHOWN]
    records, failures = measure.measure(rows, measure.Targets((library.name,)))
    if failures:
        raise tools.ToolFailed("\n".join(failures))
    return f"{library.title}, {' and '.join(versions())}.\n\n" + tables.markdown(
        ["design", "flow", "area, mm2", "slowest path, ns", "MHz"],
        [[record["design"], record["flow"], f"{record['area'] / 1e6:.3f}", f"{record['delay_ns']:.2f}",
          f"{1000 / record['delay_ns']:.1f}" if "from" in record else ""] for record in records])


def versions() -> list[str]:
    """The tools behind the figures."""
    return [f"Yosys {tools.version('yosys')}", f"OpenSTA {tools.version('sta')}"]


KINDS = {"modules": modules, "declaration": declaration,
         "section": lambda argument: quoted(argument, r"^ *// ---- %s\n(?: *//\n|\n)*(.*?)(?=^ *// ----|^endpackage)"),
         "lines": lambda argument: quoted(argument, r"^[^\n]*%s[^\n]*$")}
MEASURED = {"figures": figures, "fpga": fpga.table}


def filled(text: str, measured: bool = True) -> str:
    """The text with what its marks stand for; raises ValueError for what isn't there."""
    def fill(mark: re.Match) -> str:
        kind, argument, old = (part.strip(" ") for part in mark.groups())
        if kind in MEASURED:
            new = measured and MEASURED[kind]() or old
        elif kind in KINDS:
            new = KINDS[kind](argument)
        else:
            raise ValueError(f"{README}: found the mark {kind}, expected one of {', '.join(KINDS)}")
        head = f"<!-- {kind} {argument}".rstrip() + " -->"
        return f"{head}\n{new}<!-- end -->"

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


def write() -> None:
    """Fills the text and draws the diagrams."""
    from synth import diagram  # by graphviz

    README.write_text(filled(README.read_text()))
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
    text = README.read_text()
    wanted = filled(text, measured=False)
    lines = list(difflib.unified_diff(text.splitlines(), wanted.splitlines(), "hw/README.md", "the sources",
                                      n=0, lineterm=""))
    for file in DIAGRAMS.glob("*.json"):
        if file.with_suffix(".svg").read_text() != waveform.render(file):
            lines.append(f"{file.with_suffix('.svg')}: is not what WaveDrom makes of {file.name}")
    lint(text)
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
        print(*wrong, "Out of date: make datasheet", sep="\n")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
