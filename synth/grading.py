"""Computes the delays of the paper's adders in the paper's delay model, and by dynamic programming the best group widths in this model."""

from synth import catalogue, structure, tables
from synth.catalogue import Design
from synth.structure import Counting

WIDTH = 48  # bits of the paper's adders
MAX_GROUPS = 16  # arith_pkg::MaxGroups
Grouping = tuple[int, ...]  # widths, least significant group first


def best_by_model(width: int, counting: Counting) -> tuple[float, Grouping]:
    """Returns the least delay of a carry-select sum of `width` bits, in full-adder delays, and a grouping with this delay.

    Groups add by ripple carry. Among several groupings, returns the one with the least hardware: the widest lowest group (because this
    group needs only one sum), then the fewest groups.
    """
    low, high = 0, 2 * width  # in half full-adder delays: all delays are multiples of 1/2
    while low < high:
        middle = (low + high) // 2
        if _within(width, counting, middle / 2) is None:
            low = middle + 1
        else:
            high = middle
    return low / 2, _within(width, counting, low / 2)


def _within(width: int, counting: Counting, limit: float) -> Grouping | None:
    """Returns the cheapest grouping whose sum bits are all ready by `limit` (full-adder delays), or None."""
    for first in range(min(width, int(limit)), 0, -1):
        # Bit position -> (earliest time of the carry into this bit, groups below this bit), after n groups.
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


def text_of(groups: Grouping) -> str:
    """Returns the widths, least significant first, as text."""
    return ", ".join(map(str, groups))


def graded(groups: Grouping, look_ahead: bool, width: int = WIDTH) -> Design:
    """Returns a carry-select adder of these groups."""
    return catalogue.design("adder", adder="graded", widths=list(groups), look_ahead=look_ahead, Width=width)


def model_table() -> str:
    """Returns a table of the adders' delays: as the paper states them, in each counting, and the least possible delays."""
    optimum = best_by_model(WIDTH, structure.COUNTINGS[1])[1]
    rows = []
    for name, design, paper in [
            ("ripple", catalogue.design("adder", adder="ripple", Width=WIDTH), "48"),
            *((f"uniform, {WIDTH // size} groups of {size}",
               graded((size,) * (WIDTH // size), False), "14")
              for size in (3, 4, 6, 8, 12)),
            ("graded, the core's own groups",
             catalogue.design("adder", adder="graded", look_ahead=False, Width=WIDTH), "10"),
            (f"graded, {text_of(optimum)}", graded(optimum, False), "10")]:
        module = structure.netlist(design)
        hardware = structure.hardware(module)
        delays = [structure.delay(module, counting) for counting in structure.COUNTINGS]
        rows.append([name, paper, *(f"{delay:g}" for delay in delays),
                     hardware["full_adder"], hardware["multiplexer"]])
    best = [best_by_model(WIDTH, counting) for counting in structure.COUNTINGS]
    for (delay, groups), counting in zip(best, structure.COUNTINGS, strict=True):
        counted = structure.delay(structure.netlist(graded(groups, False)), counting)
        if counted != delay:
            raise AssertionError(f"the search says {delay}, the netlist of {groups} {counted}")
    rows.append(["least of all groupings", "-", *(f"{delay:g}" for delay, _ in best), "-", "-"])
    header = [f"{WIDTH}-bit adder", "paper",
              *(counting.title for counting in structure.COUNTINGS), "full adders", "multiplexers"]
    return tables.markdown(header, rows)
