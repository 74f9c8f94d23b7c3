"""The best group widths of a carry-select adder under the unit-delay model, by dynamic programming, which is exact."""

from synth.unit_delay import Counting

MAX_GROUPS = 16  # arith_pkg::MaxGroups
Grouping = tuple[int, ...]  # widths, least significant group first


def best_by_model(width: int, counting: Counting) -> tuple[float, Grouping]:
    """The least delay of the sum of `width` bits, in full-adder delays, and a grouping that has it.

    Groups add by ripple. Of several the one with the least hardware: the widest lowest group (which needs one sum alone), then
    the fewest groups.
    """
    low, high = 0, 2 * width  # in half delays: every counting has steps of 1/2
    while low < high:
        middle = (low + high) // 2
        if _within(width, counting, middle / 2) is None:
            low = middle + 1
        else:
            high = middle
    return low / 2, _within(width, counting, low / 2)


def _within(width: int, counting: Counting, limit: float) -> Grouping | None:
    """The cheapest grouping whose sum bits all come by `limit`."""
    for first in range(min(width, int(limit)), 0, -1):
        # Position -> (earliest carry into it, groups below it), after n groups.
        carries: dict[int, tuple[float, Grouping]] = {first: (first, (first,))}
        for _ in range(MAX_GROUPS):
            if width in carries:
                return carries[width][1]
            following: dict[int, tuple[float, Grouping]] = {}
            for position, (carry, groups) in carries.items():
                if carry + counting.last_multiplexer > limit:
                    continue
                for size in range(1, width - position + 1):
                    if size + counting.last_multiplexer > limit:
                        break
                    found = max(carry, size) + counting.multiplexer, (*groups, size)
                    if position + size not in following or found < following[position + size]:
                        following[position + size] = found
            carries = following
    return None
