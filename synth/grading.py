"""Searches the group widths of a carry-select adder.

Under the unit-delay model by dynamic programming, which is exact; on a real library by synthesising
and timing neighbours of the best found so far, until none is better or the budget is spent.
"""

from collections.abc import Callable

from synth.unit_delay import Counting

MAX_GROUPS = 16  # arith_pkg::MaxGroups
Grouping = tuple[int, ...]  # widths, least significant group first


def best_by_model(width: int, counting: Counting,
                  arrivals: list[float] | None = None) -> tuple[float, Grouping]:
    """The least delay of the sum of `width` bits, in full-adder delays, and a grouping that has it.

    Groups add by ripple. Of several the one with the least hardware: the widest lowest group (which
    needs one sum alone), then the fewest groups. `arrivals`: when bit i of both operands comes.
    """
    arrivals = arrivals or [0.0] * width
    low, high = 0, 2 * int(max(arrivals) + width)  # in half delays: every counting has steps of 1/2
    while low < high:
        middle = (low + high) // 2
        if _within(width, counting, arrivals, middle / 2) is None:
            low = middle + 1
        else:
            high = middle
    return low / 2, _within(width, counting, arrivals, low / 2)


def _within(width: int, counting: Counting, arrivals: list[float],
            limit: float) -> Grouping | None:
    """The cheapest grouping whose sum bits all come by `limit`."""
    for first in range(width, 0, -1):
        ready = _ripple(arrivals[:first])
        if max(ready) > limit:
            continue
        # Position -> (earliest carry into it, groups below it), after n groups.
        carries = {first: (ready[-1], (first,))}
        for _ in range(MAX_GROUPS):
            if width in carries:
                return carries[width][1]
            following: dict[int, tuple[float, Grouping]] = {}
            for position, (carry, groups) in carries.items():
                if carry + counting.last_multiplexer > limit:
                    continue
                ready = _ripple(arrivals[position:])
                for size in range(1, width - position + 1):
                    if ready[size - 1] + counting.last_multiplexer > limit:
                        break
                    found = max(carry, ready[size - 1]) + counting.multiplexer, (*groups, size)
                    if position + size not in following or found < following[position + size]:
                        following[position + size] = found
            carries = following
    return None


def _ripple(arrivals: list[float]) -> list[float]:
    """When the sums (and carries) of a chain of full adders are there."""
    ready, carry = [], 0.0
    for arrival in arrivals:
        carry = max(carry, arrival) + 1
        ready.append(carry)
    return ready


def neighbours(groups: Grouping) -> list[Grouping]:
    """Groupings one step away: a bit moved from one group to another, a group split or merged."""
    found = set()
    for i in range(len(groups)):
        for j in range(len(groups)):
            if i != j:
                moved = list(groups)
                moved[i] -= 1
                moved[j] += 1
                found.add(tuple(width for width in moved if width))
        for part in range(1, groups[i]):
            found.add((*groups[:i], part, groups[i] - part, *groups[i + 1:]))
        if i + 1 < len(groups):
            found.add((*groups[:i], groups[i] + groups[i + 1], *groups[i + 2:]))
    return sorted(near for near in found if len(near) <= MAX_GROUPS and near != groups)


def best_by_measurement(
        seeds: list[Grouping], budget: int,
        measure: Callable[[list[Grouping]], list[tuple[float, float]]],
) -> tuple[Grouping, dict[Grouping, tuple[float, float]]]:
    """The fastest grouping found (the smaller of two as fast), and all that were measured.

    `measure` gives (delay, area) of each of a list of groupings. Descends from the best seed; where
    all its neighbours are worse, from the best point whose neighbours were not tried yet.
    """
    known: dict[Grouping, tuple[float, float]] = {}
    expanded: set[Grouping] = set()

    def add(groupings: list[Grouping]) -> None:
        new = [groups for groups in dict.fromkeys(groupings) if groups not in known]
        new = new[: budget - len(known)]
        known.update(zip(new, measure(new), strict=True))

    add(seeds)
    while len(known) < budget:
        open_points = [groups for groups in known if groups not in expanded]
        if not open_points:
            break
        centre = min(open_points, key=lambda groups: (known[groups], groups))
        expanded.add(centre)
        # A spread of the neighbours and not all: many small steps beat one exhaustive one.
        near = [groups for groups in neighbours(centre) if groups not in known]
        add(near[:: max(1, len(near) // 16)])
    return min(known, key=lambda groups: (known[groups], groups)), known
