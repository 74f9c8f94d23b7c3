"""Keeps results on disk. The key of a result is a hash of everything that the result depends on."""

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
# PROVERS: the programs that outcomes of proofs depend on. PROVEN: the folder of kept outcomes, shared by all checkouts of this user.
PROVERS = [tools.ROOT / "synth" / f"{name}.py" for name in (
    "assertions", "float_cuts", "float_proofs", "float_specifications", "induction", "netlists", "prove", "smt", "unit_proofs", "yosys")]
PROVEN = pathlib.Path(os.environ.get("XDG_CACHE_HOME") or pathlib.Path.home() / ".cache") / "raygate" / "proven"


class NotKept(Exception):
    """No earlier run has kept the result, and `only_kept` is set."""


only_kept = False
_locks: dict[pathlib.Path, threading.Lock] = {}


@functools.cache
def _digest(file: pathlib.Path) -> str:
    """Returns a hash of a file's contents. In RTL, comments and the amount of white space are ignored, because they change no netlist."""
    text = file.read_bytes()
    if file.suffix == ".sv":
        text = re.sub(rb"//[^\n]*|\s+", b" ", text)
        text = re.sub(rb" +", b" ", text)
    return hashlib.sha256(text).hexdigest()


def key(files: Iterable[pathlib.Path], *facts: object) -> str:
    """Returns a hash of the contents of `files` and of `facts` (tool versions, parameters, settings)."""
    parts = [[file.name, _digest(file)] for file in files] + [repr(fact) for fact in facts]
    return hashlib.sha256(json.dumps(parts).encode()).hexdigest()


def kept(folder: pathlib.Path, wanted: str) -> dict | None:
    """Returns the result in `folder` if the result was made under the key `wanted`, else None."""
    file = folder / "result.json"
    found = json.loads(file.read_text()) if file.exists() else {}
    return found["result"] if found.get("key") == wanted else None


def replace(file: pathlib.Path, text: str) -> None:
    """Writes `text` to `file` if the contents differ. Replaces the file atomically, through a temporary file that no other job uses."""
    if not file.exists() or file.read_text() != text:
        file.parent.mkdir(parents=True, exist_ok=True)
        written = file.with_suffix(f".{os.getpid()}-{threading.get_ident()}")
        written.write_text(text)
        written.replace(file)


def cached(folder: pathlib.Path, wanted: str, make: Callable[[], dict]) -> tuple[dict, bool]:
    """Returns the result in `folder` if the result was made under the key `wanted`; else makes and keeps a new result.

    Also returns whether the result was already there. Jobs that need the same result wait for the first of them.
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
        replace(file, json.dumps({"key": wanted, "result": result}, indent=1))  # atomically: Ctrl-C leaves no partial file
        return json.loads(file.read_text())["result"], False


def proven(folder: pathlib.Path, wanted: str, prove: Callable[[], dict]) -> tuple[dict, bool]:
    """Like `cached`, for a proof. Also keeps the outcome in PROVEN, under a key of `wanted` and the text of PROVERS, so that no checkout
    repeats the proof.

    Raises Refuted if the proof is refuted, now or in an earlier run. Other failures, such as a timeout or a missing tool, are not kept,
    because they say nothing about the claim.
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
