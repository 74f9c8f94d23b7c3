"""Modules that someone brings in place of one of hw/'s: read, checked, put behind the ports of what they replace, proven.

A brought module has the ports of the module it replaces, and its parameters that say how wide they are; its name is free.
It may use modules of hw/ and of its own file. `bring` writes a folder with a file of the replaced module's name, which
Verilator (PATCHES of sim/verilate.cmake) and all of synth (`in_place`) then read instead of hw/'s.
"""

import contextlib
import dataclasses
import functools
import hashlib
import json
import pathlib
import re
import subprocess
from collections.abc import Callable, Iterator

from synth import catalogue, cores, float_proofs, mapping, prove, store, tools, yosys
from synth.assertions import Proof, holds

# What they are checked with, so that a width written as a number is found.
SAMPLES = {"Width": 13, "ExpWidth": 6, "FracWidth": 13}
SAT_WIDTH, MOST_PRODUCTS = 5, 11  # of multipliers: bits that SAT does in one piece; bits of which every product is tried


@dataclasses.dataclass(frozen=True)
class Place:
    """What is replaced. `proofs`: of it, in a unit; `told`: of a counterexample of theirs, what the module says and what is
    right."""
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


# By the word of make's command line. Adders of every kind go through `adder`: a brought one is its prefix adder.
PLACES = {
    "ADDER": Place("prefix_adder", _adds, _sum),
    "MULTIPLIER": Place("booth_multiplier", _multiplies,
                        lambda values: ({"product": values["product"]}, {"product": values["a"] * values["b"]})),
    "DIVIDER_ROW": Place("srt_row", _floats(*(("srt_row", form) for form in ("binary16", "bfloat16", "binary32")))),
    "ROUNDER": Place("fp_round", _floats(("multiply", "binary16"), ("add", "binary16")))}
CALLED = {"carry": "carry in", "carry_out": "carry out"}  # ports of the proofs, in words


def folder_of(files: dict[str, str]) -> pathlib.Path:
    """Where `bring` puts them; raises ValueError where one cannot be read."""
    try:
        texts = {word: [name, pathlib.Path(name).read_text()] for word, name in files.items()}
    except (OSError, UnicodeDecodeError) as error:
        raise ValueError(f"{getattr(error, 'filename', '')}: {getattr(error, 'strerror', None) or 'expected text'}") from error
    return store.OUT.parent / "brought" / hashlib.sha256(json.dumps(texts, sort_keys=True).encode()).hexdigest()[:12]


def bring(files: dict[str, str]) -> pathlib.Path:
    """Checks the files, by words of PLACES, and writes the folder. Raises ValueError, "FILE:LINE: what is wrong"."""
    folder = folder_of(files)
    for word, name in files.items():
        original = next(catalogue.HW.glob(f"*/{PLACES[word].module}.sv"))
        text, top = _own_names(name)
        if re.search(rf"\b{original.stem}\b", _bare(text)):
            _fail(name, text, top, f"uses {original.stem}, whose place it takes")
        _lint(name, text, top, folder / "lint")
        _fits(name, text, top, original, folder / "lint")
        header = re.search(r"^module .*?^\);", original.read_text(), re.M | re.S)[0]
        parameters = ", ".join(f".{one}({one})" for one in _parameters(header) if one in _parameters(text))
        ports = ", ".join(f".{port}({port})" for port in _ports(original.stem, original, folder / "lint"))
        store.replace(folder / original.name, f"{header}\n  {top} #({parameters}) u_brought ({ports});\nendmodule\n{text}")
    return folder


def _bare(text: str) -> str:
    """Without comments, each line where it was."""
    return re.sub(r"//[^\n]*|/\*.*?\*/", lambda found: "\n" * found[0].count("\n"), text, flags=re.S)


def _own_names(name: str) -> tuple[str, str]:
    """The file's text, its modules of hw/'s names renamed, and the module that is meant: the one of the file's name, or the
    last that no other of them uses."""
    text = pathlib.Path(name).read_text()
    declared = re.findall(r"^\s*module\s+(?:automatic\s+)?(\w+)", _bare(text), re.M)
    if not declared:
        raise ValueError(f"{name}:1: found no module")
    tops = [module for module in declared if not re.search(rf"(?<!module) \b{module}\s*(#\s*\(|\w+\s*\()", _bare(text))]
    top = pathlib.Path(name).stem if pathlib.Path(name).stem in declared else (tops or declared)[-1]
    for module in declared:
        if any(catalogue.HW.glob(f"*/{module}.sv")):
            text = re.sub(rf"(?<![.\w]){module}\b", f"{module}_brought", text)
            top = f"{module}_brought" if top == module else top
    return f'`line 1 "{name}" 0\n{text}\n', top


