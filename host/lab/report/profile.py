"""Where the work of a picture goes: hit tests, departures, shading; and what exactness costs of it."""

import collections
import json
import pathlib
import re
import subprocess
import tempfile

from host.lab.report.rows import ROOT

# Where each part begins, as callgrind names the functions. What is neither of the others is shading: making rays,
# materials, lamps, sampling, the film.
WHOLE = r"raygate::TileRenderer::trace\("
PARTS = {"hit_tests": r"raygate::CpuFinder::find\(", "doubts": r"raygate::settle_doubt\(",
         "departures": r"raygate::DeparturePoint::"}


def calls(profile: str) -> collections.Counter:
    """(caller, callee) -> instructions in the callee and all it calls, of a file of callgrind's."""
    names: dict[str, str] = {}
    found: collections.Counter = collections.Counter()
    caller = callee = ""
    is_call = False
    for line in profile.splitlines():
        if is_call:
            found[caller, callee] += int(line.split()[1])
            is_call = False
        elif match := re.match(r"(c?)fn=(\(\d+\))(?: (.*))?", line):
            name = names.setdefault(match[2], match[3] or "")
            caller, callee = (caller, name) if match[1] else (name, callee)
        is_call = is_call or line.startswith("calls=")
    return found


def inside(found: collections.Counter, part: str) -> int:
    """Instructions of a part: of its functions where others call them."""
    return sum(count for (caller, callee), count in found.items()
               if re.match(part, callee) and not re.match(part, caller))


def row(program: pathlib.Path, scene: str, arguments: list[str]) -> dict:
    """Shares of the instructions of a render, in percent; the same in every run."""
    with tempfile.TemporaryDirectory() as name:
        profile, stats = pathlib.Path(name) / "profile", pathlib.Path(name) / "stats.json"
        subprocess.run(["valgrind", "--quiet", "--tool=callgrind", f"--callgrind-out-file={profile}", program, scene,
                        "--engine", "cpu", "--spp", "1", "--quiet", "--threads", "1", "--output", pathlib.Path(name) / "picture.exr",
                        "--stats", stats, *arguments], cwd=ROOT, check=True)
        found, counts = calls(profile.read_text()), json.loads(stats.read_text())
    whole = inside(found, WHOLE)
    shares = {part: 100 * inside(found, names) / whole for part, names in PARTS.items()}
    return {"table": "profile", "scene": scene, "triangles": counts["triangles"], "rays": counts["rays"],
            "edge_doubts_percent": 100 * counts["edge_doubts"] / max(counts["tests"], 1),
            "instructions_per_ray": whole / max(counts["rays"], 1), **shares,
            "shading": 100 - shares["hit_tests"] - shares["departures"]}
