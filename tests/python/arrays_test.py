# SPDX-License-Identifier: Apache-2.0
"""Strands and meshes as arrays."""
import gc
import pathlib
import tempfile
import unittest

import numpy as np
import pelage
from small import CUBE, FACES, png_of, same_layers, scene_values


def resident_kb():
    """Anonymous memory of this process that is resident."""
    lines = pathlib.Path("/proc/self/status").read_text(encoding="ascii").splitlines()
    return next(int(line.split()[1]) for line in lines if line.startswith("RssAnon"))


class Grown(unittest.TestCase):
    def test_arrays_describe_each_strand(self):
        hair = pelage.Scene(scene_values()).grow("coat")
        self.assertEqual((len(hair), hair.points.shape, hair.points.dtype), (300, (1500, 3), np.float32))
        self.assertTrue(np.array_equal(hair.ids, np.arange(300)))
        self.assertTrue(np.array_equal(hair.offsets, np.arange(301) * 5))
        self.assertEqual((hair.root_faces.shape, hair.root_face_uv.shape), ((300,), (300, 2)))
        self.assertLess(hair.root_faces.max(), 12)  # `scheme: none` cuts each face into triangles
        self.assertTrue(np.array_equal(hair.widths, 2 * hair.radii))
        self.assertAlmostEqual(float(hair.widths[0]), 0.02, places=6)
        self.assertTrue((hair.lengths() <= 0.41).all())
        roots = np.abs(hair.points[hair.offsets[:-1]]).max(axis=1)
        self.assertLess(np.abs(roots - 0.5).max(), 1e-5)  # on the faces of the cube

    def test_arrays_outlive_their_scene_and_are_read_only(self):
        points = pelage.Scene(scene_values()).grow("coat").points
        gc.collect()
        copy = points.copy()
        again = pelage.Scene(scene_values()).grow("coat").points
        self.assertTrue(np.array_equal(points, copy) and np.array_equal(points, again))
        hair = pelage.Scene(scene_values()).grow("coat")
        for array in (hair.points, hair.motion, hair.radii, hair.widths, hair.offsets, hair.ids, hair.root_face_uv):
            with self.assertRaises(ValueError):
                array[0] = 0
        self.assertTrue(np.shares_memory(hair.points, hair.points))

    def test_motion_has_a_key_for_each_time(self):
        values = scene_values()
        values["camera"]["shutter"] = [0, 0.5]
        values["characters"]["one"]["transform"] = {"translate": {"keys": {1: [0, 0, 0], 2: [2, 0, 0]}}}
        hair = pelage.Scene(values).grow("coat", frame=1)
        self.assertGreater(hair.motion.shape[0], 1)
        moved = hair.motion[-1] - hair.motion[0]
        self.assertLess(np.abs(moved - [1, 0, 0]).max(), 1e-4)

    def test_poses_move_the_coat(self):
        values = scene_values()
        values["camera"]["shutter"] = [0, 0]
        values["skins"]["cube"]["poses"] = {"files": pelage.Poses([CUBE, CUBE + [0, 2, 0]]), "count": 2}
        scene = pelage.Scene(values)
        still, halfway = scene.grow("coat", frame=1), scene.grow("coat", frame=1.5)
        self.assertLess(np.abs(halfway.points - still.points - [0, 1, 0]).max(), 1e-5)
        scene.set("skins.cube.poses.count", 3)
        with self.assertRaises(pelage.Error) as caught:
            scene.grow("coat")
        self.assertEqual(str(caught.exception),
                         "skins.cube.poses.files: expected 3 poses of 8 vertices, got 2 of 8")
        with self.assertRaisesRegex(ValueError, "points: expected the shape"):
            pelage.Poses(CUBE)

    def test_a_thousand_grows_take_no_memory(self):
        scene = pelage.Scene(scene_values(), threads=1)
        for _ in range(200):
            scene.grow("coat")
        before = resident_kb()
        for _ in range(1000):
            scene.grow("coat")
        self.assertLess(resident_kb(), 1.05 * before)


