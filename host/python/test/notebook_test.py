"""The notebook runs from end to end and draws its figures. With --renew, stores the new outputs in it."""

import pathlib
import sys
import unittest

import nbclient
import nbformat

ROOT = pathlib.Path(__file__).parents[3]
FILE = ROOT / "host/docs/three_figures.ipynb"


def executed():
    """The notebook with new outputs; a cell that fails raises its error."""
    notebook = nbformat.read(FILE, 4)
    nbclient.NotebookClient(notebook, timeout=300, record_timing=False, resources={"metadata": {"path": str(FILE.parent)}}).execute()
    return notebook


def figures(notebook):
    return [output for cell in notebook.cells for output in cell.get("outputs", []) if "image/png" in output.get("data", {})]


class Notebook(unittest.TestCase):
    def test_runs_and_draws(self):
        notebook = executed()
        self.assertEqual(len(figures(notebook)), 3)
        printed = "".join(output.get("text", "") for cell in notebook.cells for output in cell.get("outputs", []))
        self.assertIn("raygate                 0 of 200,000 rays hit nothing", printed)

    def test_is_kept_with_its_figures(self):
        notebook = nbformat.read(FILE, 4)
        nbformat.validate(notebook)
        self.assertEqual(len(figures(notebook)), 3)
        counts = [cell.execution_count for cell in notebook.cells if cell.cell_type == "code"]
        self.assertEqual(counts, list(range(1, len(counts) + 1)), "not run from top to bottom")


if __name__ == "__main__":
    if "--renew" in sys.argv:
        renewed = executed()
        renewed.metadata.pop("language_info", None)
        nbformat.write(renewed, FILE)
    else:
        unittest.main()
