"""Published results have a date, and pages quote what they say."""

import contextlib
import csv
import io
import pathlib
import re
import subprocess
import tempfile
import unittest
import unittest.mock

from host.lab import claims, evidence, rows

RESULT = "| unit | MHz |\n|---|---|\n| pipelined | 127.3 |\n| 458,862,344 tests | 0 |\n"


class Quotes(unittest.TestCase):
    def misquoted(self, page: str, quote: str, line: str) -> list[str]:
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            (folder / "page.md").write_text(page)
            (folder / "result.md").write_text(RESULT)
            return claims.misquoted([{"page": "page.md", "quote": quote, "result": "result.md", "line": line}], folder)

    def test_of_every_page_are_in_their_results(self) -> None:
        quotes = list(csv.DictReader(claims.QUOTES.read_text().splitlines()))
        self.assertGreater(len(quotes), 5)
        self.assertEqual(claims.misquoted(quotes, claims.ROOT), [])

    def test_to_as_many_digits_as_they_have(self) -> None:
        self.assertEqual(self.misquoted("at 127\nMHz", "127 MHz", "pipelined"), [])
        self.assertEqual(self.misquoted("459 million", "459 million", "tests"), [])
        self.assertIn("no such line", self.misquoted("127.4 MHz", "127.4 MHz", "pipelined")[0])
        self.assertIn("no such line", self.misquoted("127 MHz", "127 MHz", "tests")[0])
        self.assertIn("no such line", self.misquoted("fast", "fast", "pipelined")[0])

    def test_stand_in_their_pages(self) -> None:
        self.assertIn("no longer has", self.misquoted("128 MHz", "127 MHz", "pipelined")[0])


class Evidence(unittest.TestCase):
    def test_every_published_page_has_a_row(self) -> None:
        known = rows.read(evidence.FILE)
        published = [file for file in evidence.FILE.parent.glob("*.md") if file != evidence.PAGE]
        self.assertLessEqual({str(file.relative_to(rows.ROOT)) for file in published}, {row["page"] for row in known})
        for row in known:
            self.assertTrue((rows.ROOT / row["page"]).exists(), row)
            self.assertEqual([path for path in row["paths"] if not (rows.ROOT / path.removeprefix(":(exclude)")).exists()], [])
            self.assertRegex(f"{row['commit']} {row['date']} {row['command']}", r"^[0-9a-f]{12} \d{4}-\d\d-\d\d make ")
        for file in published:
            for promised in re.findall(r"`(\w+\.csv)`", file.read_text()):
                self.assertTrue((file.parent / promised).exists(), f"{file}: {promised}")

    def test_was_measured_at_a_commit_of_this_history(self) -> None:
        try:
            shallow = evidence.git("rev-parse", "--is-shallow-repository")
        except (FileNotFoundError, subprocess.CalledProcessError):
            self.skipTest("no history")
        if shallow != ["false"]:
            self.skipTest("not the whole history")
        for row in rows.read(evidence.FILE):
            evidence.git("merge-base", "--is-ancestor", row["commit"], "HEAD")

    def test_code_that_changed_makes_it_stale(self) -> None:
        with tempfile.TemporaryDirectory() as name:
            root = pathlib.Path(name)

            def commit(file: str, subject: str) -> str:
                (root / file).parent.mkdir(parents=True, exist_ok=True)
                (root / file).write_text(subject)
                for words in (["add", "."], ["-c", "user.name=a", "-c", "user.email=a@b", "commit", "-qm", subject]):
                    subprocess.run(["git", "-C", root, *words], check=True)
                return evidence.git("rev-parse", "HEAD", root=root)[0]

            subprocess.run(["git", "init", "-q", root], check=True)
            row = {"commit": commit("hw/a.sv", "measured"), "paths": ["hw"]}
            commit("hw/README.md", "words")
            commit("hw/test/a.cpp", "a test")
            commit("host/b.cpp", "elsewhere")
            self.assertEqual(evidence.changes(row, root), [])
            commit("hw/b.sv", "another adder")
            self.assertEqual([line.split(" ", 1)[1] for line in evidence.changes(row, root)], ["another adder"])
            self.assertEqual(evidence.changes(row | {"paths": ["hw", ":(exclude)hw/b.sv"]}, root), [])

    def test_publishing_renews_the_row(self) -> None:
        with tempfile.TemporaryDirectory() as name:
            file = pathlib.Path(name) / "evidence.jsonl"
            rows.write(file, [{"page": "a.md", "commit": "1", "paths": ["hw"]}, {"page": "b.md", "commit": "1"}])
            with unittest.mock.patch.object(evidence, "FILE", file):
                evidence.renew("a.md", {"commit": "2", "date": "2026-01-02", "processor": "P", "processors": 3}, "make a")
                with self.assertRaisesRegex(ValueError, "c.md: expected one of a.md, b.md"):
                    evidence.renew("c.md", {})
            self.assertEqual(rows.read(file), [{"page": "a.md", "commit": "2", "paths": ["hw"], "command": "make a", "date": "2026-01-02",
                                                "machine": "P, 3 processors"}, {"page": "b.md", "commit": "1"}])

    def test_without_history_it_says_so(self) -> None:
        told = io.StringIO()
        with unittest.mock.patch.object(evidence, "changes", side_effect=FileNotFoundError("git")), contextlib.redirect_stderr(told):
            self.assertEqual(evidence.main(), 2)
        self.assertIn("no history", told.getvalue())


if __name__ == "__main__":
    unittest.main()
