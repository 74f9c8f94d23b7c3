"""Two runs side by side: what got slower or less accurate, beyond the noise."""

import statistics

from host.lab import rows as kept
from host.lab.report.statistics import spread, times

# Rows of two runs are one when all of these are equal.
KEY = ("section", "scene", "width", "height", "variant", "engine", "point_error", "lanes",
       "threads", "integrator", "samples", "seed")

# The same whenever nothing has changed: any growth is worth a line.
COUNTS = {"tests": "more work", "clocks": "more work", "records": "more work",
          "exact_inside": "more work", "exact_depth": "more work", "rmse": "less accurate",
          "wrong_hits": "less accurate", "wrong_misses": "less accurate",
          "wrong_rays": "less accurate"}

# Times must differ by more than this, however small their spread seems.
LEAST_CHANGE = 0.05
SPREADS = 5.0


def name(row: dict) -> str:
    """A row in words."""
    words = [row["section"], kept.scene_name(row), f"{row['width']}x{row['height']}",
             row["variant"], row["engine"]]
    if row["integrator"] != "primary":
        words.append(f"{row['integrator']} of {row['samples']}")
    words += [f"{row[key]} {key}" for key in ("lanes", "threads") if row[key] > 1]
    return " ".join(words)


def machine_ratio(pairs: list[tuple[dict, dict]]) -> float:
    """How much slower the machine was: the median of the new yardstick times over the old ones."""
    ratios = [statistics.median(new["yardstick_seconds"])
              / statistics.median(old["yardstick_seconds"]) for old, new in pairs]
    return statistics.median(ratios) if ratios else 1.0


def noise(old: dict, new: dict) -> float:
    """What part of a time may change without meaning anything, from the spreads of both."""
    return max(LEAST_CHANGE, SPREADS * (spread(times(old)) + spread(times(new))))


def changes(was: dict, now: dict, machine: float) -> list[str]:
    """Lines about one row, "better: ..." and "faster: ..." or another word for the worse."""
    lines = []
    if min(len(was["seconds"]), len(now["seconds"])) > 1:
        medians = [statistics.median(times(row)) for row in (was, now)]
        ratio, limit = medians[1] / medians[0] / machine, noise(was, now)
        if not 1 / (1 + limit) <= ratio <= 1 + limit:
            lines.append(f"{'slower' if ratio > 1 else 'faster'}: {name(now)}: {medians[0]:.4g} s -> "
                         f"{medians[1]:.4g} s, x {ratio:.2f} beside the machine's own "
                         f"x {machine:.2f} (noise {100 * limit:.0f} %)")
    before, after = ({**row, **row.get("decisions", {})} for row in (was, now))
    before |= {"tests": was["tests"]}  # the picture's, not the audit's
    after |= {"tests": now["tests"]}
    for key, worse in COUNTS.items():
        if key in before and key in after and before[key] != after[key]:
            word = worse if after[key] > before[key] else "better"
            lines.append(f"{word}: {name(now)}: {key} {before[key]:.6g} -> {after[key]:.6g}")
    return lines


def compare(old: list[dict], new: list[dict]) -> list[str]:
    """Lines about two runs' rows, the worse ones first; the very first says what was compared."""
    before = {tuple(row.get(key) for key in KEY): row for row in kept.of(old, "pictures")}
    pairs = [(before[key], row) for row in kept.of(new, "pictures")
             if (key := tuple(row.get(name) for name in KEY)) in before]
    lines = [line for pair in pairs for line in changes(*pair, machine_ratio(pairs))]
    better = [line for line in lines if line.startswith(("better", "faster"))]
    worse = [line for line in lines if line not in better]
    return [f"{len(pairs)} rows compared with the older run; {len(before) - len(pairs)} of its rows "
            f"are not here. {len(worse)} worse, {len(better)} better beyond the noise.",
            *worse, *better]
