# SPDX-License-Identifier: Apache-2.0
"""Coats of Pelage in a .blend: the panel's values, maps, guides, saving, YAML."""
import json
import os
import pathlib
import subprocess
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import bpy
import numpy as np
from mathutils import Euler, Vector
from inside import OUTPUT, camera, empty_scene, exr, hairy, left_folders, new_path, render, run, set_world
from pelage_blender import axes, coat_presets, fur_operators, meshes, preferences, schema, scene_writer
from pelage_blender.scene_folder import SceneFolder

LAYERS = ["R", "G", "B"]


def furry(preset="SHORT", strands=3000, size=32):
    """A ball with a coat, in white light before nothing."""
    scene = empty_scene(size, size)
    scene.render.film_transparent = True
    scene.pelage.samples, scene.pelage.bounces = 2, 1
    set_world(1)
    camera((0, -6, 0))
    bpy.ops.mesh.primitive_uv_sphere_add(segments=16, ring_count=8)
    bpy.ops.object.shade_smooth()
    ob = bpy.context.object
    assert bpy.ops.object.pelage_fur_add(preset=preset) == {"FINISHED"}
    ob.pelage.coats[0].strands = strands
    return ob


def document():
    """The scene that goes to Pelage."""
    folder = OUTPUT / f"document{len(os.listdir(OUTPUT))}"
    folder.mkdir()
    writer = scene_writer.SceneWriter(SceneFolder(folder))
    return writer.write(bpy.context.evaluated_depsgraph_get(), (32, 32))


def covered(picture):
    return picture["A"] > 0.5


class Schema(unittest.TestCase):
    def test_the_manual_says_what_the_package_for_python_says(self):
        program = ["/usr/bin/python3", "-c", "import json, pelage; print(json.dumps(pelage.schema()))"]
        result = subprocess.run(program, capture_output=True, text=True)
        if result.returncode != 0:
            self.skipTest("the package for Python is not built")
        blocks, operators = json.loads(result.stdout), schema.load(preferences.program())
        listed = [key for key in blocks["groom"]["keys"] if key["name"] == "operators"][0]["blocks"]
        self.assertEqual(set(operators), set(listed) - schema.UNWANTED)
        for name, block in operators.items():
            self.assertEqual(block.help, blocks[name]["help"])
            truth = {key["name"]: key for key in blocks[name]["keys"]}
            for key in block.keys:
                if key.name not in truth:
                    self.assertIn(key.name, ("mask", "amount"))
                    continue
                other = truth[key.name]
                if key.kind in ("number", "integer", "field"):
                    self.assertEqual(str(key.default if key.default is not None else "none")[:1],
                                     other["default"][:1] if key.default is not None else "n", (name, key.name))
                    for mine, theirs in ((key.low, other["min"]), (key.high, other["max"])):
                        if theirs is not None and abs(theirs) < 1e30:
                            self.assertAlmostEqual(mine, theirs, delta=2e-6)
                        else:
                            self.assertGreaterEqual(abs(mine), 1e30)

    def test_every_operator_can_be_added(self):
        """With its defaults, each is understood by the program."""
        ob = furry(strands=50)
        coat = ob.pelage.coats[0]
        coat.operators.clear()
        for name in schema.load(preferences.program()):
            if name != "swirl":  # it needs a place of its own
                self.assertEqual(bpy.ops.object.pelage_operator_add(kind=name), {"FINISHED"})
        render(samples=1)


class Presets(unittest.TestCase):
    def tearDown(self):
        self.assertEqual(left_folders(), [])

    def test_every_preset_covers_the_skin(self):
        for name in coat_presets.LOOKS:
            ob = furry(name, 400)
            picture = render(samples=1)
            # The ball alone covers pi r^2 of the picture: a disc of 11 pixels in diameter, with hair at least that.
            self.assertGreater(covered(picture).sum(), 95, name)
            self.assertEqual(ob.pelage.coats[0].name.upper(), name)

    def test_a_mesh_without_faces_is_refused(self):
        furry()
        bpy.context.object.data.clear_geometry()
        with self.assertRaises(RuntimeError) as caught:
            bpy.ops.object.pelage_fur_add(preset="SHORT")
        self.assertIn("faces", str(caught.exception))


