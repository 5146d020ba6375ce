# SPDX-License-Identifier: Apache-2.0
"""The parts of the add-on that know nothing of Blender."""
import importlib
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import types
import unittest
from unittest import mock

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
ADDON = ROOT / "integrations" / "blender" / "pelage_blender"
# The package itself imports bpy, so its modules are loaded into an empty one.
package = types.ModuleType("addon")
package.__path__ = [str(ADDON)]
sys.modules["addon"] = package
axes, cage, exr, geometry_files, hair_color, names, process, scene_folder, scene_json, schema, temporary_folders = (
    importlib.import_module(f"addon.{name}") for name in (
        "axes", "cage", "exr", "geometry_files", "hair_color", "names", "process", "scene_folder", "scene_json", "schema",
        "temporary_folders"))
PROGRAM = os.environ.get("PELAGE_PROGRAM", "pelage")


class Axes(unittest.TestCase):
    def test_up_is_up_and_the_turn_is_a_rotation(self):
        np.testing.assert_array_equal(axes.to_pelage([0, 0, 1]), [0, 1, 0])
        np.testing.assert_array_equal(axes.to_pelage([[1, 2, 3]]), [[1, 3, -2]])
        self.assertAlmostEqual(np.linalg.det(axes.to_pelage(np.eye(3))), 1)

    def test_softness_fades_between_the_same_cosines(self):
        for cone in (0.3, 1.0, 2.5):
            for blend in (0, 0.15, 0.5, 1):
                inner = math.cos(0.5 * cone * (1 - axes.spot_softness(cone, blend)))
                outer = math.cos(0.5 * cone)
                self.assertAlmostEqual(inner, outer + (1 - outer) * blend, places=6)

    def test_the_image_of_a_spot_is_a_cosine(self):
        image = axes.spot_image(90, 65)
        self.assertAlmostEqual(image[32, 32], 1)
        middle_of_border = 1 / math.sqrt(1 + (64 / 65) ** 2)
        self.assertAlmostEqual(image[32, 0], middle_of_border, places=6)

    def test_index_of_refraction(self):
        self.assertAlmostEqual(axes.index_of_refraction(0.5), 1.5, places=6)
        self.assertEqual(axes.index_of_refraction(100), 3)


class HairColor(unittest.TestCase):
    def test_color_and_back(self):
        fit = 5.969 - 0.215 * 0.3 + 2.532 * 0.09 - 10.73 * 0.027 + 5.574 * 0.0081 + 0.245 * 0.00243
        for color in (0.02, 0.5, 0.9):
            sigma = hair_color.from_color([color] * 3, 0.3)[0]
            self.assertAlmostEqual(math.exp(-fit * math.sqrt(sigma)), color, places=6)

    def test_melanin(self):
        np.testing.assert_allclose(hair_color.from_melanin(0, 0, (1, 1, 1), 0.3), 0, atol=1e-9)
        brown = hair_color.from_melanin(1 - math.exp(-1), 0, (1, 1, 1), 0.3)
        np.testing.assert_allclose(brown, (0.506, 0.841, 1.653), rtol=1e-6)
        self.assertLess(hair_color.from_melanin(0.5, 1, (1, 1, 1), 0.3)[0], hair_color.from_melanin(0.5, 0, (1, 1, 1), 0.3)[0])


