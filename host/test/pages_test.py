"""Tests the Markdown pages: links lead to existing files and headings, and `make` targets in them exist. Tests `make`: it
refuses unknown variables, treats empty variables as not given, and runs one build at a time."""

import fcntl
import os
import pathlib
import re
import shlex
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]


def pages() -> list[pathlib.Path]:
    """Returns all pages of the repository, except those in build folders."""
    folders = [folder for folder in ROOT.iterdir() if folder.is_dir() and not folder.name.startswith((".", "build"))]
    return [*ROOT.glob("*.md"), *(page for folder in folders for page in folder.rglob("*.md"))]


def anchors(text: str) -> set[str]:
    """Returns the anchors that GitHub makes of the headings."""
    heads = re.findall(r"^#+ (.*)$", re.sub(r"^```.*?^```", "", text, flags=re.DOTALL | re.MULTILINE), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", re.sub(r"\[(.*?)\]\(.*?\)", r"\1", head).lower()).replace(" ", "-") for head in heads}


def recipe(words: str) -> str:
    """Returns the commands that `make` would run. Flags of a make that runs this test have no effect."""
    return subprocess.run(["make", "--no-print-directory", "-n", "SETUP=true", *words.split()], cwd=ROOT, capture_output=True, text=True,
                          check=False, env={name: value for name, value in os.environ.items() if name != "MAKEFLAGS"}).stdout


class Pages(unittest.TestCase):
    def setUp(self) -> None:
        self.texts = {page: page.read_text() for page in pages()}
        self.assertGreater(len(self.texts), 20)

    def test_anchors(self) -> None:
        self.assertEqual(anchors("# A `b`, c\n```\n# no\n```\n## [D](x.md) - e\n"), {"a-b-c", "d---e"})

    def test_links_lead_somewhere(self) -> None:
        links = [(page, link) for page, text in self.texts.items()
                 for link in re.findall(r"\]\(([^)\s]+)\)", re.sub(r"```.*?```", "", text, flags=re.DOTALL)) if "://" not in link]
        self.assertGreater(len(links), 100)
        for page, link in links:
            name, _, anchor = link.partition("#")
            there = (page.parent / name).resolve() if name else page
            self.assertTrue(there.exists(), f"{page.relative_to(ROOT)}: {link}: no such file")
            if anchor:
                self.assertIn(anchor, anchors(there.read_text()), f"{page.relative_to(ROOT)}: {link}: no such heading")

    def test_make_targets_exist(self) -> None:
        makefiles = [ROOT / "Makefile", *ROOT.glob("*/*.mk"), *ROOT.glob("*/*/*.mk")]
        targets = {target for file in makefiles for target in re.findall(r"^([a-z][\w-]*):", file.read_text(), re.MULTILINE)}
        named = [(page, target) for page, text in self.texts.items()
                 for code in re.findall(r"```.*?```|`[^`]+`", text, re.DOTALL)
                 for target in re.findall(r"(?:^`?|&& )make ([a-z][\w-]*)", code, re.MULTILINE)]
        self.assertGreater(len(named), 50)
        for page, target in named:
            self.assertIn(target, targets, f"{page.relative_to(ROOT)}: make {target}")

    def test_each_target_knows_its_words(self) -> None:
        for words, said in (("variant FRACWIDTH=15", "FRACWIDTH: `make variant` does not read it"), ("variant FRAC_WIDTH=15 ONLY=proofs", ""),
                            ("lecture PIXEL=1,2 ARGS=--a=1", ""), ("cpu CXX=clang++", ""), ("lecture A=1365 B=2731 X=1.5 Y=-0.3", ""),
                            ("lecture Z=1", "Z: `make lecture` does not read it"), ("page TOP=adder", "TOP: `make page` does not read it"),
                            ("synth TOP=adder PARAMS=Width=0", "PARAMS: expected VERILOG=1, too"),
                            ("synth FRAC_WIDTH=3", "FRAC_WIDTH: expected TOP, too"), ("synth TOP=adders WIDTH=3", "WIDTH: expected TOP, too"),
                            ("synth TOP=fp_adder FRAC_WIDTH=3 JOBS=2", "")):
            done = subprocess.run(["make", "-n", "SETUP=true", *words.split()], cwd=ROOT, capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 2 if said else 0, words)
            self.assertEqual((done.stderr.count("\n"), said in done.stderr), (int(bool(said)), True), words)

    def test_make_reads_the_words_of_the_pages(self) -> None:
        commands = {line for text in self.texts.values() for line in re.findall(r"(?:^|`)(make [a-z]+ [A-Z_]+=[^`#\n]*)", text, re.M) if "..." not in line}
        self.assertGreater(len(commands), 30)
        for command in commands:
            done = subprocess.run(["make", "-n", "SETUP=true", *shlex.split(command)[1:]], cwd=ROOT, capture_output=True, text=True, check=False)
            self.assertNotRegex(done.stderr, "does not read it|expected TOP, too", command)

    def test_builds_in_one_folder_take_turns(self) -> None:
        with tempfile.TemporaryDirectory() as name, (ROOT / "build" / "lock").open("w") as lock:
            folder = pathlib.Path(name)
            (folder / "cmake").write_text(f"#!/bin/sh\necho $1 >>{folder}/called\n")
            (folder / "cmake").chmod(0o755)
            fcntl.flock(lock, fcntl.LOCK_EX)
            with subprocess.Popen(["make", "SETUP=true", "cpu"], cwd=ROOT, stderr=subprocess.PIPE, text=True,
                                  env=os.environ | {"PATH": f"{folder}:{os.environ['PATH']}"}) as make:
                self.assertEqual(make.stderr.readline(), "Waiting for another build in this folder to finish\n")
                self.assertFalse((folder / "called").exists())
                fcntl.flock(lock, fcntl.LOCK_UN)
                self.assertEqual(make.wait(), 0)
            self.assertEqual((folder / "called").read_text(), "-S\n--build\n")

    def test_set_ups_in_one_folder_take_turns(self) -> None:
        with (ROOT / "build" / "setup.lock").open("w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            with subprocess.Popen([".ci/setup", "lint"], cwd=ROOT, stderr=subprocess.PIPE, text=True) as setup:
                self.assertEqual(setup.stderr.readline(), "Waiting for another set-up in this folder to finish\n")
                fcntl.flock(lock, fcntl.LOCK_UN)
                self.assertEqual(setup.wait(), 0)

    def test_make_variant_lints_a_file_first(self) -> None:
        lines = recipe("variant ADDER=my_adder.sv FRAC_WIDTH=15").splitlines()
        self.assertEqual([shlex.split(line)[-4:] for line in lines[:2]],
                         [["true", "lint"], ["-m", "synth.brought", "FRAC_WIDTH=15", "ADDER=my_adder.sv"]])
        lines = recipe("variant ADDER=prefix FRAC_WIDTH=15").splitlines()
        self.assertRegex(lines[0], "^echo 'One card: .*8 to 10 minutes")
        self.assertNotIn("synth.brought", " ".join(lines))

    def test_an_empty_variable_of_make_counts_as_not_given(self) -> None:
        for target, names in (("lecture", "SCENE PIXEL ARGS EXAMPLE"), ("synth", "TOP ALL JOBS SYNTH_JOBS"), ("variant", "ADDER FRAC_WIDTH SCENE"),
                              ("synth TOP=adder VERILOG=1", "PARAMS"), ("test LONG=mutate", "COUNT"), ("test LONG=fuzz", "FUZZ_SECONDS"), ("test", "LONG")):
            self.assertEqual(recipe(" ".join([target, *(f"{name}=" for name in names.split())])), recipe(target), target)

    def test_jobs_of_synth(self) -> None:
        for words, jobs in (("", 2), ("JOBS=1", 1), ("JOBS=1 SYNTH_JOBS=3", 3)):
            self.assertRegex(recipe(f"synth {words}"), f"--jobs {jobs}\n?$")


if __name__ == "__main__":
    unittest.main()
