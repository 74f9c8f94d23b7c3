"""Makes SMT-LIB of modules, by Yosys, and solves it with Bitwuzla."""

import functools
import importlib.metadata
import importlib.util
import json
import pathlib
import re
import sys
from collections.abc import Iterable

from synth import tools, yosys

# One module; its assertions, assumptions and covers become cells that hold in every state, whatever clock they had.
FLAT = "flatten -noscopeinfo\nopt\nsetparam -set TRG_ENABLE 0 t:$check\nchformal -lower"
PROOFS = pathlib.Path(__file__).resolve().parent / "proofs"
FLOAT = PROOFS / "float"
FREE = PROOFS / "free.v"


def read(sources: Iterable[pathlib.Path], top: str, parameters: Iterable[tuple[str, object]] = ()) -> str:
    """Returns the commands that elaborate `top` and make words free that are declared (* anyseq *) or (* anyconst *)."""
    return f"""{yosys.read(sources, top, parameters)}
techmap -map {FREE} a:anyseq %ci1 t:$buf %i
techmap -map {FREE} -D CONSTANT a:anyconst %ci1 t:$buf %i
select -assert-none w:* a:anyseq %i t:$anyseq %co1 %d w:* a:anyconst %i t:$anyconst %co1 %d %u
setattr -unset anyseq -unset anyconst w:*"""


def state(model: str, top: str, name: str, before: str = "",
          given: dict[str, str] | None = None) -> str:
    """Declares a state of a module: the successor of `before`, or any state. Registers are terms of the previous state, inputs in `given`
    those terms; there are no equations, so that what two states compute alike is one term for the solver."""
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
    """Returns a state (see `state`) with names, ending in `suffix`, for the module's ports and for wires that contracts leave free
    ("free_...", numbered if there is a row of them); and these names without `suffix`."""
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
    """Returns a module with parameters ("Name value ...") as SMT-LIB: for every wire, a function of the state, which includes inputs and
    wires that contracts leave free. Writes its netlist to `keep`, so that faults can be put into it."""
    smt2, words = folder / "model.smt2", parameters.split()
    yosys.run("\n".join([read(sources, top, zip(words[::2], words[1::2])), FLAT,
                         *([f"write_rtlil {keep}"] if keep else []), f"dffunmap\nwrite_smt2 -stbv -wires {smt2}"]),
              folder / "yosys.log")
    return smt2.read_text()


def version() -> str:
    """Returns the version of Bitwuzla, or "" if it is not installed."""
    try:
        return importlib.metadata.version("bitwuzla")
    except importlib.metadata.PackageNotFoundError:
        return ""


def solve(file: pathlib.Path, text: str, terms: tuple[str, ...] = (), limit: float = 0) -> dict:
    """Returns Bitwuzla's answer to `text`, which is kept in `file`; see proofs/float/solve.py."""
    if importlib.util.find_spec("bitwuzla") is None:
        raise tools.MissingTool("Bitwuzla is not installed: pip install -r synth/requirements.txt")
    file.write_text(text + "(check-sat)\n")
    out = tools.run([sys.executable, FLOAT / "solve.py", file, limit, *terms],
                    file.with_suffix(".log"))
    return json.loads(out.splitlines()[-1])
