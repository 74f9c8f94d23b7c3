"""Reads the lists of hardware files, hw/*/*.core, in FuseSoC's format (CAPI2). All tools use these lists.

`python3 -m synth.cores [CORE ...]` prints the files of the named cores (hit_test, ...; default: all cores) and of the cores that these
depend on, one file per line, in compilation order: a core follows the cores that it uses, and its packages come first. The exit status is
2 if a list and its folder disagree.
"""

import pathlib
import re
import sys

HW = pathlib.Path(__file__).resolve().parent.parent / "hw"


def names(hw: pathlib.Path = HW) -> list[str]:
    """Returns the names of all cores, each core after the cores that it depends on."""
    return _ordered(sorted(file.stem for file in hw.glob("*/*.core")), hw)


# A folder of files to use instead of those of the same names in hw/ (see brought.py).
replaced: pathlib.Path | None = None


def files(core: str, hw: pathlib.Path = HW) -> list[pathlib.Path]:
    """Returns the files of `core` and of all cores that it depends on, in compilation order.

    Raises ValueError if a list names a file that does not exist, or omits a file of its folder.
    """
    found = [file for name in _ordered([core], hw) for file in _own(name, hw)]
    return [replaced / file.name if replaced and (replaced / file.name).exists() else file for file in found]


def used(top: str, among: list[pathlib.Path]) -> list[pathlib.Path]:
    """Returns the files of `among` that module `top` needs: the file of `top` and, recursively, of every module named in such a file."""
    at = {file.stem: file for file in among}
    needed, open_ends = set(), {top} & at.keys()
    while open_ends:
        needed |= open_ends
        words = {word for name in open_ends
                 for word in re.findall(r"\w+", re.sub(r"//[^\n]*", "", at[name].read_text()))}
        open_ends = words & at.keys() - needed
    return [file for file in among if file.stem in needed]


def _entries(core: str, pattern: str, hw: pathlib.Path) -> list[str]:
    file = hw / core / f"{core}.core"
    if not file.exists():
        raise ValueError(f"{file}: not found, expected the list of the files in {file.parent}")
    return re.findall(rf"^ +- {pattern}$", file.read_text(), re.M)


def _own(core: str, hw: pathlib.Path) -> list[pathlib.Path]:
    listed = [hw / core / name for name in _entries(core, r"(\w+\.sv)", hw)]
    there = set((hw / core).glob("*.sv"))
    for file in sorted(there ^ set(listed)):
        found, expected = ("unlisted", "a line") if file in there else ("listed", "the file")
        raise ValueError(f"{hw / core / core}.core: {file.name} is {found}, expected {expected}")
    return sorted(listed, key=lambda file: not file.stem.endswith("_pkg"))


def _ordered(cores: list[str], hw: pathlib.Path) -> list[str]:
    order: dict[str, None] = {}
    for core in cores:
        order |= dict.fromkeys(_ordered(_entries(core, r"raygate:hw:(\w+)", hw), hw)) | {core: None}
    return list(order)


def main() -> int:
    """Runs the command line: prints the files, relative to the repository's root."""
    try:
        found = dict.fromkeys(file for core in sys.argv[1:] or names() for file in files(core))
    except ValueError as error:
        print(error, file=sys.stderr)
        return 2
    print("\n".join(str(file.relative_to(HW.parent)) for file in found))
    return 0


if __name__ == "__main__":
    sys.exit(main())
