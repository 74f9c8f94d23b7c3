"""Spreads, power laws and fronts."""

import dataclasses
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


@dataclasses.dataclass(frozen=True)
class PowerLaw:
    """y = factor * x**exponent, fitted to logarithms by least squares."""

    factor: float
    exponent: float
    exponent_error: float  # standard error
    largest_miss: float  # the largest ratio of a point to the law, or of the law to a point

    def at(self, x: float) -> float:
        """The law's y."""
        return self.factor * x ** self.exponent


def power_law(xs: list[float], ys: list[float]) -> PowerLaw | None:
    """The law through positive points; None for fewer than three different x."""
    points = [(math.log(x), math.log(y)) for x, y in zip(xs, ys, strict=True) if x > 0 and y > 0]
    if len({x for x, _ in points}) < 3:
        return None
    logs = [x for x, _ in points]
    line = statistics.linear_regression(logs, [y for _, y in points])
    misses = [y - (line.intercept + line.slope * x) for x, y in points]
    freedom = len(points) - 2
    square = sum((x - statistics.fmean(logs)) ** 2 for x in logs)
    error = math.sqrt(sum(miss ** 2 for miss in misses) / freedom / square)
    return PowerLaw(math.exp(line.intercept), line.slope, error,
                    math.exp(max(abs(miss) for miss in misses)))


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
