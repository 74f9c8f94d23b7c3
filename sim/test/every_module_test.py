"""Every module of hw/ is named by a test: <module>_test.cpp, an instance in a test's top, a model of it, or a
test's line `// Tests: <module>`.

Prints file: found, expected and exits 1 where one is not; and where it finds no module at all."""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent


def untested(hardware: list[pathlib.Path], tests: str) -> list[pathlib.Path]:
    """Those of the files of modules that nothing in `tests` names."""
    return [file for file in hardware if not re.search(
        rf"^ *{file.stem} (#\(|u_)|\bTOP {file.stem}\b|^// Tests: .*\b{file.stem}\b"
        rf"|\b{file.stem}_test\b", tests, re.M)]


def main() -> int:
    """The check, and that it can fail."""
    hardware = sorted(file for file in ROOT.glob("hw/*/*.sv") if not file.stem.endswith("_pkg"))
    tests = "\n".join(file.read_text() for pattern in ("test/**/*.sv", "test/**/*_test.cpp", "**/CMakeLists.txt")
                      for file in (ROOT / "sim").glob(pattern))
    missing = untested(hardware, tests)
    for file in missing:
        print(f"{file.relative_to(ROOT)}: found no test of it, expected an instance in a top of sim/test "
              "or a model in sim/")
    seen = untested([*hardware, pathlib.Path("no_such_module.sv")], tests)
    if not hardware or len(seen) != len(missing) + 1:
        print(f"{len(hardware)} modules: the check itself is wrong")
        return 1
    print(f"{len(hardware)} modules, {len(missing)} without a test")
    return 1 if missing else 0


if __name__ == "__main__":
    sys.exit(main())
