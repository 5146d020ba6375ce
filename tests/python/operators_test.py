# SPDX-License-Identifier: Apache-2.0
"""Operators in Python, in this interpreter and in the program's own."""
import json
import os
import pathlib
import subprocess
import tempfile
import threading
import unittest

import numpy as np
import pelage
from small import cube_obj, same_layers, scene_values

PROGRAM = pathlib.Path(pelage.__file__).parents[2] / "bin" / "pelage"
MODULE = """import numpy as np

def sway(strands, amount=0.05):
    strands.points += amount * strands.along[:, None] ** 2 * (strands.random() - 0.5)[:, None, None]
    return strands.points

def look(strands):
    n, k = len(strands), len(strands.along)
    assert strands.points.shape == (n, k, 3) and strands.widths.shape == (n, k)
    assert strands.roots.shape == strands.rest_roots.shape == (n, 3) and strands.uv.shape == (n, 2)
    assert strands.frames.shape == strands.rest_frames.shape == (n, 3, 3) and strands.ids.dtype == np.uint64
    assert np.allclose(np.abs(strands.rest_roots).max(axis=1), 0.5) and strands.scale == 1
    assert np.allclose(np.linalg.det(strands.frames), 1, atol=1e-5) and (strands.points[:, 0] == 0).all()
    red = strands.attributes["clump"][:, None] * [1, 0, 0]
    return {"widths": strands.widths / 2, "color": red}

def mean(strands):
    return strands.points - 0.1 * (strands.points - strands.points.mean(axis=0)) * strands.along[:, None]

def noise(strands):
    return strands.points + np.random.default_rng().normal(size=(len(strands), 1, 1)) * 1e-3 * strands.along[:, None]

def fail(strands):
    if 7 in strands.ids:
        return 1 / 0
    return strands.points

def stop(strands):
    raise SystemExit(1)

def wrong(strands, what):
    return {"none": None, "shape": strands.points[:, 1:], "text": np.array(["a"]), "name": {"pionts": 1},
            "color": {"color": strands.roots}, "nan": strands.points * [np.nan, 1, 1]}[what]
"""