def _parameters(text: str) -> list[str]:
    return re.findall(r"\bparameter\b[^=;]*?(\w+)\s*=", _bare(text))


def _fail(name: str, text: str, top: str, what: str) -> None:
    """At the line of the module."""
    line = next(number for number, line in enumerate(_bare(text).splitlines()) if re.search(rf"\bmodule\s+.*?{top}\b", line))
    raise ValueError(f"{name}:{line}: module {top.removesuffix('_brought')}: {what}")


def _lint(name: str, text: str, top: str, folder: pathlib.Path) -> None:
    """Verilator's lint, without what a beginner may leave as it is: widths, which the proof judges, and words that feed
    themselves, which are slow to simulate."""
    file = folder / f"{top}.sv"
    store.replace(file, text)
    packages = [each for core in ("arith", "fp") for each in cores.files(core) if each.stem.endswith("_pkg")]
    sizes = [f"-G{key}={value}" for key, value in SAMPLES.items() if key in _parameters(text)]
    done = subprocess.run(
        [tools.find("verilator"), "--lint-only", "-Wno-style", "-Wno-WIDTH", "-Wno-UNOPTFLAT", "--top-module", top, *sizes,
         *(f"-I{catalogue.HW / each}" for each in ("common", "arith", "fp")), *dict.fromkeys(packages), file],
        capture_output=True, text=True, check=False)
    found = re.search(r"^%(?:Error|Warning)(?:-\w+)?: (\S+?:\d+:\d+: .*)$", done.stderr, re.M)
    if found or done.returncode:
        raise ValueError(found[1] if found else f"{name}: {done.stderr}")


def _ports(top: str, file: pathlib.Path, folder: pathlib.Path) -> dict[str, tuple[str, int]]:
    """Directions and widths of a module's ports, by Yosys, at the sizes of SAMPLES. Raises ValueError where it cannot read it."""
    files = {each.stem: each for core in ("arith", "fp") for each in cores.files(core)} | {file.stem: file}
    sizes = [(key, value) for key, value in SAMPLES.items() if key in _parameters(file.read_text())]
    out = folder / f"{top}.json"
    try:
        yosys.run(f"{yosys.read(cores.used(file.stem, [*files.values()]), top, sizes)}\nwrite_json {out}", folder / f"{top}.log")
    except tools.ToolFailed as error:
        said = re.search(r"^(\S+:\d+): ERROR: (.*)$", str(error), re.M) or re.search(r"^(ERROR): (.*)$", str(error), re.M)
        raise ValueError(f"{said[1]}: {said[2]}" if said else str(error)) from error
    return {port: (each["direction"], len(each["bits"])) for port, each in mapping.top_module(out)["ports"].items()}


def _fits(name: str, text: str, top: str, original: pathlib.Path, folder: pathlib.Path) -> None:
    wanted = _ports(original.stem, original, folder)
    expected = f"expected as in hw/{original.parent.name}/{original.name}"
    for size in SAMPLES.keys() & set(_parameters(original.read_text())) - set(_parameters(text)):
        _fail(name, text, top, f"has no parameter {size}, {expected}")
    mine = _ports(top, folder / f"{top}.sv", folder)
    for port in {**wanted, **mine}:
        found, right = (f"{each[port][0]} of {each[port][1]} bits" if port in each else "no such port" for each in (mine, wanted))
        if found != right:
            sizes = ", ".join(f"{key} = {SAMPLES[key]}" for key in SAMPLES if key in _parameters(text))
            _fail(name, text, top, f"{port}: found {found}, {expected}: {right} ({sizes})")


@contextlib.contextmanager
def in_place(folder: pathlib.Path) -> Iterator[None]:
    """All of synth reads the files of a folder instead of hw/'s, and keeps results there."""
    before = store.OUT
    store.OUT, cores.replaced = folder / "synth", folder
    try:
        yield
    finally:
        store.OUT, cores.replaced = before, None


def widths(module: str, unit: catalogue.Design) -> list[int]:
    """The widths of a module's a_i within a unit."""
    out = store.OUT / "widths.json"
    yosys.run(f"{yosys.read(unit.sources(), unit.top, unit.parameters)}\nwrite_json {out}", out.with_suffix(".log"))
    return sorted({len(found["ports"]["a_i"]["bits"]) for name, found in json.loads(out.read_text())["modules"].items()
                   if name.startswith(f"{module}$")})


def in_words(word: str, claim: str, values: dict[str, str]) -> str:
    """A counterexample: the values that go in, what the module says, and what is right; decimal and hexadecimal."""
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
    """A row for each claim about the modules of a folder that `bring` has written, the first that does not hold being the
    last of its module: module, claim, how, holds, and `counterexample` in words."""
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
