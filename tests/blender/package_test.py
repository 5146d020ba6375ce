# SPDX-License-Identifier: Apache-2.0
"""The zip of tools/package_blender, installed in a Blender of its own, and the steps of docs/BLENDER.md run there."""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
STEPS = re.search(r"```python\n(.*?)```", (ROOT / "docs" / "BLENDER.md").read_text(), re.DOTALL).group(1)
INSTALL = """
import bpy
bpy.ops.preferences.addon_install(filepath={zip!r})
for step in (bpy.ops.preferences.addon_enable, bpy.ops.preferences.addon_disable, bpy.ops.preferences.addon_enable):
    step(module="pelage_blender")
assert bpy.context.preferences.addons["pelage_blender"].preferences.program == ""
"""


class Package(unittest.TestCase):
    def test_the_steps_of_the_guide(self):
        with tempfile.TemporaryDirectory(prefix="pelage-test-") as name:
            folder = pathlib.Path(name)
            zipped = [folder / "a.zip", folder / "b.zip"]
            for path in zipped:
                subprocess.run([sys.executable, ROOT / "tools" / "package_blender", path], check=True, stdout=subprocess.DEVNULL)
            self.assertEqual(zipped[0].read_bytes(), zipped[1].read_bytes())
            (folder / "examples").symlink_to(ROOT / "examples")
            (folder / "out").mkdir()
            small = ("scene.render.resolution_x, scene.render.resolution_y = 32, 18\n"
                     "scene.pelage.samples, scene.pelage.bounces, coat.strands = 1, 0, 5000\n")
            steps = STEPS.replace("bpy.ops.render.render", small + "bpy.ops.render.render")
            steps = steps.replace("out/blender.png", "out/Ratte ü '#.png")
            self.assertIn(small, steps)
            (folder / "steps.py").write_text(INSTALL.format(zip=str(zipped[0])) + steps)
            environment = {**os.environ, "BLENDER_USER_SCRIPTS": str(folder / "scripts"), "TMPDIR": name,
                           "BLENDER_USER_CONFIG": str(folder / "config"), "PWD": name}
            (folder / "scripts" / "addons").mkdir(parents=True)
            (folder / "config").mkdir()
            result = subprocess.run([shutil.which("blender"), "-b", "--factory-startup", "--python-exit-code", "7", "-P",
                                     str(folder / "steps.py")], cwd=folder, env=environment, stdout=subprocess.PIPE,
                                    stderr=subprocess.STDOUT, text=True, timeout=300)
            self.assertEqual(result.returncode, 0, result.stdout)
            self.assertNotIn("Error", result.stdout)
            self.assertTrue((folder / "out" / "Ratte ü '#.png").exists(), result.stdout)
            self.assertTrue((folder / "scripts" / "addons" / "pelage_blender" / "engine.py").exists(), result.stdout)
            self.assertEqual([p for p in os.listdir(folder) if p.startswith("pelage-blender-")], [])


if __name__ == "__main__":
    unittest.main(verbosity=2)
