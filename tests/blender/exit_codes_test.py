# SPDX-License-Identifier: Apache-2.0
"""Blender as a farm runs it: exit codes, files, and what is left when a render is stopped or Blender dies.

package_test.py has a complete picture, and engine_test.py a program that crashes.
"""
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest

HERE = pathlib.Path(__file__).parent
BLENDER = sys.argv.pop(1) if len(sys.argv) > 1 and not sys.argv[1].startswith("-") else "blender"
BEGIN = f"""
import sys
sys.path.insert(0, {str(HERE)!r})
import inside, bpy, pelage_blender
from inside import *
pelage_blender.register()
scene = empty_scene(64, 64)
grey_plane()
camera()
set_world(1)
"""


class ExitCodes(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory(prefix="pelage-test-")
        self.addCleanup(self.folder.cleanup)
        self.path = pathlib.Path(self.folder.name)

    def blender(self, script, *flags):
        (self.path / "script.py").write_text(BEGIN + script)
        command = [BLENDER, "-b", "--factory-startup", "--python-exit-code", "7", "-P", str(self.path / "script.py"), *flags]
        # Blender's and the add-on's temporary folders are below this one.
        environment = {**os.environ, "TMPDIR": self.folder.name}
        return subprocess.Popen(command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                                start_new_session=True)

    def left(self):
        return [p.name for p in self.path.iterdir() if p.name.startswith("pelage-blender-")]

    def children(self):
        """Processes of the program that work in the folder of this test."""
        found = []
        for entry in pathlib.Path("/proc").glob("[0-9]*/cmdline"):
            try:
                words = entry.read_bytes().split(b"\0")
            except OSError:
                continue
            if any(self.folder.name.encode() in word for word in words) and words[1:2] == [b"render"]:
                found.append(int(entry.parent.name))
        return found

    def wait_for_child(self, process):
        for _ in range(3000):
            if self.children():
                return self.children()[0]
            self.assertIsNone(process.poll(), "Blender has ended")
            time.sleep(0.05)
        self.fail("no render has started")

    def test_an_error_is_1_and_no_picture(self):
        process = self.blender("scene.pelage.memory = 64\nscene.render.resolution_x = scene.render.resolution_y = 4000\n",
                               "-o", f"{self.path}/a#.png", "-F", "PNG", "-f", "1")
        text = process.communicate(timeout=300)[0]
        self.assertEqual(process.returncode, 1, text)
        self.assertIn("memory", text)
        self.assertEqual(list(self.path.glob("*.png")), [])
        self.assertEqual(self.left(), [])

    def test_an_interrupted_render_ends_the_program(self):
        process = self.blender("scene.pelage.samples = 100000\nscene.frame_end = 3\n",
                               "-o", f"{self.path}/a#.png", "-F", "PNG", "-a")
        child = self.wait_for_child(process)
        self.assertNotEqual(os.getsid(child), os.getsid(process.pid))
        os.kill(process.pid, signal.SIGINT)
        text = process.communicate(timeout=300)[0]
        self.assertEqual(process.returncode, 1, text)
        self.assertEqual(list(self.path.glob("*.png")), [])
        self.assertEqual((self.left(), self.children()), ([], []))

    def test_the_program_ends_with_a_blender_that_is_killed(self):
        process = self.blender("scene.pelage.samples = 100000\n", "-o", f"{self.path}/a#.png", "-F", "PNG", "-f", "1")
        self.wait_for_child(process)
        process.kill()
        process.communicate()
        for _ in range(600):
            if not self.children():
                break
            time.sleep(0.05)
        self.assertEqual(self.children(), [])
        self.assertEqual(len(self.left()), 1)  # plain_test.py: the next start removes the folder


if __name__ == "__main__":
    unittest.main(verbosity=2)
