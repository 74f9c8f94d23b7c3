"""Spreads and Pareto fronts."""

import math
import statistics


def times(row: dict) -> list[float]:
    """Returns the times of a row: processor time for one thread, as it excludes other programs, otherwise wall time."""
    return row["processor_seconds"] if row["threads"] == 1 else row["seconds"]


def median_seconds(row: dict) -> float:
    """Returns the median time of the repeats."""
    return statistics.median(times(row))


def spread(values: list[float]) -> float:
    """Returns the median absolute deviation relative to the median; 0 for one value."""
    center = statistics.median(values)
    return statistics.median(abs(value - center) for value in values) / center if center else 0.0


def front(points: list[tuple[float, float]]) -> list[int]:
    """Returns the Pareto-optimal points: no other point is at most as large in both coordinates and smaller in one.

    Returns indices, sorted by the first coordinate.
    """
    best, kept = math.inf, []
    for i in sorted(range(len(points)), key=lambda i: points[i]):
        if points[i][1] < best:
            kept.append(i)
            best = points[i][1]
    return kept
