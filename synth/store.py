"""Keeps results on disk, under a key made of everything that they depend on."""

import functools
import hashlib
import json
import os
import pathlib
import re
import threading
from collections.abc import Callable, Iterable

from synth import tools

OUT = tools.ROOT / "build" / "synth"
# Outcomes of proofs, kept for all checkouts of this user, and the programs that lead to them.
PROVERS = [tools.ROOT / "synth" / f"{name}.py" for name in (
    "assertions", "float_cuts", "float_proofs", "float_specifications", "induction", "netlists", "prove", "smt", "unit_proofs", "yosys")]
PROVEN = pathlib.Path(os.environ.get("XDG_CACHE_HOME") or pathlib.Path.home() / ".cache") / "raygate" / "proven"


class NotKept(Exception):
    """A result is wanted that no earlier run has left, and only such are."""


only_kept = False
_locks: dict[pathlib.Path, threading.Lock] = {}


@functools.cache
def _digest(file: pathlib.Path) -> str:
    """Of the contents; RTL without its comments and blanks, which change no netlist."""
    text = file.read_bytes()
    if file.suffix == ".sv":
        text = re.sub(rb"//[^\n]*|\s+", b" ", text)
        text = re.sub(rb" +", b" ", text)
    return hashlib.sha256(text).hexdigest()


def key(files: Iterable[pathlib.Path], *facts: object) -> str:
    """A hash of the contents of `files` and of `facts` (tool versions, parameters, settings)."""
    parts = [[file.name, _digest(file)] for file in files] + [repr(fact) for fact in facts]
    return hashlib.sha256(json.dumps(parts).encode()).hexdigest()


def kept(folder: pathlib.Path, wanted: str) -> dict | None:
    """The result in `folder` if it was made under the key `wanted`."""
    file = folder / "result.json"
    found = json.loads(file.read_text()) if file.exists() else {}
    return found["result"] if found.get("key") == wanted else None


def replace(file: pathlib.Path, text: str) -> None:
    """Writes `text` where it differs from what `file` holds. Readers see the whole file or none, and jobs that run at once
    don't share theirs."""
    if not file.exists() or file.read_text() != text:
        file.parent.mkdir(parents=True, exist_ok=True)
        written = file.with_suffix(f".{os.getpid()}-{threading.get_ident()}")
        written.write_text(text)
        written.replace(file)


def cached(folder: pathlib.Path, wanted: str, make: Callable[[], dict]) -> tuple[dict, bool]:
    """The result in `folder` if it was made under the key `wanted`; else makes and keeps it.

    Returns the result and whether it was already there. Jobs that want the same one wait for whichever
    makes it.
    """
    with _locks.setdefault(folder, threading.Lock()):
        there = kept(folder, wanted)
        if there is not None:
            return there, True
        if only_kept:
            raise NotKept(folder.name)
        file = folder / "result.json"
        file.unlink(missing_ok=True)  # a run that fails must not leave an older answer behind
        folder.mkdir(parents=True, exist_ok=True)
        result = make()
        replace(file, json.dumps({"key": wanted, "result": result}, indent=1))  # in one step: Ctrl-C leaves no half of it
        return json.loads(file.read_text())["result"], False


def proven(folder: pathlib.Path, wanted: str, prove: Callable[[], dict]) -> tuple[dict, bool]:
    """`cached` for a proof, whose outcome is also kept in PROVEN under its key and the text of PROVERS: no checkout proves or
    refutes it again.

    Raises Refuted where the proof does, at once or in an earlier run. No other failure is kept: a solver that ran out of time
    or a missing tool says nothing about the claim.
    """
    file = PROVEN / f"{key(PROVERS, wanted)}.json"
    if file.exists():
        outcome = json.loads(file.read_text())
        if "refuted" in outcome:
            raise tools.Refuted(outcome["refuted"], outcome["values"])
        return outcome, True
    try:
        result, there = cached(folder, wanted, tools.measured(prove))
    except tools.Refuted as error:
        replace(file, json.dumps({"refuted": error.claim, "values": error.values}))
        raise
    replace(file, json.dumps(result))
    return result, there
