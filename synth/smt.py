"""Converts modules to SMT-LIB with Yosys and solves queries with Bitwuzla."""

import functools
import importlib.metadata
import importlib.util
import json
import pathlib
import re
import sys
from collections.abc import Iterable

from synth import tools, yosys

# Commands that flatten a design, and make its assertions, assumptions and covers apply in every state, instead of at clock edges.
FLAT = "flatten -noscopeinfo\nopt\nsetparam -set TRG_ENABLE 0 t:$check\nchformal -lower"
PROOFS = pathlib.Path(__file__).resolve().parent / "proofs"
FLOAT = PROOFS / "float"
FREE = PROOFS / "free.v"


def read(sources: Iterable[pathlib.Path], top: str, parameters: Iterable[tuple[str, object]] = ()) -> str:
    """Returns the commands that elaborate `top`. Words declared (* anyseq *) or (* anyconst *) become free variables for the solver."""
    return f"""{yosys.read(sources, top, parameters)}
techmap -map {FREE} a:anyseq %ci1 t:$buf %i
techmap -map {FREE} -D CONSTANT a:anyconst %ci1 t:$buf %i
select -assert-none w:* a:anyseq %i t:$anyseq %co1 %d w:* a:anyconst %i t:$anyconst %co1 %d %u
setattr -unset anyseq -unset anyconst w:*"""


def state(model: str, top: str, name: str, before: str = "",
          given: dict[str, str] | None = None) -> str:
    """Returns SMT-LIB that declares state `name` of a module: the successor of state `before`, or any state if `before` is "". Registers
    are defined as terms of `before`, not by equations, so that the solver shares equal logic of two states. `given`: terms of inputs."""
    width = int(re.search(rf"\(define-sort \|{re.escape(top)}_s\| \(\) \(_ BitVec (\d+)\)\)", model)[1])
    fields = re.findall(r"^\(define-fun \|(\S+#\d+)\| .*\(\(_ extract (\d+) (\d+)\) state\).* ; (.*)$",
                        model, re.M)
    following = re.findall(r"^  \(= (.*) \(\|(\S+#\d+)\| next_state\)\)", model, re.M)
    next_of = {field: re.sub(r"\bstate\b", before, term) for term, field in following if before}
    known = []
    for field, high, low, called in fields:
        wire = re.fullmatch(r"(?:.*[.\\])?(\w+)(?: \[(\d+)(?::(\d+))?\])?", called)
        if field in next_of:
            known.append((int(high), int(low), next_of[field]))
        elif given and wire and wire[1] in given:
            bits = f"(_ extract {wire[2]} {wire[3] or wire[2]})" if wire[2] else ""
            known.append((int(high), int(low), f"({bits} {given[wire[1]]})" if bits else given[wire[1]]))
    parts, top_bit = [], width - 1
    for high, low, term in sorted(known, reverse=True):
        if high < top_bit:
            parts.append(f"((_ extract {top_bit} {high + 1}) any_{name})")
        parts.append(term)
        top_bit = low - 1
    if top_bit >= 0:
        parts.append(f"((_ extract {top_bit} 0) any_{name})")
    word = functools.reduce(lambda upper, lower: f"(concat {upper} {lower})", parts)
    return (f"(declare-const any_{name} |{top}_s|)\n"
            f"(define-fun {name} () |{top}_s| {word})\n")


def ports(model: str, top: str, suffix: str = "", before: str = "",
          given: dict[str, str] | None = None) -> tuple[str, list[str]]:
    """Returns SMT-LIB for a state (see `state`), with names for the module's ports and for wires that contracts leave free ("free_...",
    with the index of their generate block). Each name ends in `suffix`. Also returns these names without `suffix`."""
    text = [state(model, top, f"state{suffix}", before, given)]
    names = []
    pattern = re.compile(rf"\(define-fun \|({top}_n (\S+))\| \(\(state \|{top}_s\|\)\) "
                         r"(\([^)]*\)|Bool)")
    for function, wire, sort in pattern.findall(model):
        found = re.fullmatch(r"(?:.*\[(\d+)\])?(?:.*\.)?(free_\w+)", wire)
        name = wire
        if found:
            name = found[2] + (f"_{found[1]}" if found[1] else "")
        elif not re.fullmatch(r"\w+_[io]", wire):
            continue
        text.append(f"(define-fun {name}{suffix} () {sort} (|{function}| state{suffix}))")
        names.append(name)
    return "\n".join(text) + "\n", names


def write_model(sources: list[pathlib.Path], top: str, parameters: str, folder: pathlib.Path,
                keep: pathlib.Path | None = None) -> str:
    """Returns a module with parameters ("Name value ...") as SMT-LIB: one function of the state per wire. The state includes inputs and the
    wires that contracts leave free. Writes the netlist to `keep`, if given, for fault injection."""
    smt2, words = folder / "model.smt2", parameters.split()
    yosys.run("\n".join([read(sources, top, zip(words[::2], words[1::2])), FLAT,
                         *([f"write_rtlil {keep}"] if keep else []), f"dffunmap\nwrite_smt2 -stbv -wires {smt2}"]),
              folder / "yosys.log")
    return smt2.read_text()


def version() -> str:
    """Returns the version of Bitwuzla, or "" if Bitwuzla is not installed."""
    try:
        return importlib.metadata.version("bitwuzla")
    except importlib.metadata.PackageNotFoundError:
        return ""


def solve(file: pathlib.Path, text: str, terms: tuple[str, ...] = (), limit: float = 0) -> dict:
    """Writes the query `text` to `file` and returns Bitwuzla's answer. For `terms`, `limit` and the answer see proofs/float/solve.py."""
    if importlib.util.find_spec("bitwuzla") is None:
        raise tools.MissingTool("Bitwuzla is not installed: pip install -r synth/requirements.txt")
    file.write_text(text + "(check-sat)\n")
    out = tools.run([sys.executable, FLOAT / "solve.py", file, limit, *terms],
                    file.with_suffix(".log"))
    return json.loads(out.splitlines()[-1])
