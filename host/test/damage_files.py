"""Runs ./render and ./trace on damaged files of every format, and counts their outcomes.

`python3 -B host/test/damage_files.py RENDER TRACE [--count 300] [--seed 1] [--only obj,png]`: exits with 1, and keeps the file, if a
program crashes, takes over ten seconds, has a status other than 0 and 2, reports an error in more than one line, or changes an
existing picture although the run fails. Seed files are those of `make test LONG=fuzz`, and small files made here.
"""

import argparse
import collections
import pathlib
import random
import shutil
import struct
import subprocess
import sys
import tempfile
import zlib

HOST = pathlib.Path(__file__).resolve().parent.parent
TRIANGLE = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n"
MATERIAL = (b"newmtl m\nKd .5 .5 .5\nKs 1 1 1\nNs 20\nd .5\nillum 2\nmap_Kd -o .5 0 -s 2 2 -clamp on pic.png\nPr .5\nPm 1\n"
            b"newmtl n\nKe 1 1 1\nTf .1 .2 .3\nNi 1.5\nillum 7\nnorm -bm 2 pic.png\nmap_d pic.png\n")
WORDS = [b"nan", b"-1", b"1e300", b"4294967296", b"-2147483649", b"1e-320", b"\0", b"\xff\xff\xff\xff", b"\n", b" ", b"{", b"]", b'"']


def png() -> bytes:
    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    rows = b"".join(b"\0" + bytes(range(y, y + 24)) for y in range(8))
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 8, 8, 8, 2, 0, 0, 0)) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


def seeds() -> dict[str, list[tuple[str, bytes]]]:
    """Returns the names and contents of seed files, by format."""
    def stored(folder: str, *names: str) -> list[tuple[str, bytes]]:
        return [(name, (HOST / folder / name).read_bytes()) for name in names]
    scenes, films, rays = "render/fuzz/seeds", "film/fuzz/seeds", "trace/fuzz/rays"
    obj, mtl = stored(scenes, "smooth.obj")[0][1].split(b"\x1e")
    lights = stored(scenes, "places.json")[0][1].replace(b"model.obj", b"a.obj")
    return {
        "obj": [("b.obj", obj)], "mtl": [("a.mtl", MATERIAL), ("a.mtl", mtl.replace(b"newmtl a", b"newmtl m"))], "ply": stored(scenes, "ascii.ply", "binary.ply"),
        "stl": stored(scenes, "ascii.stl", "binary.stl"), "gltf": stored(scenes, "square.gltf"), "glb": stored(scenes, "square.glb"),
        "json": [("a.json", lights)], "exr": stored(films, "sums.exr", "error.exr"), "hdr": stored(films, "flat.hdr", "runs.hdr"),
        "png": [("pic.png", png())], "csv": stored(rays, "rays.csv")}


def damaged(data: bytes, chance: random.Random) -> bytes:
    """Returns `data` with up to four changes: flipped bits, cut, repeated or random pieces, inserted words, a cut end."""
    result = bytearray(data)
    for _ in range(chance.choice((1, 1, 1, 2, 4))):
        at = chance.randrange(len(result) + 1)
        length = chance.choice((1, 1, 2, 4, 8, 40))
        kind = chance.randrange(6)
        if kind == 0 and at < len(result):
            result[at] ^= 1 << chance.randrange(8)
        elif kind == 1:
            del result[at:at + length]
        elif kind == 2:
            result[at:at] = result[at:at + length] * chance.choice((1, 2, 50))
        elif kind == 3:
            result[at:at + chance.choice((0, 1, 4))] = chance.choice(WORDS)
        elif kind == 4:
            result[at:at + length] = chance.randbytes(length)
        elif chance.random() < 0.3:
            del result[at:]
    return bytes(result)


def command(form: str, name: str, render: str, trace: str) -> list[str]:
    picture = ["--size", "12x9", "--engine", "cpu", "--spp", "1", "-q", "--threads", "1", "-o", "out.exr"]
    if form == "csv":
        return [trace, "a.obj", name, "-q", "-o", "out.csv"]
    if form in ("exr", "hdr"):
        return [render, "a.obj", "--environment", name, *picture]
    return [render, "a.obj" if form in ("mtl", "png") else name, *picture]


def run(form: str, name: str, data: bytes, folder: pathlib.Path, programs: tuple[str, str]) -> tuple[str, str]:
    """Runs a program on one file; returns the outcome in a few words, and details of a wrong outcome, otherwise ""."""
    (folder / "a.obj").write_bytes(b"mtllib a.mtl\n" + TRIANGLE + b"usemtl m\nf 1/1 2/2 3/3\nusemtl n\nf 3/3 2/2 1/1\n")
    for other, content in (("a.mtl", MATERIAL), ("pic.png", png()), (name, data)):
        (folder / other).write_bytes(content)
    arguments = command(form, name, *programs)
    output = folder / arguments[-1]
    output.write_bytes(b"before")
    try:
        done = subprocess.run(arguments, cwd=folder, capture_output=True, timeout=10, stdin=subprocess.DEVNULL,
                              check=False)
    except subprocess.TimeoutExpired:
        return "too slow", "takes more than ten seconds"
    errors = [line for line in done.stderr.splitlines() if not line.startswith(b"warning: ")]
    if done.returncode not in (0, 2):
        return f"status {done.returncode}", done.stderr.decode(errors="replace")[-2000:] or "printed nothing"
    if b"runtime error" in done.stderr or (done.returncode == 2 and (len(errors) != 1 or not errors[0].startswith(b"error: "))):
        return "other words", done.stderr.decode(errors="replace")[-2000:]
    if (output.read_bytes() == b"before") != (done.returncode == 2):
        return "output lost", f"status {done.returncode}"
    return ("read with a warning" if done.stderr else "read") if done.returncode == 0 else "refused", ""


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", nargs=2, metavar="PROGRAM", help="./render and ./trace")
    parser.add_argument("--count", type=int, default=300, help="files of each format (default 300)")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", default="", help="formats, by commas (default all)")
    given = parser.parse_args()
    programs = tuple(str(pathlib.Path(each).resolve()) for each in given.programs)
    bad = 0
    for form, files in seeds().items():
        if given.only and form not in given.only.split(","):
            continue
        chance, counts = random.Random(f"{given.seed} {form}"), collections.Counter()
        for number in range(given.count):
            name, data = chance.choice(files)
            data = damaged(data, chance)
            folder = pathlib.Path(tempfile.mkdtemp(prefix="damaged"))
            word, wrong = run(form, name, data, folder, programs)
            counts[word] += 1
            if wrong:
                bad += 1
                print(f"{folder / name} (number {number}): {word}: {wrong}", file=sys.stderr)
            else:
                shutil.rmtree(folder)
        print(f"{form}: {', '.join(f'{count} {word}' for word, count in counts.most_common())}", flush=True)
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
