"""Estimates the wires of a placement before routing: each net is a minimum spanning tree of L-shaped lines between its pins.

A line goes vertically in the lowest vertical metal, then horizontally in the next horizontal metal. The estimate ignores detours of
routing. On the other hand, a tree branches only at pins, and is therefore longer than necessary.
"""

import numpy as np

from synth.layout.parasitics import taps
from synth.layout.place import Placement
from synth.layout.route import RAILS, Wire, Wires

# Capacitance of these trees in pF per um, as extracted by magic from the layouts of the adders.
FARADS = {"osu035": 6.4e-5, "osu018": 8e-5}
TREES = 200  # most pins of an estimated net. Clock and reset have more and would need buffer trees, which synthesis does not make


def wires(placement: Placement) -> Wires:
    """Returns the wires and vias of each net, in the form of route.wires. Rails and nets of more than TREES pins are left out."""
    technology = placement.technology
    found = {}
    for net, ends in placement.netlist.nets().items():
        if net in RAILS or not 1 < len(ends) <= TREES:
            continue
        pins = [(rects[0].layer, *rects[0].centre) for rects in taps(placement, ends).values()]
        found[net] = [wire for one, other in tree([(x, y) for _, x, y in pins])
                      for wire in _line(pins[one], pins[other], technology.up, technology.across, list(technology.layers))]
    return found


def tree(points: list[tuple[float, float]]) -> list[tuple[int, int]]:
    """Returns the edges of a minimum spanning tree of `points` by Manhattan distance (Prim's algorithm), as pairs of indices."""
    at = np.array(points, float)
    nearest = np.zeros(len(at), int)
    far = np.abs(at - at[0]).sum(axis=1)
    far[0] = np.inf
    edges = []
    for _ in range(len(at) - 1):
        new = int(far.argmin())
        edges.append((int(nearest[new]), new))
        ways = np.abs(at - at[new]).sum(axis=1)
        nearer = (ways < far) & np.isfinite(far)
        nearest[nearer] = new
        far = np.where(nearer, ways, far)
        far[new] = np.inf
    return edges


def _line(one: tuple, other: tuple, up: str, across: str, layers: list[str]) -> list[Wire]:
    """Returns the wires and vias from one pin to another. A pin is a tuple of layer, x and y."""
    (first, x0, y0), (last, x1, y1) = one, other
    pieces = [*_contacts(first, up, x0, y0, layers)]
    if y0 != y1:
        pieces.append(Wire(up, x0, y0, x0, y1))
    if x0 != x1:
        pieces += [*_contacts(up, across, x0, y1, layers), Wire(across, x0, y1, x1, y1),
                   *_contacts(last, across, x1, y1, layers)]
    else:
        pieces += _contacts(last, up, x1, y1, layers)
    return pieces


def _contacts(low: str, high: str, x: float, y: float, layers: list[str]) -> list[Wire]:
    """Returns the stacked vias from one metal to another."""
    low, high = sorted((layers.index(low), layers.index(high)))
    return [Wire(layers[place], x, y, x, y, layers[place + 1]) for place in range(low, high)]
