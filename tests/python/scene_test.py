# SPDX-License-Identifier: Apache-2.0
"""Scenes from Python: values, errors, renders, progress, cancelling."""
import json
import os
import pathlib
import pickle
import signal
import tempfile
import threading
import unittest
import warnings

import numpy as np
import pelage
from small import cube_obj, same_layers, scene_values


class Values(unittest.TestCase):
    def test_a_dict_gives_the_pixels_of_its_file(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "scene.yaml"
            (path.parent / "cube.obj").write_text(cube_obj())
            path.write_text(json.dumps(scene_values("cube.obj")))  # JSON is YAML
            of_file = pelage.open(path).render()
        self.assertTrue(same_layers(of_file, pelage.Scene(scene_values()).render()))
        self.assertGreater(of_file["RGBA"][..., :3].max(), 0)

    def test_numbers_of_numpy_are_numbers(self):
        scene = pelage.Scene(scene_values())
        scene.set({"image.width": np.int64(20), "camera.position": np.array([1.5, 1, 3]), "camera.fov": np.float32(40),
                   "render.lod.enabled": True})
        self.assertEqual(scene.size, (20, 16))

    def test_set_changes_all_or_nothing(self):
        scene = pelage.Scene(scene_values())
        with self.assertRaises(pelage.Error) as caught:
            scene.set({"image.width": 99, "grooms.coat.operators.clmup.amount": 1})
        self.assertEqual(caught.exception.nearest, "clump")
        self.assertEqual(caught.exception.file, "grooms.coat.operators.clmup.amount")
        self.assertEqual(caught.exception.kind, "input")
        self.assertEqual(str(pickle.loads(pickle.dumps(caught.exception))), str(caught.exception))
        self.assertEqual(scene.size, (24, 16))
        self.assertIn("expected a whole number", scene.validate("image.width", "wide")[0])
        self.assertEqual(scene.validate("image.width", 30), [])
        self.assertEqual(scene.size, (24, 16))

    def test_a_changed_scene_gives_the_pixels_of_a_new_one(self):
        scene = pelage.Scene(scene_values())
        before = scene.render()
        scene.set("grooms.coat.operators.length.value", 0.2)
        values = scene_values()
        values["grooms"]["coat"]["operators"][0]["length"]["value"] = 0.2
        after = scene.render()
        self.assertTrue(same_layers(after, pelage.Scene(values).render()))
        self.assertFalse(same_layers(after, before))

    def test_mistakes_of_a_file_have_lines(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "scene.yaml"
            path.write_text("pelage: 1\nimage: {widht: 8}\nrender: {samples: many}\n")
            with self.assertRaises(pelage.Error) as caught:
                pelage.open(path)
        first, second = caught.exception.problems[:2]
        self.assertEqual((first.file, first.line, first.column, first.nearest), (str(path), 2, 9, "width"))
        self.assertEqual(second.line, 3)

    def test_mistakes_of_a_dict_have_keys(self):
        values = scene_values()
        values["grooms"]["coat"]["operators"][1]["clump"]["spacing"] = -1
        with self.assertRaises(pelage.Error) as caught:
            pelage.Scene(values)
        self.assertEqual(caught.exception.file, "grooms.coat.operators.1.clump.spacing")

    def test_values_of_wrong_types_are_named(self):
        scene = pelage.Scene(scene_values())
        for value, kind, message in [
            (float("nan"), ValueError, "render.samples: expected a finite number, got nan"),
            (object(), TypeError, "render.samples: expected a number, text, list, dict, Map, Mesh, Poses or Strands, got object"),
            (b"8", TypeError, "render.samples: expected a number, text, list, dict, Map, Mesh, Poses or Strands, got bytes"),
            ({(1,): 2}, TypeError, "render.samples: expected names as keys, got tuple"),
        ]:
            with self.assertRaises(kind) as caught:
                scene.set("render.samples", value)
            self.assertEqual(str(caught.exception), message)
        with self.assertRaises(TypeError):
            pelage.Scene([])
        endless = {}
        endless["a"] = endless
        with self.assertRaises(ValueError):
            pelage.Scene(endless)
        with self.assertRaises(pelage.Error) as caught:
            mesh = pelage.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
            pelage.Scene(scene_values(strands_file=mesh)).grow("coat")
        self.assertIn("expected strands, got mesh:", str(caught.exception))

    def test_arguments_of_wrong_types_are_named(self):
        scene = pelage.Scene(scene_values())
        for call, kind, message in [
            (lambda: scene.grow(5), TypeError, "coat: expected text, got int"),
            (lambda: scene.grow("coat", frame=float("nan")), ValueError, "frame: expected a finite number, got nan"),
            (lambda: scene.render("first"), TypeError, "frame: expected a number, got str"),
            (lambda: scene.render(progress=5), TypeError, "progress: expected something to call, got int"),
            (lambda: scene.render(on_pass=5), TypeError, "on_pass: expected something to call, got int"),
            (lambda: scene.render(region=(0, 0, 8)), ValueError, "region: expected four integers x0, y0, x1, y1"),
            (lambda: scene.render(region=(0, 0, 8, 17)), ValueError,
             "region: expected a box inside 24 x 16 pixels, got (0, 0, 8, 17)"),
            (lambda: scene.grow("\ud800"), ValueError, "coat: expected text, got half of a surrogate pair"),
            (lambda: scene.set("image.width", "\ud800"), ValueError,
             "image.width: expected text, got half of a surrogate pair"),
            (lambda: scene.set([], 1), TypeError, "key: expected names as keys, got list"),
            (lambda: scene.set("camera.look_at", np.ma.masked_array([0, 1, 2], [0, 1, 0])), ValueError,
             "camera.look_at: some values are masked"),
            (lambda: scene.render(output="a\0.exr"), ValueError, "output: no file has a name with a null character"),
            (lambda: pelage.open(5), TypeError, "path: expected text or a path, got int"),
            (lambda: pelage.open("a.yaml", set=[]), TypeError, "set: expected a dict, got list"),
            (lambda: pelage.read_strands("a.hair", width=float("inf")), ValueError,
             "width: expected a finite number, got inf"),
            (lambda: pelage.measure(5, "a.yaml"), TypeError, "experiment: expected text, got int"),
            (lambda: pelage.Fibre("chiang", progress=5), TypeError, "progress: expected something to call, got int"),
            (lambda: pelage.Fibre("chiang").integrate([0, 1, 0], steps=0), ValueError,
             "steps: expected 1 to 4096, got 0"),
            (lambda: pelage.Scene({}, threads=1.5), TypeError, "threads: expected an integer, got float"),
        ]:
            with self.assertRaises(kind) as caught:
                call()
            self.assertEqual(str(caught.exception), message)
        with self.assertRaisesRegex(pelage.Error, "nothing.yaml"):
            pelage.open("nothing.yaml")
        with self.assertRaises(pelage.Error) as caught:
            scene.grow("caot")
        self.assertEqual((caught.exception.kind, caught.exception.nearest), ("arguments", "coat"))

    def test_the_schema_names_every_key(self):
        schema = pelage.schema()
        keys = {key["name"]: key for key in schema["image"]["keys"]}
        self.assertEqual((keys["width"]["type"], keys["width"]["min"]), ("integer", 1))
        for block in schema.values():
            for key in block["keys"]:
                self.assertLessEqual(set(key["blocks"]), schema.keys(), key["name"])


class Renders(unittest.TestCase):
    def slow_scene(self):
        return pelage.Scene({**scene_values(), "render": {"samples": 1000000}})

    def test_a_file_holds_the_same_picture(self):
        with tempfile.TemporaryDirectory() as folder:
            png = pathlib.Path(folder) / "a.png"
            picture = pelage.Scene(scene_values()).render(output=png)
            self.assertTrue(png.read_bytes().startswith(b"\x89PNG"))
        self.assertEqual(picture.display().shape, (16, 24, 3))
        self.assertEqual(picture["id"].dtype, np.uint32)
        self.assertEqual(picture["key.diffuse"].shape, (16, 24, 3))
        self.assertEqual(picture.stats["characters"], 1)
        with self.assertRaisesRegex(KeyError, "there is no layer 'key.difuse'; did you mean 'key.diffuse'"):
            picture["key.difuse"]
        with self.assertRaisesRegex(KeyError, "there is no layer 'nope'; expected one of RGBA, "):
            picture["nope"]
        self.assertFalse("nope" in picture or 5 in picture)

    def test_a_region_is_part_of_the_picture(self):
        scene = pelage.Scene({**scene_values(), "render": {"samples": 1, "integrator": "path"}})
        whole, part = scene.render(), scene.render(region=(4, 2, 20, 12))
        self.assertEqual(part.region, (4, 2, 20, 12))
        self.assertTrue(np.array_equal(part["RGBA"], whole["RGBA"][2:12, 4:20]))

    def test_passes_show_layers_while_they_form(self):
        seen = []
        scene = pelage.Scene(scene_values())
        picture = scene.render(on_pass=lambda p: seen.append((p, p["RGBA"].copy(), sorted(p.layers("Z", "N")))))
        self.assertTrue(np.array_equal(seen[-1][1], picture["RGBA"]))
        self.assertEqual(seen[-1][2], ["N", "Z"])
        with self.assertRaisesRegex(RuntimeError, "while its callback runs"):
            seen[-1][0].layers()
        self.assertTrue(same_layers(picture, scene.render()))
        with self.assertRaisesRegex(KeyError, "there is no layer 'key.difuse'; did you mean 'key.diffuse'"):
            scene.render(on_pass=lambda p: p.layers("key.difuse"))

    def test_a_callback_cannot_wait_for_the_call_that_waits_for_it(self):
        scene = self.slow_scene()
        with self.assertRaisesRegex(RuntimeError, "a callback cannot grow or render the scene that calls it"):
            scene.render(on_pass=lambda _: scene.render())
        with self.assertRaisesRegex(RuntimeError, "a callback cannot grow or render the scene that calls it"):
            scene.render(progress=lambda *_: scene.grow("coat"))

    def test_other_files_than_pictures_are_refused(self):
        with self.assertRaisesRegex(pelage.Error, r"a.gif' must end in \.exr, \.png or \.jpg"):
            pelage.Scene(scene_values()).render(output="a.gif")

    def test_exceptions_of_callbacks_come_through(self):
        def fail(*_):
            raise LookupError("enough")

        with self.assertRaisesRegex(LookupError, "enough"):
            self.slow_scene().render(on_pass=fail)
        with self.assertRaisesRegex(LookupError, "enough"):
            self.slow_scene().render(progress=fail)

    def test_another_thread_cancels(self):
        scene = self.slow_scene()
        timer = threading.Timer(0.1, scene.cancel)
        timer.start()
        try:
            self.assertTrue(scene.render().partial)
        except pelage.Cancelled as error:
            self.assertEqual(error.kind, "stopped")
        scene.set("render.samples", 1)
        self.assertFalse(scene.render().partial)

    def test_ctrl_c_stops(self):
        timer = threading.Timer(0.1, os.kill, (os.getpid(), signal.SIGINT))
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            self.slow_scene().render()

    def test_the_lock_is_released(self):
        scene = self.slow_scene()
        passed = threading.Event()
        pictures = []
        worker = threading.Thread(
            target=lambda: pictures.append(scene.render(on_pass=lambda p: p.samples > 0 and passed.set())))
        worker.start()
        self.assertTrue(passed.wait(60))  # this thread waits in Python while that one renders
        counted = sum(worker.is_alive() for _ in range(1000))
        scene.cancel()
        worker.join()
        self.assertEqual(counted, 1000)
        self.assertTrue(pictures[0].partial)

    def test_two_threads_render_two_scenes(self):
        first, second = scene_values(), {**scene_values(), "image": {"width": 30, "height": 12}}
        alone = [pelage.Scene(values).render() for values in (first, second)]
        together = [None, None]

        def render(i, values):
            together[i] = pelage.Scene(values).render()

        threads = [threading.Thread(target=render, args=pair) for pair in enumerate((first, second))]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for a, b in zip(alone, together):
            self.assertTrue(same_layers(a, b))

    def test_warnings_are_warnings(self):
        values = scene_values()
        values["render"]["gather"] = {"visibility": "raster"}
        values["render"]["integrator"] = "path"
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            pelage.Scene(values)
        self.assertEqual([w.category for w in caught], [pelage.PelageWarning])


if __name__ == "__main__":
    unittest.main()
