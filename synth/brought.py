"""Reads, checks and proves user-supplied modules that replace modules of hw/, and wraps them in the replaced modules' ports.

A user's module may have any name. It must have the ports and the width parameters of the module that it replaces. It may use modules of
hw/ and of its own file. `bring` writes a folder with a file named like the replaced module. Verilator (PATCHES of sim/verilate.cmake) and
all of synth (`in_place`) then read this file instead of the one in hw/.
`python3 -m synth.brought ADDER=my.sv ...` only checks the files and writes the folder.
"""

import codecs
import contextlib
import dataclasses
import functools
import hashlib
import itertools
import json
import pathlib
import re
import subprocess
import sys
import urllib.parse
from collections.abc import Callable, Iterator
from typing import NoReturn

from pyslang import driver, syntax

from synth import catalogue, cores, float_proofs, prove, store, tools, yosys
from synth.assertions import Proof, holds

# Parameter values for the check. They are unusual, to detect widths that are written as numbers.
SAMPLES = {"Width": 13, "ExpWidth": 6, "FracWidth": 13}
FOLDERS = "common", "arith", "fp"  # folders of hw/ with the modules that a user's module may use
SAT_WIDTH, MOST_PRODUCTS = 5, 11  # multiplier widths in bits: proven by SAT as a whole; at most, tested by simulating every product


@dataclasses.dataclass(frozen=True)
class Place:
    """A module of hw/ that users may replace. `proofs`: returns the module's proofs for a unit. `told`: returns, for the values of a
    counterexample, the module's outputs and the correct outputs."""
    module: str
    proofs: Callable[[catalogue.Design], list[Proof]]
    told: Callable[[dict[str, int]], tuple[dict[str, int], dict[str, int]]] | None = None


def _adds(unit: catalogue.Design) -> list[Proof]:
    return [Proof(f"adder.{width}", f"carry, sum = a + b + carry at {width} bits", "SAT",
                  functools.partial(prove.adds, catalogue.design("adder", adder="prefix", Width=width)))
            for width in widths("prefix_adder", unit)]


def _multiplies(unit: catalogue.Design) -> list[Proof]:
    digits = int(dict(unit.parameters).get("FracWidth", 23)) + 1
    most = min(digits, MOST_PRODUCTS)
    return [Proof(f"multiplier.{SAT_WIDTH}", f"product = a * b at {SAT_WIDTH} bits", "SAT", lambda: holds(
                "booth_multiplies", sources=cores.used("booth_multiplier", cores.files("arith")),
                parameters=(("Width", SAT_WIDTH),))),
            Proof(f"multiplier.{most}", f"product = a * b at {most} bits", "simulation",
                  functools.partial(prove.every_product, most))]


def _floats(*which: tuple[str, str]) -> Callable[[catalogue.Design], list[Proof]]:
    proofs = [float_proofs.FloatProof(operation, form, "graded") for operation, form in which]
    return lambda _: [Proof(one.name, f"{one.says} ({one.format})", "Bitwuzla", functools.partial(float_proofs.proven, one)) for one in proofs]


def _sum(values: dict[str, int]) -> tuple[dict[str, int], dict[str, int]]:
    carry, total = divmod(values["a"] + values["b"] + values["carry in"], 2 ** values["width"])
    return ({"sum": values["sum"], "carry out": values["carry out"]}, {"sum": total, "carry out": carry})


# Replaceable modules by the name of make's variable. A user's adder replaces the prefix adder, one of the kinds that `adder` instantiates.
PLACES = {
    "ADDER": Place("prefix_adder", _adds, _sum),
    "MULTIPLIER": Place("booth_multiplier", _multiplies,
                        lambda values: ({"product": values["product"]}, {"product": values["a"] * values["b"]})),
    "DIVIDER_ROW": Place("srt_row", _floats(*(("srt_row", form) for form in ("binary16", "bfloat16", "binary32")))),
    "ROUNDER": Place("fp_round", _floats(("multiply", "binary16"), ("add", "binary16")))}
CALLED = {"carry": "carry in", "carry_out": "carry out"}  # descriptions of ports in the proofs


def folder_of(files: dict[str, str]) -> pathlib.Path:
    """Returns the folder that `bring` writes for these files. Raises ValueError if one of them cannot be read."""
    texts = {word: [name, _read(name)] for word, name in files.items()}
    return store.OUT.parent / "brought" / hashlib.sha256(json.dumps(texts, sort_keys=True).encode()).hexdigest()[:12]


