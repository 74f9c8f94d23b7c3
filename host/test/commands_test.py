"""Finds the commands of a page, and reports a command that fails."""

import contextlib
import io
import os
import pathlib
import sys
import tempfile
import unittest

import commands

PAGE = """# A page

```sh
echo one   # a comment
false
test -f model.obj; ./render --serve  # shown
```

Write `model.json` and render that:

```json
{"a": 1}
```

```python
a = 1
```

```sh
grep -q a model.json
```

```python
assert a == 1
```
"""


class Commands(unittest.TestCase):
    def test_are_lines_of_shells_files_and_one_program(self) -> None:
        self.assertEqual(commands.commands(PAGE), [
            "echo one   # a comment", "false", "test -f model.obj; ./render --serve  # shown", "cat >model.json <<'END'\n{\"a\": 1}\nEND",
            "grep -q a model.json", "cat >page.py <<'END'\na = 1\nassert a == 1\nEND\n\"$PYTHON\" page.py"])

    def test_what_fails_is_told_and_the_rest_runs(self) -> None:
        said = io.StringIO()
        with tempfile.TemporaryDirectory() as name, contextlib.redirect_stdout(said):
            folder = pathlib.Path(name)
            commands.prepare(folder)
            page = [command for command in commands.commands(PAGE) if "serve" not in command]
            (failed,) = commands.run("a.md", page, folder, os.environ | {"PYTHON": sys.executable})
        self.assertRegex(failed, "^a.md: false: ended with status 1; see build/commands-a.log$")
        self.assertEqual(said.getvalue().count("\n"), len(page))

    def test_pages_have_some(self) -> None:
        for name in commands.PAGES:
            self.assertGreater(len(commands.commands((commands.ROOT / name).read_text())), 2, name)


if __name__ == "__main__":
    unittest.main()
