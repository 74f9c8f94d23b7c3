"""The drawings of host/README.md against the includes of the code.

A drawing is a mermaid graph. Its nodes are rooms (folders of host/, or `sim`) or, with a path as
their label, sources: `a["intersect/intersector"]`. An arrow says that one includes the other. Every arrow
must be such an include, and where all nodes are rooms, every include must be an arrow or follow
from several.
"""

import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
INCLUDE = re.compile(r'^#include "((?:host|sim)/[^"]+)"', re.MULTILINE)


def room(path: str) -> str:
    """host/intersect/unit/x.h -> intersect; sim/x.h -> sim."""
    parts = path.split("/")
    return "sim" if parts[0] == "sim" else parts[1]


def folder(path: str) -> str:
    """host/scene/io/x.h -> scene/io/"""
    return path.removeprefix("host/").rpartition("/")[0] + "/"


def includes() -> dict[str, set[str]]:
    """Each source without tests and fuzz targets, and what it includes; paths from the root."""
    sources = [path for folder in ("host", "sim") for path in (ROOT / folder).rglob("*")
               if path.suffix in (".h", ".cpp") and not {"test", "fuzz"} & set(path.parts)]
    return {str(path.relative_to(ROOT)): set(INCLUDE.findall(path.read_text()))
            for path in sources}


def drawings() -> list[tuple[dict[str, str], list[tuple[str, str]]]]:
    """Of each graph: names of nodes and the sources that they stand for, and the arrows."""
    text = (ROOT / "host/README.md").read_text()
    graphs = []
    for graph in re.findall(r"```mermaid\ngraph[^\n]*\n(.*?)```", text, re.DOTALL):
        labels = dict(re.findall(r'(\w+)\["`?([\w/.]+)', graph))
        bare = re.sub(r'\["[^"]*"\]', "", graph)
        arrows = re.findall(r"^\s*(\w+)\s*-->(?:\|[^|]*\|)?\s*(\w+)\s*$", bare, re.MULTILINE)
        graphs.append((labels, arrows))
    return graphs


def reachable(arrows: set[tuple[str, str]], start: str) -> set[str]:
    found, todo = set(), [start]
    while todo:
        node = todo.pop()
        for a, b in arrows:
            if a == node and b not in found:
                found.add(b)
                todo.append(b)
    return found


def stem(path: str) -> str:
    """host/intersect/intersector.cpp -> intersect/intersector."""
    return re.sub(r"^host/|\.(h|cpp)$", "", path)


class Drawings(unittest.TestCase):
    def setUp(self) -> None:
        self.includes = includes()
        self.graphs = drawings()
        self.assertTrue(self.includes)
        self.assertGreaterEqual(len(self.graphs), 4)

    def test_rooms(self) -> None:
        """The first drawing: every arrow is an include, and every include follows from arrows."""
        labels, arrows = self.graphs[0]
        self.assertFalse(labels)
        drawn = set(arrows)
        rooms = {name for arrow in drawn for name in arrow}
        real = {(room(a), room(b)) for a, targets in self.includes.items() for b in targets}
        real = {(a, b) for a, b in real if a != b}
        for a, b in sorted(drawn):
            self.assertIn((a, b), real, f"drawn, but nothing in {a} includes {b}")
        for a, b in sorted(real):
            self.assertIn(a, rooms, f"{a} is not drawn")
            self.assertIn(b, reachable(drawn, a), f"{a} includes {b}, which is not drawn")
        for name in sorted(rooms):
            self.assertNotIn(name, reachable(drawn, name), f"{name} is part of a circle")

    def test_folders(self) -> None:
        """The second drawing: folders within rooms, by the rules of the first."""
        labels, arrows = self.graphs[1]
        self.assertTrue(arrows)
        nodes = set(labels.values())
        drawn = {(labels[a], labels[b]) for a, b in arrows}
        real = {(folder(a), folder(b)) for a, targets in self.includes.items() for b in targets}
        self.assertEqual(drawn - real, set(), "drawn, but no such include")
        for a, b in sorted(real):
            if a != b and {a, b} <= nodes:
                self.assertIn(b, reachable(drawn, a), f"{a} includes {b}, which is not drawn")
        inner = {name for pair in real for name in pair
                 if name.count("/") == 2 and name.split("/")[0] + "/" in nodes}
        self.assertEqual(inner - nodes, set(), "folders that are not drawn")
        for node in nodes:
            self.assertNotIn(node, reachable(drawn, node), f"{node} is part of a circle")

    def test_ways(self) -> None:
        """The other drawings: nodes are sources, arrows are includes, and no include between two nodes is left out."""
        pairs = {(stem(a), stem(b)) for a, targets in self.includes.items() for b in targets}
        stems = {stem(path) for path in self.includes}
        for labels, arrows in self.graphs[2:]:
            self.assertTrue(arrows)
            for label in labels.values():
                self.assertIn(label, stems, "drawn, but no such source")
            drawn = {(labels[a], labels[b]) for a, b in arrows}
            for arrow in sorted(drawn):
                self.assertTrue(arrow in pairs, f"drawn, but no such include: {arrow}")
            for a, b in sorted(pairs):
                if a != b and {a, b} <= set(labels.values()) and (b, a) not in drawn:
                    self.assertIn(b, reachable(drawn, a), f"{a} includes {b}, which is not drawn")


if __name__ == "__main__":
    unittest.main()
