# SPDX-License-Identifier: Apache-2.0
"""examples_test.py PELAGE: every scene in examples/ can be read, with all its assets."""
import pathlib
import subprocess
import sys
import unittest

EXAMPLES = pathlib.Path(__file__).resolve().parents[2] / "examples"
PELAGE = sys.argv.pop()


class Examples(unittest.TestCase):
    def test_each_is_read(self):
        scenes = sorted(EXAMPLES.glob("*.yaml"))
        self.assertGreaterEqual(len(scenes), 3)
        for scene in scenes:
            with self.subTest(scene=scene.name):
                run = subprocess.run([PELAGE, "info", scene], capture_output=True, text=True, timeout=60)
                self.assertEqual((run.returncode, run.stderr), (0, ""))
                self.assertNotEqual(run.stdout, "")


if __name__ == "__main__":
    unittest.main()