class Coats(unittest.TestCase):
    def tearDown(self):
        self.assertEqual(left_folders(), [])

    def test_values_go_to_the_scene(self):
        ob = furry()
        coat = ob.pelage.coats[0]
        comb = next(o for o in coat.operators if o.kind == "comb")
        comb["lift"], comb["direction"] = 0.75, [1, 2, 3]
        next(o for o in coat.operators if o.kind == "frizz").enabled = False
        groom = next(iter(document()["grooms"].values()))
        values = [o["comb"] for o in groom["operators"] if "comb" in o][0]
        self.assertEqual((values["lift"], values["direction"]), (0.75, [1, 3, -2]))
        self.assertFalse(any("frizz" in o for o in groom["operators"]))
        self.assertEqual(groom["strands"], 3000)

    def test_operators_are_moved_removed_and_given_maps(self):
        ob = furry()
        coat = ob.pelage.coats[0]
        kinds = [o.kind for o in coat.operators]
        bpy.ops.object.pelage_operator_edit(index=0, action="DOWN")
        self.assertEqual([o.kind for o in coat.operators][:2], kinds[1::-1])
        bpy.ops.object.pelage_operator_edit(index=1, action="REMOVE")
        self.assertEqual(len(coat.operators), len(kinds) - 1)
        bpy.ops.object.pelage_value_set(index=0, key="lift", action="MAP")
        self.assertEqual(coat.operators[0].maps[0].key, "lift")
        bpy.ops.object.pelage_value_set(index=0, key="lift", action="MAP")
        self.assertEqual(len(coat.operators[0].maps), 0)
        bpy.ops.object.pelage_fur_remove()
        self.assertEqual(len(ob.pelage.coats), 0)

    def test_a_vertex_group_is_a_map(self):
        ob = furry("LONG")
        bald = covered(render()).copy()
        group = ob.vertex_groups.new(name="oben 'ö'")
        group.add([v.index for v in ob.data.vertices if v.co.z > 0.3], 1.0, "REPLACE")
        coat = ob.pelage.coats[0]
        length = next(i for i, o in enumerate(coat.operators) if o.kind == "length")
        bpy.ops.object.pelage_value_set(index=length, key="value", action="MAP")
        coat.operators[length].maps[0].group = group.name
        mapped = covered(render())
        self.assertLess(mapped[16:].sum(), bald[16:].sum())
        coat.use_density, coat.density.group = True, group.name
        upper = covered(render())
        self.assertLess(upper[20:].sum(), bald[20:].sum())
        self.assertGreater(upper[:12].sum(), 0.7 * bald[:12].sum())

    def test_an_image_is_a_map(self):
        ob = furry("LONG", 500)
        image = bpy.data.images.new("length", 2, 2, float_buffer=True)
        image.pixels.foreach_set(np.tile(np.array([0.5, 0, 0, 1], np.float32), 4))
        length = next(o for o in ob.pelage.coats[0].operators if o.kind == "length")
        map_ = length.maps.add()
        map_.key, map_.source, map_.image, map_.high = "value", "IMAGE", image, 0.5
        mapped = render()
        length.maps.clear()
        length["value"] = 0.25 * length["value"]
        for name in LAYERS:  # half of a half is a quarter
            np.testing.assert_allclose(mapped[name], render()[name], atol=0.02)

    def test_four_vertex_groups_are_an_error(self):
        ob = furry()
        for i in range(4):
            ob.vertex_groups.new(name=f"g{i}")
            map_ = ob.pelage.coats[0].operators[0].maps.add()
            map_.key, map_.group = "value", f"g{i}"
        with self.assertRaises(RuntimeError) as caught:
            render()
        self.assertIn("4 vertex groups", str(caught.exception))

    def test_guides_shape_the_coat(self):
        ob = furry("SHORT")
        ob.location = (0.5, 0, 0.25)
        straight = covered(render())
        bpy.context.view_layer.update()
        bpy.ops.object.curves_random_add()  # 500 curves with roots near the origin
        guides = bpy.context.object
        points = np.empty(len(guides.data.position_data) * 3, np.float32)
        guides.data.position_data.foreach_get("vector", points)
        count = len(guides.data.position_data) // len(guides.data.curves)
        rng = np.random.default_rng(1)
        roots = rng.normal(size=(len(guides.data.curves), 1, 3))
        roots /= np.linalg.norm(roots, axis=2, keepdims=True)
        along = np.linspace(0, 1, count)[None, :, None]
        guides.data.position_data.foreach_set("vector", (roots + along * [0, 0, 0.8]).astype(np.float32).ravel())
        guides.location = ob.location
        guides.hide_render = True
        bpy.context.view_layer.update()
        coat = ob.pelage.coats[0]
        coat.guides = guides
        coat.operators.clear()
        operator = coat.operators.add()
        operator.kind, operator["root"], operator["tip"] = "width", 0.05, 0.05
        guided = covered(render())
        rows = lambda mask: np.flatnonzero(mask.any(axis=1))
        self.assertLess(rows(guided)[0], rows(straight)[0] - 2)        # hair rises upwards,
        self.assertGreaterEqual(rows(guided)[-1], rows(straight)[-1] - 3)  # and not elsewhere

    def test_particle_hair_shapes_the_coat_and_is_not_rendered(self):
        ob = furry("SHORT", 500)
        ob.location, ob.scale = (1, 2, 3), (2, 2, 2)
        hairy(ob, 200, 0.5, child_type="INTERPOLATED", child_nbr=2)
        coat = ob.pelage.coats[0]
        self.assertEqual(len(document()["grooms"]), 2)
        coat.guide_hair = ob.particle_systems[0].name
        grooms = document()["grooms"]
        self.assertEqual(len(grooms), 1)
        self.assertIn("guides", next(iter(grooms.values()))["operators"][0])
        points = OUTPUT / f"document{len(os.listdir(OUTPUT)) - 1}" / next(iter(grooms.values()))["operators"][0]["guides"]["file"]
        data = points.read_bytes()
        self.assertEqual(int.from_bytes(data[4:8], "little"), 200)
        roots = np.frombuffer(data, "<f4", 200 * 5 * 3, 128).reshape(200, 5, 3)[:, 0]
        # At rest, the ball has twice its radius and is at the origin; its faces are inside the sphere.
        radius = np.linalg.norm(roots, axis=1)
        self.assertLess(radius.max(), 2.001)
        self.assertGreater(radius.min(), 1.7)
        coat.guide_hair = "none"
        with self.assertRaises(RuntimeError) as caught:
            render()
        self.assertIn("'none'", str(caught.exception))

    def test_a_coat_moves_with_its_object(self):
        ob = furry()
        here = render()
        ob.location = bpy.context.scene.camera.location.copy() * 0
        ob.location.x = bpy.context.scene.camera.location.x = 2
        there = render()
        # Positions are rounded elsewhere, so single samples differ.
        self.assertGreater(np.corrcoef(here["R"].ravel(), there["R"].ravel())[0, 1], 0.999)

    def test_a_deformed_and_subdivided_skin_keeps_its_rest_pose(self):
        ob = furry()
        at_rest = meshes.vertices_of(ob.data)
        twist = ob.modifiers.new("twist", "SIMPLE_DEFORM")
        twist.deform_method, twist.angle = "TWIST", 1
        graph = bpy.context.evaluated_depsgraph_get()
        truth = meshes.vertices_of(ob.evaluated_get(graph).data).copy()
        for boundary in ("ALL", "PRESERVE_CORNERS"):
            smooth = ob.modifiers.new("smooth", "SUBSURF")
            smooth.levels, smooth.boundary_smooth = 2, boundary
            graph = bpy.context.evaluated_depsgraph_get()
            evaluated = ob.evaluated_get(graph)
            cage = meshes.cage_of(evaluated, evaluated.data, False, True, [])
            self.assertEqual(cage.scheme, "catmull-clark")
            np.testing.assert_array_equal(cage.rest, at_rest)
            np.testing.assert_allclose(cage.points, truth, atol=1e-5)  # the iteration ends at a millionth of the size
            np.testing.assert_allclose(meshes.pose_of(evaluated, evaluated.data, cage), truth, atol=1e-5)
            ob.modifiers.remove(smooth)

    def test_fur_on_a_mirrored_mesh_grows_outward(self):
        ob = furry("LONG")
        plain = render()["A"].mean()
        ob.scale = (-1, 1, 1)
        self.assertAlmostEqual(render()["A"].mean() / plain, 1, delta=0.05)  # other strands, and a ball without hair has 0.6

    def test_a_mirrored_coat_is_the_mirror_of_the_coat(self):
        """What turns the rest pose into the pose of the frame turns the direction of the comb as the object does."""
        ob = furry()
        comb = next(o for o in ob.pelage.coats[0].operators if o.kind == "comb")
        comb["direction"] = [1.0, 2.0, 3.0]
        ob.rotation_euler = (0.3, 0.4, 0.5)
        for scale in ((1, 1, 1), (-1, 1, 1), (1, -2, 1), (1, 1, -1), (-1, -1, -1), (-1, 1, -1)):
            ob.scale = scale
            bpy.context.view_layer.update()
            made = document()
            folder = OUTPUT / f"document{len(os.listdir(OUTPUT)) - 1}"
            groom, block = next(iter(made["grooms"].values())), made["characters"]["Sphere"]["transform"]
            direction = next(o["comb"]["direction"] for o in groom["operators"] if "comb" in o)
            lines = (folder / "Sphere.obj").read_text().splitlines()
            rest = np.array([line.split()[1:4] for line in lines if line.startswith("v ")], float)
            turn = np.array(Euler(np.radians(block["rotate"])).to_matrix())
            truth = axes.to_pelage(axes.transformed(meshes.vertices_of(ob.data), ob.matrix_world))
            np.testing.assert_allclose(rest @ turn.T + block["translate"], truth, atol=1e-5, err_msg=str(scale))
            np.testing.assert_allclose(turn @ turn.T, np.eye(3), atol=1e-5, err_msg=str(scale))
            self.assertAlmostEqual(np.linalg.det(turn), 1, places=4)
            stretch = np.array([1.0, 2.0, 3.0]) / np.abs(scale)  # the direction is one of the size in the world
            expected = ob.matrix_world.to_3x3() @ Vector(stretch)
            np.testing.assert_allclose(turn @ direction, (expected.x, expected.z, -expected.y), atol=1e-4, err_msg=str(scale))

    def test_a_map_that_is_gone_is_an_error(self):
        ob = furry()
        coat = ob.pelage.coats[0]
        coat.use_density, coat.density.group = True, ob.vertex_groups.new(name="back").name
        self.assertIn("density", next(iter(document()["grooms"].values())))
        ob.vertex_groups["back"].name = "Back"
        with self.assertRaisesRegex(ValueError, "'density' on 'Sphere' is the vertex group 'back'"):
            document()
        coat.density.source = "IMAGE"
        with self.assertRaisesRegex(ValueError, "'density' on 'Sphere' has no image"):
            document()

    def test_fur_is_blurred_like_its_skin(self):
        ob = furry("LONG", 1000, 40)
        scene = bpy.context.scene
        scene.pelage.lod, scene.pelage.samples = False, 16
        for frame, x in ((1, -1), (2, 1)):
            ob.location.x, ob.rotation_euler.y = x, 0.2 * x
            ob.keyframe_insert("location", frame=frame)
            ob.keyframe_insert("rotation_euler", frame=frame)
        for curve in ob.animation_data.action.fcurves:
            curve.extrapolation = "LINEAR"
            for key in curve.keyframe_points:
                key.interpolation = "LINEAR"
        moments = []
        for step in range(3):
            scene.frame_set(1, subframe=(step + 0.5) / 3)
            moments.append(render()["A"])
        scene.frame_set(1)
        scene.render.use_motion_blur, scene.render.motion_blur_shutter = True, 1
        scene.cycles.motion_blur_position = "START"
        blurred = render()["A"]
        # Three moments stand for the shutter. They miss a sixth of it at each end, where the sum of a column is about 0.1.
        smooth = lambda rows: np.convolve(rows.mean(axis=0), np.ones(5) / 5, "same")
        np.testing.assert_allclose(smooth(blurred), smooth(np.mean(moments, axis=0)), atol=0.04)
        self.assertGreater(np.abs(blurred - moments[0]).mean(), 0.02)

    def test_a_saved_file_has_the_same_coat(self):
        furry("WET")
        before = render()
        path = new_path("blend")
        bpy.ops.wm.save_as_mainfile(filepath=str(path))
        bpy.ops.wm.read_homefile(use_factory_startup=True)
        bpy.ops.wm.open_mainfile(filepath=str(path))
        after = render()
        for name in LAYERS:
            np.testing.assert_array_equal(before[name], after[name])
        ui = bpy.context.object.pelage.coats[0].operators[1].id_properties_ui("lift").as_dict()
        self.assertEqual((ui["min"], ui["max"]), (0, 1))

    def test_yaml_gives_the_same_picture(self):
        with self.assertRaises(RuntimeError):
            empty_scene()
            bpy.ops.scene.pelage_write_yaml()  # the file has no name yet
        furry("FLUFFY")
        picture = render(samples=2)
        path = OUTPUT / "Fell ö 'x'.blend"
        bpy.ops.wm.save_as_mainfile(filepath=str(path))
        self.assertEqual(bpy.ops.scene.pelage_write_yaml(), {"FINISHED"})
        folder = OUTPUT / "Fell ö 'x'_pelage"
        text = (folder / "scene.yaml").read_text()
        bpy.ops.scene.pelage_write_yaml()
        self.assertEqual([path.name for path in folder.glob("*.yaml")], ["scene.yaml"])
        (folder / "scene.yaml").write_text(text.replace("comb", "curl", 1))
        for _ in range(2):
            bpy.ops.scene.pelage_write_yaml()
            self.assertEqual(sorted(path.name for path in folder.glob("*.yaml")), ["scene 2.yaml", "scene.yaml"])
        self.assertEqual((folder / "scene 2.yaml").read_text(), text)
        (folder / "scene.yaml").write_text(text)
        self.assertIn("  - comb: {", text)
        subprocess.run([preferences.program(), "render", folder / "scene.yaml", "-o", folder / "a.exr", "--quiet"], check=True)
        written = exr.read(folder / "a.exr")[1]
        for name in LAYERS:
            np.testing.assert_allclose(written[name], picture[name], rtol=2e-3, atol=1e-4)  # half floats

    def test_presets_are_scaled_with_the_object(self):
        ob = furry()
        first = ob.pelage.coats[0].operators[0]["value"]
        ob.scale = (2, 2, 2)
        bpy.context.view_layer.update()
        bpy.ops.object.pelage_fur_add(preset="SHORT")
        self.assertAlmostEqual(ob.pelage.coats[1].operators[0]["value"], 2 * first, places=5)
        self.assertEqual(ob.pelage.coats[1].name, "Short 2")
        self.assertEqual(fur_operators.active_coat(bpy.context).name, "Short 2")


if __name__ == "__main__":
    run()
