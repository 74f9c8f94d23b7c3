"""Medians, spreads, and power laws."""

import dataclasses
import math


def median(values: list[float]) -> float:
    """The middle value, or the mean of the two middle ones; of at least one."""
    ordered = sorted(values)
    middle = len(ordered) // 2
    return ordered[middle] if len(ordered) % 2 else (ordered[middle - 1] + ordered[middle]) / 2


def spread(values: list[float]) -> float:
    """The median distance from the median, as a part of the median; 0 for one value."""
    center = median(values)
    return median([abs(value - center) for value in values]) / center if center else 0.0


@dataclasses.dataclass(frozen=True)
class PowerLaw:
    """y = factor * x**exponent, fitted to logarithms by least squares."""

    factor: float
    exponent: float
    exponent_error: float  # standard error; 0 where two points leave no freedom
    largest_miss: float  # the largest ratio of a point to the law, or of the law to a point

    def at(self, x: float) -> float:
        """The law's y."""
        return self.factor * x ** self.exponent


def power_law(xs: list[float], ys: list[float]) -> PowerLaw | None:
    """The law through positive points; None for fewer than two different x."""
    points = [(math.log(x), math.log(y)) for x, y in zip(xs, ys, strict=True) if x > 0 and y > 0]
    count = len(points)
    if len({x for x, _ in points}) < 2:
        return None
    mean_x = sum(x for x, _ in points) / count
    mean_y = sum(y for _, y in points) / count
    square = sum((x - mean_x) ** 2 for x, _ in points)
    exponent = sum((x - mean_x) * (y - mean_y) for x, y in points) / square
    start = mean_y - exponent * mean_x
    misses = [y - (start + exponent * x) for x, y in points]
    freedom = count - 2
    error = math.sqrt(sum(miss ** 2 for miss in misses) / freedom / square) if freedom else 0.0
    return PowerLaw(math.exp(start), exponent, error, math.exp(max(abs(miss) for miss in misses)))


def front(points: list[tuple[float, float]]) -> list[int]:
    """Which points no other betters: none is at most as large in both and smaller in one.

    Indices, by growing first coordinate.
    """
    order = sorted(range(len(points)), key=lambda i: points[i])
    best, kept = math.inf, []
    for i in order:
        if points[i][1] < best:
            kept.append(i)
            best = points[i][1]
    return kept
