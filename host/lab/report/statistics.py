"""Spreads and fronts."""

import math
import statistics


def times(row: dict) -> list[float]:
    """Of one thread's work the processor's seconds, which other programs don't stretch; else wall."""
    return row["processor_seconds"] if row["threads"] == 1 else row["seconds"]


def median_seconds(row: dict) -> float:
    """Of the repeats."""
    return statistics.median(times(row))


def spread(values: list[float]) -> float:
    """The median distance from the median, as a part of the median; 0 for one value."""
    center = statistics.median(values)
    return statistics.median(abs(value - center) for value in values) / center if center else 0.0


def front(points: list[tuple[float, float]]) -> list[int]:
    """Which points no other betters: none is at most as large in both and smaller in one.

    Indices, by growing first coordinate.
    """
    best, kept = math.inf, []
    for i in sorted(range(len(points)), key=lambda i: points[i]):
        if points[i][1] < best:
            kept.append(i)
            best = points[i][1]
    return kept
