"""Compares the drawings of host/README.md and of its rooms' pages with the includes of the code, which have no circles.

A drawing is a mermaid graph. Its nodes are rooms (folders of host/, or `sim`) or, if they have a path as a label, folders
or sources: `a["intersect/intersector"]`. An arrow (`a --> b & c` is two) says that its first node includes the second,
which must be true. Every include between two nodes must be an arrow or a path of arrows. The drawing of rooms must
have all rooms.
"""

import pathlib
import re
import unittest

# Sources that may include each other, and the reason. A .h and a .cpp of one name count as one.
CIRCLES = {
    "sim/array_model sim/rtl_units": "the Verilated array and the unit that it is, which names the array's stalls",
}

ROOT = pathlib.Path(__file__).resolve().parents[2]
INCLUDE = re.compile(r'^#include "((?:host|sim)/[^"]+)"', re.MULTILINE)


def room(path: str) -> str:
    """Returns a file's room: host/intersect/unit/x.h -> intersect; sim/x.h -> sim."""
    parts = path.split("/")
    return "sim" if parts[0] == "sim" else parts[1]


def folder(path: str) -> str:
    """Returns a file's folder: host/scene/io/x.h -> scene/io/"""
    return path.removeprefix("host/").rpartition("/")[0] + "/"


def includes() -> dict[str, set[str]]:
    """Returns the includes of each source, without tests and fuzz targets. Paths are relative to the root."""
    sources = [path for folder in ("host", "sim") for path in (ROOT / folder).rglob("*")
               if path.suffix in (".h", ".cpp") and not {"test", "fuzz"} & set(path.parts)]
    return {str(path.relative_to(ROOT)): set(INCLUDE.findall(path.read_text()))
            for path in sources}


def drawings() -> list[tuple[dict[str, str], list[tuple[str, str]]]]:
    """Returns, for each graph, the labels of nodes that have a label, by name, and the arrows as pairs of names."""
    pages = [ROOT / "host/README.md", *sorted(ROOT.glob("host/*/README.md"))]
    text = "".join(page.read_text() for page in pages)
    graphs = []
    for graph in re.findall(r"```mermaid\ngraph[^\n]*\n(.*?)```", text, re.DOTALL):
        labels = dict(re.findall(r'(\w+)\["`?([\w/.]+)', graph))
        bare = re.sub(r'\["[^"]*"\]', "", graph)
        arrows = [(a, b) for a, targets in re.findall(r"^\s*(\w+) --> ([\w &]+)$", bare, re.MULTILINE)
                  for b in targets.split(" & ")]
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


def circles(arrows: set[tuple[str, str]]) -> set[str]:
    """Returns the groups of nodes that reach each other, each as a text of sorted names."""
    arrows = {(a, b) for a, b in arrows if a != b}
    reached = {node: reachable(arrows, node) for arrow in arrows for node in arrow}
    return {" ".join(sorted(b for b in reached[a] if a in reached[b])) for a in reached if a in reached[a]}


def stem(path: str) -> str:
    """Returns a source's name in drawings: host/intersect/intersector.cpp -> intersect/intersector."""
    return re.sub(r"^host/|\.(h|cpp)$", "", path)


class Drawings(unittest.TestCase):
    def setUp(self) -> None:
        self.includes = includes()
        self.graphs = drawings()
        self.assertTrue(self.includes)
        self.assertGreaterEqual(len(self.graphs), 3)

    def test_rooms(self) -> None:
        """The first drawing, of rooms: every arrow is an include, and every include is a path of arrows."""
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
        """The second drawing has folders within rooms, and follows the rules of the first."""
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

    def test_no_circle_among_folders(self) -> None:
        """No folders of host/ and sim/ include each other, directly or indirectly, through headers or sources."""
        self.assertEqual(circles({("a/", "b/"), ("b/", "c/"), ("c/", "a/"), ("c/", "d/")}), {"a/ b/ c/"})
        self.assertEqual(circles({(folder(a), folder(b)) for a, targets in self.includes.items() for b in targets}), set())

    def test_no_circle_among_sources(self) -> None:
        """Only the sources in CIRCLES include each other. A header and its source count as one."""
        pairs = {(stem(a), stem(b)) for a, targets in self.includes.items() for b in targets}
        self.assertEqual(circles(pairs), set(CIRCLES))


if __name__ == "__main__":
    unittest.main()
