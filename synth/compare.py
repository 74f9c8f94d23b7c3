"""`python3 -m synth.compare RESULTS.json RESULTS.json`: whether two runs have the same figures.

Exit status 0: every design, target and flow has; 1: the differences are listed; 2: no such file.
"""

import json
import pathlib
import sys

FIGURES = ("area", "delay_ns", "luts", "mhz")
Figures = dict[tuple[str, str, str], dict[str, float]]


def figures(text: str) -> Figures:
    """What results.json says of each design, target and flow."""
    return {(row["design"], row["target"], row["flow"]):
            {name: row[name] for name in FIGURES if name in row}
            for row in json.loads(text)["results"]}


def differences(one: Figures, other: Figures) -> list[str]:
    """A line for each figure that differs or that only one of the two has."""
    return [f"{' '.join(key)}: {one.get(key, 'missing')} against {other.get(key, 'missing')}"
            for key in sorted(one.keys() | other.keys()) if one.get(key) != other.get(key)]


def main() -> int:
    """Compares the two files named on the command line."""
    if len(sys.argv) != 3:
        print(__doc__, file=sys.stderr)
        return 2
    try:
        one, other = (figures(pathlib.Path(name).read_text()) for name in sys.argv[1:])
    except (OSError, ValueError, KeyError) as error:
        print(f"compare: {error}: not a results.json of make synth", file=sys.stderr)
        return 2
    found = differences(one, other)
    print("\n".join(found) if found else f"the same: {len(one)} results")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
