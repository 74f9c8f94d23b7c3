"""`python3 -m synth.cells`: see `--help`, or README.md."""

import argparse
import sys

from synth import chosen, tools
from synth.cells import library, published
from synth.cells.catalogue import CORNERS


def main() -> int:
    """Measures the cells at the corners and prints the checks; the exit status, 2 for what the user can mend."""
    parser = argparse.ArgumentParser(prog="synth.cells", description=(
        "Characterises SkyWater 130 cells with ngspice, writes build/synth/cells/{tt,ss,ff}.lib, and prints how far some figures "
        "are from SkyWater's own."))
    parser.add_argument("--corners", default="", help="tt,ss,ff (all)")
    parser.add_argument("--jobs", type=chosen.whole(1, 1024), default="2", help="at once (%(default)s)")
    given = parser.parse_args()
    names = [name for name in given.corners.split(",") if name] or [corner.name for corner in CORNERS]
    unknown = set(names) - {corner.name for corner in CORNERS}
    if unknown:
        parser.error(f"no corner {', '.join(sorted(unknown))}; there are {', '.join(corner.name for corner in CORNERS)}")
    try:
        failures = library.make([library.corner(name) for name in names], int(given.jobs))
        if not failures:
            print(published.table(names))
    except tools.MissingTool as error:
        print(f"synth.cells: {error}", file=sys.stderr)
        return 2
    for failure in failures:
        print("failed:", failure, file=sys.stderr)
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
