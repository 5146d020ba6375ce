# SPDX-License-Identifier: Apache-2.0
"""examples_test.py PELAGE [TESTS]: every scene in examples/ can be read, with all its assets; the small colony renders."""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

EXAMPLES = pathlib.Path(__file__).resolve().parents[2] / "examples"
PELAGE = sys.argv.pop(1)


class Examples(unittest.TestCase):
    def test_each_is_read(self):
        scenes = sorted(EXAMPLES.glob("*.yaml"))
        self.assertGreaterEqual(len(scenes), 3)
        for scene in scenes:
            with self.subTest(scene=scene.name):
                run = subprocess.run([PELAGE, "info", scene], capture_output=True, text=True, timeout=60)
                self.assertEqual((run.returncode, run.stderr), (0, ""))
                self.assertNotEqual(run.stdout, "")

    def test_the_small_colony_renders(self):
        # All its rats in a picture of a few pixels; the cache of its coats stays out of the tree.
        with tempfile.TemporaryDirectory() as folder:
            overrides = ["image.width=32", "image.height=18", "render.samples=1", "render.lod.enabled=false",
                         "grooms.under.cache.directory=" + folder, "grooms.guard.cache.directory=" + folder,
                         "grooms.whiskers.cache.directory=" + folder]
            command = [PELAGE, "render", EXAMPLES / "colony_small.yaml", "-o", folder + "/colony.exr", "--quiet",
                       "--stats", folder + "/stats.json"]
            for override in overrides:
                command += ["--set", override]
            run = subprocess.run(command, capture_output=True, text=True, timeout=300)
            self.assertEqual((run.returncode, run.stderr), (0, ""))
            statistics = json.loads(pathlib.Path(folder, "stats.json").read_text())
            self.assertEqual(statistics["strands_described"], 25 * 8000)
            self.assertEqual(statistics["strands_unique"], 25 * 8000)
            self.assertEqual(statistics["characters_in_frame"], 25)

    def test_the_bear_is_what_its_script_writes(self):
        sys.path.insert(0, str(EXAMPLES))
        import make_bear
        with tempfile.TemporaryDirectory() as folder:
            make_bear.write_meshes(pathlib.Path(folder))
            written = sorted(pathlib.Path(folder).iterdir())
            self.assertEqual(len(written), 4)
            for path in written:
                self.assertEqual(path.read_text(), (EXAMPLES / "bear" / path.name).read_text(), path.name)


if __name__ == "__main__":
    unittest.main()
