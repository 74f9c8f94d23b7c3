"""A proof refuses what is broken: the array, with a wrong wire in a lane or a counter that misses events."""

import pathlib
import tempfile
import unittest
import unittest.mock

from synth import catalogue, prove, store, tools


def broken(files: list[pathlib.Path], folder: pathlib.Path, before: str, after: str) -> list[pathlib.Path]:
    """The same files, the array's with a fault in it."""
    array = catalogue.HW / "hit_test" / "hit_test_array.sv"
    text = array.read_text()
    assert text.count(before) == 1, before
    (folder / array.name).write_text(text.replace(before, after))
    return [folder / array.name if file == array else file for file in files]


class ProofsRefuseFaults(unittest.TestCase):
    def test_of_the_array(self):
        around = prove._around
        for before, after in ((".tag_i(tag_i[TagWidth*n +: TagWidth])", ".tag_i(tag_i[0 +: TagWidth])"),
                              (".ready_i(ready_i[n])", ".ready_i(ready_i[Lanes-1-n])"),
                              ("n < Lanes; n++) begin\n        increment", "n < Lanes-1; n++) begin\n        increment"),
                              ("count_q + increment", "count_q | increment")):
            with self.subTest(after), tempfile.TemporaryDirectory() as folder:
                path = pathlib.Path(folder)
                with unittest.mock.patch.object(store, "OUT", path), unittest.mock.patch.object(
                        prove, "_around", lambda *names, p=path, b=before, a=after: broken(around(*names), p, b, a)):
                    with self.assertRaisesRegex(tools.ToolFailed, "array_is_its_lanes.sv"):
                        prove.array()


if __name__ == "__main__":
    unittest.main()
