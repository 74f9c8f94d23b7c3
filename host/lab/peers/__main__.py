"""`make peers`: raygate next to Mitsuba 3, scene by scene: time, error, and their product."""

import argparse
import pathlib
import sys

from host.lab.peers import measure, peers_report
from host.lab.report import machine, rows as kept
from host.lab.report.__main__ import write


def main() -> int:
    """Runs the command line; 2 for what the user can mend."""
    parser = argparse.ArgumentParser(prog="peers", description=__doc__)
    parser.add_argument("scenes", nargs="*", metavar="SCENE", help=f"of {', '.join(measure.SCENES)} (all)")
    parser.add_argument("--quick", action="store_true", help="half the size, fewer samples and repeats")
    parser.add_argument("--repeats", type=int, metavar="N", help="other seeds, of which times are medians (3)")
    parser.add_argument("--reference", type=int, metavar="N", help="samples of each of two long runs (512)")
    parser.add_argument("--render", type=pathlib.Path, metavar="PROGRAM", default=kept.ROOT / "render",
                        help="raygate's (./render)")
    parser.add_argument("--publish", action="store_true", help="write the report into host/lab/results/ as well")
    given = parser.parse_args()
    unknown = set(given.scenes) - set(measure.SCENES)
    if unknown:
        print(f"error: {', '.join(sorted(unknown))}: expected {', '.join(measure.SCENES)}", file=sys.stderr)
        return 2
    names = given.scenes or (["cornell", "cornell_spheres"] if given.quick else list(measure.SCENES))
    found = [{**machine.describe(kept.ROOT), "quick": given.quick}]
    for rows in measure.measure(names, given.quick, given.repeats or (2 if given.quick else 3),
                                given.reference or (128 if given.quick else 512), given.render.resolve(),
                                {1, machine.processors()}):
        found += rows
        kept.write(kept.KEPT / "peers.jsonl", found)  # what there is, should it be interrupted
    print(peers_report.tables(found))
    write(found, peers_report.build, "peers", given.publish)
    return 0


if __name__ == "__main__":
    sys.exit(main())
