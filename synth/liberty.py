"""Reads Liberty files: groups (cells, pins, timing tables, ...) with their attributes and their positions in the text."""

import dataclasses
import functools
import pathlib
import re
from collections.abc import Iterator

TOKEN = re.compile(r'/\*.*?\*/|\\\s*\n|"(?:[^"\\]|\\.)*"|[{}();:]|[^\s{}();:"\\]+', re.S)


@dataclasses.dataclass
class Group:
    """A group `kind (name) { ... }`: its attributes by name (the last of equal names) and its inner groups."""

    kind: str
    name: str
    begin: int  # position in the text, in characters
    end: int = 0
    attributes: dict[str, str] = dataclasses.field(default_factory=dict)
    groups: list["Group"] = dataclasses.field(default_factory=list)

    def of(self, kind: str) -> Iterator["Group"]:
        """Returns the inner groups of `kind`."""
        return (group for group in self.groups if group.kind == kind)

    def number(self, name: str) -> float:
        """Returns an attribute as a number; 0 if the attribute is missing."""
        return float(self.attributes.get(name, 0))


def parse(text: str, name: str) -> Group:
    """Returns the library in a Liberty file's text. Raises ValueError if the text is malformed; the message names the file `name`."""
    top = Group("", "", 0)
    stack, words = [top], []  # words: of the current statement
    tokens = (found for found in TOKEN.finditer(text) if found[0][0] not in "/\\" or found[0][1:2] not in "*\n \t\r")
    for found in tokens:
        token = found[0]
        if token == "{":
            if len(words) < 3 or words[1][0] != "(":
                raise ValueError(f"{name}:{_line(text, found)}: found {{, expected it after a group's name in parentheses")
            group = Group(words[0][0], " ".join(word for word, _ in words[2:-1]).strip('"'), words[0][1])
            stack[-1].groups.append(group)
            stack.append(group)
            words = []
        elif token in ";}":
            _attribute(stack[-1], words)
            words = []
            if token == "}":
                if len(stack) == 1:
                    raise ValueError(f"{name}:{_line(text, found)}: found }}, expected a group that it ends")
                stack.pop().end = found.end()
        else:
            # An attribute without a semicolon ends at the end of its line.
            if len(words) > 2 and words[1][0] == ":" and "\n" in text[words[-1][1]:found.start()] and token not in "():":
                _attribute(stack[-1], words)
                words = []
            words.append((token, found.start()))
    if len(stack) > 1:
        raise ValueError(f"{name}:{text.count(chr(10)) + 1}: found the end of the file, expected }} of {stack[-1].kind} "
                         f"({stack[-1].name})")
    libraries = list(top.of("library"))
    if len(libraries) != 1:
        raise ValueError(f"{name}:1: found {len(libraries)} groups called library, expected one")
    return libraries[0]


def _line(text: str, found: re.Match) -> int:
    return text.count("\n", 0, found.start()) + 1


def _attribute(group: Group, words: list[tuple[str, int]]) -> None:
    """Adds `name : value` or `name (value, ...)` to a group's attributes."""
    if len(words) > 2:
        value = " ".join(word for word, _ in words[2:] if word != ")" or words[1][0] == ":")
        group.attributes[words[0][0]] = value.strip('"') if value.count('"') == 2 else value


@functools.cache
def read(file: pathlib.Path) -> Group:
    """Returns the library in a file. Raises ValueError if the file is not Liberty, FileNotFoundError if there is no file."""
    return parse(file.read_text(errors="replace"), str(file))


def inverters(library: Group) -> list[tuple[float, str]]:
    """Returns the input capacitances and the names of all inverters, the smallest first."""
    found = []
    for cell in library.of("cell"):
        pins = {pin.name: pin for pin in cell.of("pin")}
        inputs = [pin for pin in pins.values() if pin.attributes.get("direction") == "input"]
        functions = [re.sub(r"[\s()]", "", pin.attributes.get("function", "")) for pin in pins.values() if pin not in inputs]
        if len(inputs) == 1 and functions in ([f"!{inputs[0].name}"], [f"{inputs[0].name}'"]):
            found.append((inputs[0].number("capacitance"), cell.name))
    return sorted(found)