def bring(files: dict[str, str]) -> pathlib.Path:
    """Checks the files, given by key of PLACES, writes their folder and returns it. Raises ValueError ("FILE:LINE: ...") for a bad file."""
    folder = folder_of(files)
    for word, name in files.items():
        original = next(catalogue.HW.glob(f"*/{PLACES[word].module}.sv"))
        module = _module(name, original.stem)
        file = folder / "lint" / f"{module.top}.sv"
        store.replace(file, module.text)
        (wanted, right), (parameters, ports) = _elaborated(original.stem, original), _elaborated(module.top, file)
        _lint(module.top, file, parameters)
        expected = f"expected as in hw/{original.parent.name}/{original.name}"
        for size in SAMPLES:
            if size in wanted and size not in parameters:
                module.fail(f"has no parameter {size}, {expected}")
        sizes = ", ".join(f"{key} = {SAMPLES[key]}" for key in SAMPLES if key in parameters)
        for port in {**right, **ports}:
            if ports.get(port) != right.get(port):
                found, other = (each.get(port, "no such port") for each in (ports, right))
                module.fail(f"{port}: found {found}, {expected}: {other} ({sizes})")
        header = re.search(r"^module .*?^\);", original.read_text(), re.M | re.S)[0]
        overrides, connections = (", ".join(f".{one}({one})" for one in names)
                                  for names in ([one for one in wanted if one in parameters], right))
        store.replace(folder / original.name,
                      f"{header}\n  {module.top} #({overrides}) u_brought ({connections});\nendmodule\n{module.text}")
    return folder


@dataclasses.dataclass(frozen=True)
class _Module:
    """A user's file: its text, with modules renamed that have names of hw/; its top module; and the line with the top module's name."""
    file: str
    text: str
    top: str
    line: int

    def fail(self, what: str) -> NoReturn:
        raise ValueError(f"{self.file}:{self.line}: module {self.top.removesuffix('_brought')}: {what}")


def _read(name: str) -> str:
    """Returns the text of a file in UTF-8, with or without a byte order mark, or in UTF-16 with one. Replaces invalid bytes."""
    try:
        data = pathlib.Path(name).read_bytes()
    except OSError as error:
        raise ValueError(f"{name}: {error.strerror}") from error
    text = data.decode("utf-16" if data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)) else "utf-8-sig", "replace")
    return text.replace("\r\n", "\n").replace("\r", "\n")


def _module(name: str, replaced: str) -> _Module:
    """Reads a user's file. The top is the module with the file's name, or else the last module that no other module uses. Removes time
    scales: the modules of hw/ have none, and tools reject a mixture."""
    text = _read(name).encode()
    tree = syntax.SyntaxTree.fromText(text.decode(), name)
    modules, instances = {}, []
    edits = [(*found.span(), b"") for found in re.finditer(rb"`timescale\s+\d+\s*\w+\s*/\s*\d+\s*\w+", text)]

    def take(node: object) -> None:
        kind = getattr(node, "kind", None)
        if kind == syntax.SyntaxKind.ModuleDeclaration:
            modules[node.header.name.valueText] = [node.header.name, *([node.blockName.name] if node.blockName else [])]
        elif kind == syntax.SyntaxKind.HierarchyInstantiation:
            instances.append(node.type)
        elif kind == syntax.SyntaxKind.TimeUnitsDeclaration:
            edits.append((node.sourceRange.start.offset, node.sourceRange.end.offset, b""))

    tree.root.visit(take)
    if not modules:
        raise ValueError(f"{name}:1: found no module")
    used = [token.valueText for token in instances]
    tops = [each for each in modules if each not in used] or [*modules]
    top = pathlib.Path(name).stem if pathlib.Path(name).stem in modules else tops[-1]
    for token in [*itertools.chain(*modules.values()), *instances]:
        if token.valueText in modules and any(catalogue.HW.glob(f"*/{token.valueText}.sv")):
            edits.append((token.range.end.offset, token.range.end.offset, b"_brought"))
    for start, end, by in sorted(edits, reverse=True):
        text = text[:start] + by + text[end:]
    # The file name is percent-encoded because Yosys cannot read a file name with a blank.
    module = _Module(name, f'`line 1 "{urllib.parse.quote(name)}" 0\n{text.decode()}\n`resetall\n',
                     f"{top}_brought" if any(catalogue.HW.glob(f"*/{top}.sv")) else top,
                     tree.sourceManager.getLineNumber(modules[top][0].location))
    if replaced in used and replaced not in modules:
        module.fail(f"uses {replaced}, whose place it takes")
    return module


def _packages() -> list[pathlib.Path]:
    return [*dict.fromkeys(each for core in ("arith", "fp") for each in cores.files(core) if each.stem.endswith("_pkg"))]


def _elaborated(top: str, file: pathlib.Path) -> tuple[list[str], dict[str, str]]:
    """Elaborates a module with slang, with the parameter values of SAMPLES. Returns the module's parameters and, by name, its ports'
    directions and widths. Raises ValueError for the first error."""
    slang = driver.Driver()
    slang.sourceManager.setDisableProximatePaths(True)
    slang.addStandardArgs()
    words = [f"--top={top}", "-DSYNTHESIS", *(f"-G{key}={value}" for key, value in SAMPLES.items()),
             *(f'-y"{catalogue.HW / each}"' for each in FOLDERS), *(f'"{each}"' for each in (*_packages(), file))]
    _ = slang.parseCommandLine(" ".join(["slang", *words])) and slang.processOptions() and slang.parseAllSources()
    compilation, place = slang.createCompilation(), slang.sourceManager
    for error in compilation.getAllDiagnostics():
        if error.isError():
            at = error.location
            name = urllib.parse.unquote(place.getFileName(at)).removeprefix(f"{file.parent}/")  # slang adds the folder of the copy
            raise ValueError(f"{name}:{place.getLineNumber(at)}:{place.getColumnNumber(at)}: "
                             f"{slang.diagEngine.formatMessage(error)}")
    body = compilation.getRoot().topInstances[0].body
    directions = {"In": "input", "Out": "output"}
    return ([each.name for each in body.parameters if not each.isLocalParam],
            {port.name: f"{directions.get(port.direction.name, 'inout')} of {port.type.bitWidth} bits" for port in body.portList})