class Operators(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.module = self.folder / "my_operator.py"
        self.module.write_text(MODULE)

    def values(self, function="sway", **keys):
        operator = {"module": self.module, "function": function, "bound": 0.1, **keys}
        values = scene_values()
        values["grooms"]["coat"]["operators"].append({"python": operator})
        return values

    def scene(self, function="sway", allow_scripts=True, **keys):
        return pelage.Scene(self.values(function, **keys), allow_scripts=allow_scripts)

    def error_of(self, values, **keys):
        values["grooms"]["coat"]["operators"][-1]["python"].update(keys)
        with self.assertRaises(pelage.Error) as caught:
            pelage.Scene(values, allow_scripts=True).grow("coat")
        return caught.exception

    def error(self, *arguments, **keys):
        with self.assertRaises(pelage.Error) as caught:
            self.scene(*arguments, **keys).grow("coat")
        return caught.exception

    def test_a_function_moves_points(self):
        before, after = pelage.Scene(scene_values()).grow("coat"), self.scene().grow("coat")
        moved = np.linalg.norm(after.points - before.points, axis=1).reshape(-1, 5)
        self.assertTrue((moved[:, 0] == 0).all())
        self.assertTrue(0.03 < moved.max() < 0.05)  # 0.05 x 0.5 x the root of 3 at most
        still = self.scene(arguments={"amount": 0}).grow("coat")
        self.assertTrue(np.array_equal(still.points, before.points))
        masked = self.scene(mask=0.5).grow("coat").points
        self.assertLess(np.abs(masked - (before.points + after.points) / 2).max(), 1e-6)

    def test_a_function_sees_everything_and_sets_attributes(self):
        before, after = pelage.Scene(scene_values()).grow("coat"), self.scene("look", colors="strand").grow("coat")
        self.assertTrue(np.array_equal(after.radii, before.radii / 2))
        color = after.attributes["color"]
        self.assertEqual(color.shape, (300, 3))
        self.assertGreater(color[:, 0].std(), 0.1)
        self.assertTrue((color[:, 1:] == 0).all())

    def test_a_stranger_s_scene_runs_nothing(self):
        self.module.write_text(f"open({str(self.folder / 'ran')!r}, 'w')\n" + MODULE)
        error = self.error(allow_scripts=False)
        self.assertEqual(error.file, "grooms.coat.operators.3.python")
        self.assertIn("allow_scripts=True", str(error))
        self.assertFalse((self.folder / "ran").exists())
        with self.assertRaisesRegex(TypeError, "allow_scripts: expected True or False, got int"):
            self.scene(allow_scripts=1)

    def test_every_mistake_of_a_function_is_named(self):
        error = self.error("fail")
        self.assertEqual((error.file, error.line), (str(self.module), 25))
        self.assertIn("ZeroDivisionError: division by zero, in fail() for strand 7 of groom 'coat'", str(error))
        for what, message in [
            ("none", "returned NoneType; expected points, or a dict of points, widths and color"),
            ("shape", "returned points of the shape"), ("text", "returned points of <U1; expected numbers"),
            ("name", "returned 'pionts'; expected points, widths"), ("color", "returned color, but `colors`"),
            ("nan", "returns a number that is not finite for strand"),
        ]:
            self.assertIn(message, str(self.error("wrong", arguments={"what": what})))
        self.assertIn("depends on the", str(self.error("mean")))
        self.assertIn("is random", str(self.error("noise")))
        self.assertIn("farther than `bound: 0.01`", str(self.error(bound=0.01)))
        self.assertIn("has no function 'swya'; did you mean 'sway'?", str(self.error("swya")))
        self.assertIn("unexpected keyword argument 'amuont'", str(self.error(arguments={"amuont": 1})))
        self.module.write_text("def sway(strands)\n")
        error = self.error()
        self.assertEqual((error.file, error.line), (str(self.module), 1))
        self.assertIn("SyntaxError", str(error))
        self.module.unlink()
        self.assertIn("my_operator.py", str(self.error()))

    def test_pixels_depend_on_neither_threads_nor_leaves_nor_bounds(self):
        values = self.values()
        values["render"]["lod"] = {"enabled": True}
        one = pelage.Scene(values, threads=1, allow_scripts=True).render()
        values["grooms"]["coat"]["leaf_strands"] = 64
        values["render"]["bounds"] = "conservative"
        many = pelage.Scene(values, threads=4, allow_scripts=True).render()
        self.assertTrue(same_layers(one, many))
        self.assertFalse(same_layers(one, pelage.Scene(scene_values()).render()))

    def test_a_function_in_a_pose_sees_the_scale(self):
        self.module.write_text("def check(strands):\n    assert strands.scale == 2\n"
                               "    return strands.points + 0.2 * strands.along[:, None] * strands.frames[:, 2][:, None]\n")
        plain, posed = scene_values(), self.values("check", space="pose")
        for values in (plain, posed):
            values["characters"]["one"]["transform"] = {"scale": 2}
        before, after = (pelage.Scene(v, allow_scripts=True).grow("coat") for v in (plain, posed))
        moved = np.linalg.norm(after.points - before.points, axis=1).reshape(-1, 5)
        self.assertLess(np.abs(moved - 0.2 * np.linspace(0, 1, 5)).max(), 1e-5)
        self.assertIn("moves point 4 by 0.1, farther than `bound: 0.09`", str(self.error_of(posed, bound=0.09)))

    def test_callbacks_and_functions_share_the_lock(self):
        pictures = []

        def render():
            pictures.append(self.scene().render(on_pass=lambda p: p["RGBA"], progress=lambda *_: None))

        threads = [threading.Thread(target=render) for _ in range(2)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertTrue(same_layers(*pictures))

    def test_a_cache_is_found_by_the_source(self):
        cache = {"directory": self.folder / "cache", "freeze": "python"}
        values = self.values()
        values["grooms"]["coat"]["cache"] = cache
        grow = lambda: pelage.Scene(values, allow_scripts=True).grow("coat").points.copy()
        first, again = grow(), grow()
        self.module.write_text(MODULE.replace("amount=0.05", "amount=0.08"))
        self.assertTrue(np.array_equal(first, again))
        self.assertFalse(np.array_equal(first, grow()))
        with self.assertRaisesRegex(pelage.Error, "allow_scripts"):
            pelage.Scene(values).grow("coat")

    @unittest.skipUnless(PROGRAM.is_file(), "the program is not built")
    def test_the_program_gives_the_same_strands(self):
        (self.folder / "cube.obj").write_text(cube_obj())
        values = self.values()
        values["skins"]["cube"]["mesh"] = "cube.obj"
        values["grooms"]["coat"]["operators"][-1]["python"]["module"] = "my_operator.py"
        scene, strands = self.folder / "scene.yaml", self.folder / "a.hair"
        scene.write_text(json.dumps(values))
        command = [PROGRAM, "grow", scene, "-o", strands, "--quiet"]
        env = {**os.environ, "PELAGE_CACHE": "off"}
        refused = subprocess.run(command, capture_output=True, text=True, check=False, env=env)
        self.assertEqual(refused.returncode, 3)
        self.assertRegex(refused.stderr, r"scene.yaml:1:\d+: 'python' runs a script .*--allow-scripts")
        subprocess.run([*command, "--allow-scripts"], check=True, env=env, capture_output=True)
        # Threads that fail at the same time do not wait for each other.
        failed = subprocess.run([*command, "--allow-scripts", "--threads", "4", "--set", "grooms.coat.strands=4000", "--set",
                                 "grooms.coat.operators.python.function=stop"],
                                capture_output=True, text=True, check=False, env=env, timeout=60)
        self.assertEqual(failed.returncode, 3)
        self.assertRegex(failed.stderr, r"my_operator.py:\d+: SystemExit: 1, in stop\(\) for (strand|the clump centre) \d+ of groom 'coat'")
        here = pelage.open(scene, allow_scripts=True).grow("coat")
        self.assertTrue(np.array_equal(pelage.read_strands(strands).points, here.points))


if __name__ == "__main__":
    unittest.main()