class Exr(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.path = pathlib.Path(self.folder.name)

    def test_what_is_encoded_is_read(self):
        rng = np.random.default_rng(1)
        channels = {"a layer with a long name, longer than 31.ä": rng.normal(size=(5, 7)).astype(np.float32),
                    "R": rng.normal(size=(5, 7)).astype(np.float32)}
        (self.path / "a.exr").write_bytes(exr.encode(channels))
        header, found = exr.read(self.path / "a.exr")
        self.assertEqual((header.width, header.height), (7, 5))
        for name, values in channels.items():
            np.testing.assert_array_equal(found[name], values)

    def test_a_picture_of_pelage_is_read(self):
        scene = self.path / "a.yaml"
        scene.write_text("pelage: 1\nimage: {width: 21, height: 35}\nrender: {samples: 1}\ncharacters: {}\n"
                         "lights: {sky: {type: environment, radiance: [0.25, 0.5, 4]}}\n")
        subprocess.run([PROGRAM, "render", scene, "-o", self.path / "a.exr", "--quiet"], check=True)
        header, found = exr.read(self.path / "a.exr")
        self.assertEqual((header.width, header.height, header.compression), (21, 35, 3))
        for name, value in (("R", 0.25), ("G", 0.5), ("B", 4), ("sky.emission.B", 4)):
            np.testing.assert_array_equal(found[name], np.full((35, 21), value, np.float32))

    def test_damage_is_an_error(self):
        data = exr.encode({"R": np.zeros((4, 4), np.float32)})
        path = self.path / "a.exr"
        for cut in range(0, len(data), 7):
            path.write_bytes(data[:cut])
            with self.assertRaises(exr.ExrError):
                exr.read(path)


    def test_a_damaged_header_is_an_error(self):
        """No byte makes the reader crash, or run or allocate without end."""
        data = exr.encode({"R": np.zeros((4, 4), np.float32)})
        path = self.path / "a.exr"
        for place in range(exr.read_header(data).end):
            for value in (0x00, 0x7F, 0xFF):
                path.write_bytes(data[:place] + bytes([value]) + data[place + 1:])
                try:
                    exr.read(path)
                except exr.ExrError:
                    pass
        size = data.index(b"chlist\0") + len("chlist\0")
        for value in (-20, 2**31 - 1):
            with self.assertRaisesRegex(exr.ExrError, "'channels'"):
                exr.read_header(data[:size] + value.to_bytes(4, "little", signed=True) + data[size + 4:])


class Profiles(unittest.TestCase):
    """IES textures, with plain objects for those of Blender."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = pathlib.Path(folder.name)
        bpy = types.SimpleNamespace(path=types.SimpleNamespace(abspath=lambda name: name.replace("//", f"{folder.name}/")))
        with mock.patch.dict(sys.modules, {"bpy": bpy, "mathutils": types.ModuleType("mathutils")}):
            self.lights = importlib.import_module("addon.lights")
        self.notes = set()

    def block(self, node, strength=0.5):
        """The block of a point of 4 W at the origin that shines to the right."""
        strength = types.SimpleNamespace(is_linked=False, default_value=strength)
        node.type, node.mute, node.inputs = "TEX_IES", False, {"Vector": types.SimpleNamespace(is_linked=False), "Strength": strength}
        fac = types.SimpleNamespace(is_linked=True, links=[types.SimpleNamespace(from_node=node)])
        color = types.SimpleNamespace(is_linked=False, default_value=[1.0, 1.0, 1.0, 1.0])
        emission = types.SimpleNamespace(type="EMISSION", inputs={"Color": color, "Strength": fac})
        data = types.SimpleNamespace(type="POINT", energy=4.0, color=[1.0, 0.5, 0.25], shadow_soft_size=0.1, use_nodes=True)
        axes_of_light = {"position": [0, 0, 0], "look_at": [1, 0, 0], "up": [0, 1, 0]}
        with mock.patch.object(self.lights, "surface_node", return_value=emission), \
             mock.patch.object(self.lights, "_axes", return_value=axes_of_light):
            return self.lights.light_block(types.SimpleNamespace(data=data), None, self.notes)

    def test_text_within_the_scene(self):
        text = types.SimpleNamespace(as_string=lambda: "TILT=NONE")
        block = self.block(types.SimpleNamespace(mode="INTERNAL", ies=text, filepath=""))
        self.assertEqual((block["profile_text"], block["intensity"], block["look_at"]), ("TILT=NONE", 2, [1, 0, 0]))
        self.assertNotIn("power", block)
        self.assertEqual(self.notes, set())

    def test_a_file_beside_the_scene(self):
        (self.path / "lamp.ies").touch()
        block = self.block(types.SimpleNamespace(mode="EXTERNAL", ies=None, filepath="//lamp.ies"))
        self.assertEqual((block["profile"], block["intensity"]), (str(self.path / "lamp.ies"), 2))
        self.assertEqual(self.notes, set())

    def test_a_light_without_its_file_is_even_and_as_bright_as_in_cycles(self):
        for mode, name in (("INTERNAL", ""), ("EXTERNAL", ""), ("EXTERNAL", "//lamp.ies"), ("EXTERNAL", "//")):
            block = self.block(types.SimpleNamespace(mode=mode, ies=None, filepath=name))
            self.assertEqual(block["power"], 200, (mode, name))
            for key in ("profile", "profile_text", "intensity", "look_at"):
                self.assertNotIn(key, block)
            self.assertEqual(self.notes, {"IES textures without a file: 100 times as bright, as in Cycles"})


class Schema(unittest.TestCase):
    def test_another_program_is_an_error_and_is_not_asked_each_time(self):
        with tempfile.TemporaryDirectory() as name:
            program = pathlib.Path(name) / "program"
            program.write_text(f"#!/bin/sh\necho >> {name}/asked\n")
            program.chmod(0o755)
            for _ in range(3):
                with self.assertRaisesRegex(process.PelageFailed, "not a program pelage"):
                    schema.load(str(program))
            self.assertEqual((pathlib.Path(name) / "asked").read_text(), "\n")
            with mock.patch.object(schema, "FAILURE_S", 0), self.assertRaises(process.PelageFailed):
                schema.load(str(program))
            self.assertEqual((pathlib.Path(name) / "asked").read_text(), "\n\n")
            program.write_text(f"#!/bin/sh\nexec '{os.path.abspath(PROGRAM)}' \"$@\"\n")
            self.assertIn("comb", schema.load(str(program)))


class Files(unittest.TestCase):
    def test_a_line_leads_to_its_keys(self):
        text = scene_json.document_text({"a": 1, "grooms": {"coat \"ä\": {": {"operators": [{"length": {"value": 2}},
                                                                               {"clump": {"amount": [3, 4.5]}}]}}, "z": []})
        paths = {text.splitlines()[i].strip(): scene_json.path_of_line(text, i + 1) for i in range(len(text.splitlines()))}
        self.assertEqual(paths['"value": 2'], 'grooms.coat "ä": {.operators.0.length.value')
        self.assertEqual(paths["4.5"], 'grooms.coat "ä": {.operators.1.clump.amount.1')
        self.assertEqual(paths['"z": []'], "z")

    def test_names_are_different_and_without_dots(self):
        taken = set()
        self.assertEqual([names.pelage_name(n, taken) for n in ("a.1", "a_1", "a.1", " ")], ["a_1", "a_1 2", "a_1 3", "unnamed"])

    def test_names_of_lights_leave_room_for_those_of_lobes(self):
        taken = set()
        found = [names.light_name("ä" * 60, taken) for _ in range(12)]
        self.assertEqual(len(set(found)), 12)
        self.assertLessEqual(max(len(f"ViewLayer.{name}.secondary.R".encode()) for name in found), 64)
        self.assertEqual(found[11], "ä" * 18 + " 12")

    def test_meshes_and_strands_are_those_of_pelage(self):
        with tempfile.TemporaryDirectory() as name:
            folder = scene_folder.SceneFolder(pathlib.Path(name))
            points = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0, 0.5]])
            text = geometry_files.obj_text(points, np.array([4, 3]), np.array([0, 1, 2, 3, 1, 4, 2]), np.zeros((7, 2)),
                                  [("slot0", np.array([0])), ("slot1", np.array([1]))], np.full((5, 3), 0.5))
            folder.put("a.obj", text)
            strands = geometry_files.hair_bytes(np.arange(15).reshape(5, 3), np.full(5, 0.1), np.array([2, 3]))
            folder.put("a.hair", strands)
            info = [subprocess.run([PROGRAM, "info", f"{name}/{file}"], capture_output=True, text=True, check=True).stdout
                    for file in ("a.obj", "a.hair")]
        self.assertIn("5 vertices", info[0])
        self.assertIn("2 faces", info[0])
        self.assertIn("2 strands", info[1])
        self.assertIn("5 points", info[1])

    def test_folders_of_processes_that_are_gone_are_removed(self):
        with tempfile.TemporaryDirectory() as name, mock.patch.object(tempfile, "tempdir", name):
            mine = temporary_folders.new_folder()
            gone = subprocess.Popen(["true"])
            gone.wait()
            (pathlib.Path(name) / f"{temporary_folders.owner_prefix()}{gone.pid}-abc").mkdir()
            prefix = temporary_folders.PREFIX
            others = [f"{prefix}other", f"{prefix}000000000000-{gone.pid}-abc"]  # the second is of another machine
            for other in others:
                (pathlib.Path(name) / other).mkdir()
            temporary_folders.remove_stale_folders()
            self.assertEqual(sorted(os.listdir(name)), sorted([os.path.basename(mine), *others]))

    def test_only_changes_are_written(self):
        with tempfile.TemporaryDirectory() as name:
            folder = scene_folder.SceneFolder(pathlib.Path(name))
            folder.put("a", "text")
            first = os.stat(f"{name}/a").st_ino
            folder.put("a", "text")
            self.assertEqual(os.stat(f"{name}/a").st_ino, first)
            folder.put("a", "other")
            self.assertEqual(pathlib.Path(name, "a").read_text(), "other")

    def test_texts_are_made_only_when_their_arrays_change(self):
        with tempfile.TemporaryDirectory() as name:
            folder, path = scene_folder.SceneFolder(pathlib.Path(name)), pathlib.Path(name, "a")
            folder.put_made("a", [np.zeros((2, 3)), None], lambda: "first")
            folder.put_made("a", [np.zeros((2, 3)), None], lambda: self.fail("made again"))
            for other in ([np.zeros((3, 2)), None], [np.ones((2, 3)), None], [np.zeros((2, 3)), "slot"]):
                folder.put_made("a", other, lambda: str(other))
                self.assertEqual(path.read_text(), str(other))
            folder.put("a", "text")
            folder.put_made("a", other, lambda: "last")
            self.assertEqual(path.read_text(), "last")


class Process(unittest.TestCase):
    def test_a_mistake_is_named_by_its_keys(self):
        with tempfile.TemporaryDirectory() as name:
            scene = pathlib.Path(name) / "scene.yaml"
            scene.write_text(scene_json.document_text({"pelage": 1, "lights": {"key": {"type": "point", "powr": 1}}}))
            with self.assertRaises(process.PelageFailed) as caught:
                process.run_render([PROGRAM, "render", str(scene), "-o", f"{name}/a.exr", "--progress", "json"], scene,
                                   lambda: False, lambda stage, fraction: None)
        self.assertIn("lights.key.powr: unknown key 'powr' in point; did you mean 'power'?", str(caught.exception))

    def test_the_wanted_program_is_the_one_that_runs(self):
        with mock.patch.dict(os.environ, {"PELAGE_PROGRAM": sys.executable}):
            self.assertEqual(process.find_program(), os.path.abspath(sys.executable))
            with self.assertRaisesRegex(process.PelageFailed, "preferences"):
                process.find_program("/nowhere/pelage")
            self.assertEqual(process.find_program(os.path.relpath("/bin/sh")), "/bin/sh")

    def test_odd_lines_of_progress_do_no_harm(self):
        lines = '{"stage": "grow", "done": null}\n{"stage": "render"}\n[1]\nlast\n'
        output = process.Output(mock.Mock(stderr=lines.splitlines(keepends=True)))
        output.join()
        self.assertEqual((output.stage, output.fraction, output.mistakes), ("render", 0, ["[1]", "last"]))

    def test_cancelling_ends_the_process(self):
        with tempfile.TemporaryDirectory() as name, self.assertRaises(process.Cancelled):
            process.run_render(["sleep", "1000"], pathlib.Path(name) / "a", lambda: True, lambda stage, fraction: None)


if __name__ == "__main__":
    unittest.main(verbosity=2)
