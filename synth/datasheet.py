"""Writes hw/modules.md, the table of modules, and those tables of results/README.md that show published CSV files.

`python3 -m synth.datasheet` writes these pages and the files of `synth.registers`. With `--check` it changes nothing; the exit status is
then 1 if a page or a file generated from registers.md is out of date, or if the example of hw/README.md does not pass Verilator.

A module's row has the first sentence of the module's header, latency, throughput, area, delay and memory bits.
"""

import difflib
import pathlib
import re
import sys

from synth import catalogue, cores, measure, registers, store, tables, tools

PAGE = cores.HW / "modules.md"
FLOWS = {"arith": "fast", "fp": "fast", "hit_test": "parts"}  # by folder; other folders: `blocks`
WORDS = 12  # most words of a module's description
INTRO = """\
# Modules

Made by `make synth DATASHEET=1` from headers and measurements: OSU 0.35 um, cells alone, default parameters, flow
`fast` (arith, fp), `parts` (hit_test) or `blocks`. Memories inside a module count in bits. Latency 0 means
combinational. If latency or throughput is empty, the module's header has no such entry.
"""


def header(text: str) -> str:
    """Returns the comment at the beginning of a file as one text, with a newline between paragraphs."""
    lines = [line[2:].strip() for line in re.match(r"(?://.*\n)*", text)[0].splitlines()]
    return re.sub(r"\s*\n\s*\n\s*|(?<=\S)\n(?=\S)", lambda gap: " " if gap[0] == "\n" else "\n", "\n".join(lines)).strip()


def sentences(text: str) -> list[str]:
    """Returns the sentences of a text, without full stops. The dot in `I . N` ends no sentence."""
    return [part.strip() for part in re.split(r"(?<=[^\s.])\.(?=\s|$)|\n", text) if part.strip()]


def stated(said: list[str]) -> list[str]:
    """Returns a module's description, latency in clocks and throughput, from the sentences of its header."""
    def after(word: str) -> str:
        return next((re.split(r"[:;(]", part.removeprefix(f"{word}: "))[0].strip() for part in said if part.startswith(f"{word}: ")), "")
    what = said[0] if len(said[0].split()) <= WORDS else said[0].partition(": ")[0]
    latency = "0" if any(part.startswith("Combinational") for part in said) else re.sub(r" clocks?\b", "", after("Latency"))
    return [what, latency, after("Throughput")]


def modules() -> dict[str, dict[str, pathlib.Path]]:
    """Returns the file of each module, by folder and name."""
    return {core: {file.stem: file for file in cores.files(core) if file.parent.name == core and not file.stem.endswith("_pkg")}
            for core in cores.names()}


def page(figures: dict[str, list[str]]) -> str:
    """Returns the text of PAGE. `figures`: the last three columns (um2, ns, bits) of each module's row."""
    parts = [INTRO]
    for core, files in modules().items():
        parts += [f"## {core}\n", tables.markdown(["module", "what it is", "latency, clocks", "throughput", "um2", "ns", "bits"],
                  [[name, *stated(sentences(header(file.read_text()))), *figures.get(name, [""] * 3)] for name, file in files.items()])]
    return tables.unpadded("\n".join(parts))


def published(text: str) -> dict[str, list[str]]:
    """Returns the `figures` argument from which `page` wrote this text."""
    return {row[1]: row[-4:-1] for row in (line.split("|") for line in text.splitlines() if line.startswith("|"))}


def figures() -> dict[str, list[str]]:
    """Returns area (um2), slowest path (ns) and memory bits of each module. Reuses kept results of unchanged modules."""
    library = catalogue.LIBRARIES[0]
    rows = [catalogue.Row(core, catalogue.design(name), {library.name: (FLOWS.get(core, "blocks"),)})
            for core, files in modules().items() for name in files]
    failures: list[str] = []
    records = [record for _, found in measure.measure(rows, measure.Targets((library.name,)), failures) for record in found]
    if failures:
        raise tools.ToolFailed("\n".join(failures))
    bits = {record["design"]: sum(block["bits"] for block in record.get("blocks", {}).values()) for record in records}
    return {record["design"]: [f"{record['area']:,}", f"{record['delay_ns']:.2f}", f"{bits[record['design']]:,}" if bits[record["design"]] else ""]
            for record in records}


def lint(text: str) -> None:
    """Checks the first module of SystemVerilog in a page with Verilator. Raises ToolFailed if it does not pass."""
    module, top = re.search(r"```systemverilog\n(module (\w+).*?)```", text, re.S).groups()
    file = tools.ROOT / "build" / "datasheet" / "example.sv"
    store.replace(file, module)
    tools.run(["verilator", "--lint-only", "-Wall", "-Wno-DECLFILENAME", "-Wno-PINCONNECTEMPTY", "--top-module", top,
               *cores.files("hit_test"), file], file.with_suffix(".log"))


def made(figures: dict[str, list[str]]) -> dict[pathlib.Path, str]:
    """Returns the contents of all generated files, by file."""
    results = tables.RESULTS / "README.md"
    return registers.made(registers.PAGE.read_text()) | {PAGE: page(figures), results: tables.with_results(results.read_text())}


def write() -> None:
    """Writes the files of `made`."""
    print(f"datasheet: measuring {sum(map(len, modules().values()))} modules: 23 minutes of a processor the first time", file=sys.stderr, flush=True)
    for file, text in made(figures()).items():
        file.write_text(text)


def check() -> list[str]:
    """Returns the differences between the files and their generated contents, as lines of a diff. Raises ToolFailed as `lint` does."""
    lines = []
    for file, new in made(published(PAGE.read_text())).items():
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
