# SPDX-License-Identifier: Apache-2.0
"""Each of examples/python runs, and so do the first lines of docs/PYTHON.md, with small pictures."""
import contextlib
import io
import pathlib
import re
import runpy
import sys
import tempfile
import unittest
import unittest.mock

SOURCE = pathlib.Path(__file__).resolve().parents[2]


class Examples(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def run_example(self, name, *arguments):
        picture = self.folder / "picture.png"
        arguments = [f"{name}.py", str(picture), *arguments]
        with unittest.mock.patch.object(sys, "argv", arguments), contextlib.redirect_stdout(io.StringIO()):
            runpy.run_path(str(SOURCE / "examples/python" / arguments[0]), run_name="__main__")
        self.assertTrue(picture.read_bytes().startswith(b"\x89PNG"))

    def test_each_example_writes_its_picture(self):
        shown = re.findall(r"\((\w+)\.py\)", (SOURCE / "examples/python/README.md").read_text(encoding="utf-8"))
        files = {path.stem for path in (SOURCE / "examples/python").glob("*.py")}
        self.assertEqual(set(shown), files)
        few = {"sweep": ["32"], "numpy_groom": ["24"], "layers": ["32"], "waves": ["24"], "lobes": ["chiang"]}
        for name in shown:
            with self.subTest(name):
                self.run_example(name, *few.get(name, []))

    def test_the_guide_starts_with_lines_that_run(self):
        text = (SOURCE / "docs/PYTHON.md").read_text(encoding="utf-8")
        code = re.search(r"```python\n(.*?)```", text, re.DOTALL).group(1)
        self.assertLessEqual(len(code.splitlines()), 10)
        small = code.replace('"width": 480, "height": 270', '"width": 32, "height": 18')
        self.assertNotEqual(small, code)
        with contextlib.chdir(self.folder):
            exec(compile(small, "PYTHON.md", "exec"), {})  # the guide is ours
        self.assertEqual(len(list(self.folder.glob("*.jpg"))), 1)

    def test_the_guide_draws_a_figure_in_ten_lines(self):
        text = (SOURCE / "docs/PYTHON.md").read_text(encoding="utf-8")
        code = re.search(r"```python\n(import matplotlib.*?)```", text, re.DOTALL).group(1)
        self.assertLessEqual(len(code.splitlines()), 10)
        small = code.replace(', 63)', ', 7)').replace(', 121)', ', 9)').replace(', 25)', ', 3)').replace(', "chiang", "yan-fast", "yan"]', ']')
        self.assertNotEqual(small, code)
        with contextlib.chdir(self.folder):
            exec(compile(small, "PYTHON.md", "exec"), {})  # the guide is ours
        self.assertTrue((self.folder / "models.png").is_file())


if __name__ == "__main__":
    unittest.main()
