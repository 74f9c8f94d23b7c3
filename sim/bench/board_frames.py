"""Prints the clocks of the board's core (hw/board) for three frames, one sample per pixel; checks that pictures equal the cpu engine's.

Clocks are simulated, with the SDRAM at its pins and a link of one word per clock. Loading the scene is not counted. Frames per second are
at CLOCK_MHZ. Seconds by the serial line are the time to send 44 bytes per ray at BAUD; the 32 bytes per result are received meanwhile.

usage: board_frames.py RENDER SCENES [SIZE]
"""

import json
import pathlib
import subprocess
import sys
import tempfile

CLOCK_MHZ, BAUD = 40, 2_000_000  # synth/boards/ulx3s.sv
FRAMES = {"paper": ["--view", "0,8.0625"], "cornell": [], "teapot": []}


def simulate(render, scene, size, options, folder):
    """Renders a frame. Returns the picture's file and the statistics."""
    out = pathlib.Path(folder) / options[-1]
    stats = out.with_suffix(".json")
    subprocess.run([render, scene, "--size", size, "--spp", "1", "--threads", "1", "--quiet", "--stats", stats, "--output", out,
                    *options], check=True)
    return out.with_suffix(".png"), json.loads(stats.read_text())


def main():
    if len(sys.argv) not in (3, 4):
        print(__doc__.strip().splitlines()[-1], file=sys.stderr)
        sys.exit(2)
    render, scenes, size = [*sys.argv[1:], "320x200"][:3]
    print(f"{size}, {CLOCK_MHZ} MHz   rays      clocks  clocks/ray  frames/s  by {BAUD // 1_000_000} Mbaud, s  picture")
    wrong = 0
    for name, view in FRAMES.items():
        with tempfile.TemporaryDirectory() as folder:
            scene = pathlib.Path(scenes) / f"{name}.obj"
            board, stats = simulate(render, scene, size, [*view, "--unit", "board"], folder)
            cpu, _ = simulate(render, scene, size, [*view, "--engine", "cpu"], folder)
            same = board.read_bytes() == cpu.read_bytes()
            wrong += not same
        rays, clocks = stats["rays"], stats["clocks"]
        seconds = 44 * 10 * rays / BAUD
        print(f"{name:18} {rays:9,} {clocks:11,} {clocks / rays:11.1f} {CLOCK_MHZ * 1e6 / clocks:9.2f} {seconds:14.1f}  "
              + ("the cpu's bytes" if same else "OTHER BYTES"))
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