def _lint(top: str, file: pathlib.Path, parameters: list[str]) -> None:
    """Runs Verilator's lint without two warnings that a beginner may ignore: WIDTH, because the proof checks widths, and UNOPTFLAT, because
    combinational loops between bits of one word are only slow to simulate. Raises ValueError for the first warning."""
    done = subprocess.run(
        [tools.find("verilator"), "--lint-only", "-Wno-style", "-Wno-WIDTH", "-Wno-UNOPTFLAT", "--top-module", top,
         *(f"-G{key}={value}" for key, value in SAMPLES.items() if key in parameters),
         *(f"-I{catalogue.HW / each}" for each in FOLDERS), *_packages(), file], capture_output=True, text=True, check=False)
    found = re.search(r"^%(?:Error|Warning)(?:-\w+)?: (\S+?:\d+:\d+: .*)$", done.stderr, re.M)
    if found or done.returncode:
        raise ValueError(urllib.parse.unquote(found[1]) if found else f"{file}: {done.stderr}")


@contextlib.contextmanager
def in_place(folder: pathlib.Path) -> Iterator[None]:
    """Makes all of synth read the files of `folder` instead of those of the same names in hw/, and keep results in `folder`."""
    before = store.OUT
    store.OUT, cores.replaced = folder / "synth", folder
    try:
        yield
    finally:
        store.OUT, cores.replaced = before, None


def widths(module: str, unit: catalogue.Design) -> list[int]:
    """Returns the different widths of port a_i among the instances of `module` in a unit, in ascending order."""
    out = store.OUT / "widths.json"
    yosys.run(f"{yosys.read(unit.sources(), unit.top, unit.parameters)}\nwrite_json {out}", out.with_suffix(".log"))
    return sorted({len(found["ports"]["a_i"]["bits"]) for name, found in json.loads(out.read_text())["modules"].items()
                   if name.startswith(f"{module}$")})


def in_words(word: str, claim: str, values: dict[str, str]) -> str:
    """Describes a counterexample to `claim`: inputs, outputs and correct outputs, in decimal and hexadecimal. `word`: a key of PLACES."""
    def number(name: str, value: int) -> str:
        size = sizes.get(name, max(value.bit_length(), 1))
        return f"{name} = {value:,}" + (f" (0x{value:0{-(-size // 4)}X})" if size > 1 else "")

    sizes = {CALLED.get(name, name): len(bits) for name, bits in values.items()}
    known = {CALLED.get(name, name): int(bits.replace("x", "0"), 2) for name, bits in values.items() if re.fullmatch("[01x]+", bits)}
    said, right = PLACES[word].told({**known, "width": sizes["a"]}) if PLACES[word].told else ({}, {})
    given = ", ".join(number(name, value) for name, value in known.items() if name not in said)
    answers = (f": it says {', '.join(number(*each) for each in said.items())}; right is "
               f"{', '.join(number(*each) for each in right.items())}") if said else ""
    return f"{claim}: refuted by {given}{answers}"


def judge(files: dict[str, str], unit: catalogue.Design) -> list[dict]:
    """Proves the claims about files that `bring` has checked; stops at a module's first claim that does not hold. Returns a row per claim:
    word (key of PLACES), file, claim, how, holds, seconds if proven, and `counterexample` in words."""
    rows = []
    with in_place(folder_of(files)):
        for word, name in files.items():
            for proof in PLACES[word].proofs(unit):
                row = {"table": "proofs", "word": word, "file": name, "claim": proof.claim, "how": proof.how, "holds": True,
                       "counterexample": ""}
                try:
                    row["seconds"] = proof.work()[0]["seconds"]
                except tools.Refuted as error:
                    row |= {"holds": False, "counterexample": in_words(word, proof.claim, error.values)}
                rows.append(row)
                if not row["holds"]:
                    break
    return rows


@tools.command("error")
def main() -> int:
    """Checks the files named on the command line, as in ADDER=my.sv. Returns 2 if a file is refused."""
    files = {word: name for word, _, name in (each.partition("=") for each in sys.argv[1:]) if name.endswith((".sv", ".v"))}
    for word in files.keys() - PLACES.keys():
        raise ValueError(f"{word}={files[word]}: found a file, expected one of {', '.join(PLACES)} with it")
    bring(files)
    return 0


if __name__ == "__main__":
    sys.exit(main())