class FromArrays(unittest.TestCase):
    def test_strands_of_numpy_give_the_pixels_of_their_file(self):
        hair = pelage.Scene(scene_values()).grow("coat")
        made = pelage.Strands(hair.points, widths=hair.widths, offsets=hair.offsets)
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "coat.hair"
            made.write(path)
            self.assertTrue(np.array_equal(pelage.read_strands(path).points, made.points))
            of_file = pelage.Scene(scene_values(strands_file=path)).render()
        of_numpy = pelage.Scene(scene_values(strands_file=made)).render()
        self.assertTrue(same_layers(of_file, of_numpy))
        bald = pelage.Scene({**scene_values(), "grooms": {}, "characters": {
            "one": {"parts": [{"skin": "cube", "material": "hide"}]}}}).render()
        self.assertFalse(same_layers(of_file, bald))

    def test_maps_of_numpy_give_the_pixels_of_their_file(self):
        pixels = np.random.default_rng(2).integers(0, 256, (8, 8, 3), np.uint8)
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "map.png"
            path.write_bytes(png_of(pixels))

            def values(image):
                values = scene_values(density={"map": image, "channel": "g", "projection": "planar"})
                values["materials"]["fur"]["color"] = {"map": image, "projection": "planar", "size": [1, 1, 1]}
                values["lights"]["panel"] = {"type": "rectangle", "position": [0, 2, 0], "look_at": [0, 0, 0],
                                             "size": [1, 1], "file": image if isinstance(image, pathlib.Path) else
                                             pelage.Map(pixels), "radiance": [3, 3, 3]}
                return values

            of_file = pelage.Scene(values(path)).render()
        self.assertTrue(same_layers(of_file, pelage.Scene(values(pixels)).render()))
        self.assertTrue(same_layers(of_file, pelage.Scene(values(pelage.Map(pixels))).render()))
        scene = pelage.Scene(values(pixels))
        before = scene.grow("coat").points
        scene.set("grooms.coat.density.map", pixels[::-1] / 255)
        self.assertFalse(np.array_equal(before, scene.grow("coat").points))

    def test_bad_maps_are_named(self):
        for pixels, kind, message in [
            ([1, 2], ValueError, "pixels: expected the shape"), (np.zeros((2, 2, 5)), ValueError, "1 to 4 channels"),
            (np.zeros((0, 2)), ValueError, "1 to 4 channels"), ([[np.nan]], ValueError, "pixels: not finite"),
            (np.zeros((2, 2)) + 1e300, ValueError, r"pixels: 1e\+300 at \(0, 0\) is too large"),
            ([["a"]], TypeError, "pixels: expected numbers"),
        ]:
            with self.assertRaisesRegex(kind, message):
                pelage.Map(pixels)
        scene = pelage.Scene(scene_values(mesh=pelage.Map([[1.0]])))
        with self.assertRaisesRegex(pelage.Error, "skins.cube.mesh: expected a mesh, got image:"):
            scene.grow("coat")
        with self.assertRaisesRegex(pelage.Error, "grooms.coat.density.map: expected an image, got mesh:"):
            pelage.Scene(scene_values(density={"map": pelage.Mesh(CUBE, FACES), "projection": "planar"})).grow("coat")

    def test_attributes_and_ids_are_kept(self):
        points = np.zeros((2, 3, 3), np.float64)
        points[:, :, 1] = [0, 1, 2]
        hair = pelage.Strands(points, widths=[[0.1], [0.2]], ids=[5, 9], basis="linear",
                              attributes={"color": np.full((2, 3, 3), 0.5), "age": [1, 2]})
        self.assertEqual(hair.widths.tolist(), np.float32([0.1] * 3 + [0.2] * 3).tolist())
        self.assertEqual((hair.ids.tolist(), hair.basis), ([5, 9], "linear"))
        self.assertEqual((hair.attributes["color"].shape, hair.attributes["age"].tolist()), ((6, 3), [[1], [2]]))

    def test_bad_arrays_are_named(self):
        line = [[[0, 0, 0], [0, 1, 0]]]
        for arguments, kind, message in [
            ({"points": [[0, 0]]}, ValueError, r"points: expected the shape \(n, n, 3\), got \(1, 2\)"),
            ({"points": [[["a", "b", "c"]]]}, TypeError, "points: expected numbers, got <U1"),
            ({"points": [[[0, 0, 0], [0, float("nan"), 0]]]}, ValueError, r"points: not finite at \(0, 1, 1\)"),
            ({"widths": [1, 2, 3]}, ValueError, "widths: expected one number"),
            ({"widths": -1}, ValueError, "widths: must not be negative"),
            ({"ids": [0.5]}, TypeError, "ids: expected integers, got float64"),
            ({"ids": [-1]}, ValueError, "ids: values must be between 0"),
            ({"points": line[0], "offsets": [0, 3]}, ValueError, "offsets: expected ascending numbers from 0 to 2"),
            ({"attributes": {"age": [1, 2, 3]}}, ValueError, "age: expected 1, 1 or 2 rows"),
            ({"basis": "bezzier"}, ValueError, "basis: expected"),
            ({"basis": 5}, TypeError, "basis: expected text, got int"),
            ({"attributes": [1]}, TypeError, "attributes: expected a dict, got list"),
            ({"attributes": {5: [1]}}, TypeError, "attributes: expected text, got int"),
            ({"ids": [1, [2]]}, ValueError, "ids: setting an array element"),
            ({"widths": np.ma.masked}, ValueError, "widths: some values are masked"),
        ]:
            with self.assertRaisesRegex(kind, message):
                pelage.Strands(**{"points": line, "widths": 0.1, **arguments})

    def test_bad_meshes_are_errors(self):
        mesh = pelage.Mesh(CUBE, FACES)
        self.assertTrue(np.array_equal(mesh.points, CUBE) and np.array_equal(mesh.face_vertices, FACES.ravel()))
        for arguments, kind, message in [
            ({"faces": [[0, 1, 8]]}, pelage.Error, "face 0: there is no vertex 8; the mesh has 8"),
            ({"faces": [[0, 1, 1]]}, pelage.Error, "face 0 needs 3 different vertices"),
            ({"faces": [0, 1, 2], "face_sizes": [4]}, pelage.Error, "the faces need 4 corners, got 3"),
            ({"faces": [[0.0, 1.0, 2.0]]}, TypeError, "faces: expected integers"),
            ({"uv": [[0, 0, 0]]}, ValueError, "uv: expected the shape"),
        ]:
            with self.assertRaisesRegex(kind, message):
                pelage.Mesh(**{"points": CUBE, "faces": FACES, **arguments})


if __name__ == "__main__":
    unittest.main()
