# SPDX-License-Identifier: Apache-2.0
"""The same scenes in Cycles: lights, cameras, silhouettes and hair."""
import math
import pathlib
import sys
import unittest
import unittest.mock

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import bmesh
import bpy
import numpy as np
from inside import camera, empty_scene, grey_plane, hairy, light, material, mean, new_path, render, run, set_world
from pelage_blender import scene_writer


def profile_text(horizontal=(0, 90, 180, 270, 360)):
    """A photometric file, uneven about its axis, in steps fine enough that both interpolations agree within 0.1 %."""
    vertical = range(0, 181, 5)
    rows = [[1000 * (1.2 + math.cos(math.radians(v)) + 0.5 * math.sin(math.radians(v)) * math.sin(math.radians(h - 40)))
             for v in vertical] for h in horizontal]
    numbers = [1, -1, 1, len(vertical), len(rows), 1, 2, 0, 0, 0, 1, 1, 50, *vertical, *horizontal, *sum(rows, [])]
    return "IESNA:LM-63-1995\n[TEST] lamp\nTILT=NONE\n" + "\n".join(f"{number:.6g}" for number in numbers) + "\n"


def add_profile(data, text=None, file=None, strength=1.0):
    data.use_nodes = True
    tree = data.node_tree
    node = tree.nodes.new("ShaderNodeTexIES")
    node.inputs["Strength"].default_value = strength
    if file is not None:
        node.mode, node.filepath = "EXTERNAL", str(file)
    else:
        node.mode, node.ies = "INTERNAL", bpy.data.texts.new("profile")
        node.ies.write(text)
    tree.links.new(node.outputs["Fac"], tree.nodes["Emission"].inputs["Strength"])


def blocks(picture, size=12):
    """Means of squares of a picture, whose noise is 3 % at most."""
    rows, columns = picture["G"].shape
    return picture["G"].reshape(rows // size, size, columns // size, size).mean(axis=(1, 3)) + 1e-3


class Lights(unittest.TestCase):
    """Mean of a grey plane within 2 %. The noise of 8 samples of 2304 pixels is below 0.7 %."""

    def setUp(self):
        empty_scene()
        grey_plane()
        camera((0, -3, 3))

    def ratio(self):
        ours, truth = render("PELAGE", 8), render("CYCLES", 8)
        self.assertGreater(mean(truth), 0.01)
        return mean(ours) / mean(truth)

    def test_area(self):
        for shape in ({"shape": "SQUARE"}, {"shape": "RECTANGLE", "size_y": 0.5}, {"shape": "DISK"},
                      {"shape": "ELLIPSE", "size_y": 0.5}):
            ob = light("AREA", (1, 0, 2), energy=100, size=1, **shape)
            ob.scale = (1.2, 0.8, 1) if shape["shape"] != "DISK" else (1, 1, 1)
            self.assertAlmostEqual(self.ratio(), 1, delta=0.02, msg=shape)
            bpy.data.objects.remove(ob)

    def test_spread(self):
        for shape, spread in (("RECTANGLE", 70), ("DISK", 130)):
            ob = light("AREA", (0.5, 0, 2), energy=100, size=0.7, shape=shape, spread=math.radians(spread))
            self.assertAlmostEqual(self.ratio(), 1, delta=0.02, msg=shape)
            bpy.data.objects.remove(ob)

    def test_profile(self):
        path = new_path("ies")
        path.write_text(profile_text(range(0, 361, 15)))
        for kind, values, source in (("POINT", {}, {"file": path, "strength": 2}),
                                     ("SPOT", {"spot_size": math.radians(90)}, {"text": path.read_text()})):
            ob = light(kind, (0.5, 0, 1.5), (0.8, 0.6, 0), energy=3, shadow_soft_size=0.01, **values)
            add_profile(ob.data, **source)
            ours, truth = render("PELAGE", 8), render("CYCLES", 8)
            self.assertGreater(mean(truth), 0.01)
            self.assertAlmostEqual(mean(ours) / mean(truth), 1, delta=0.02, msg=kind)
            self.assertLess(np.abs(blocks(ours) / blocks(truth) - 1).max(), 0.05, "a turned or mirrored profile")
            bpy.data.objects.remove(ob)

    def test_profile_without_a_file(self):
        ob = light("POINT", (0.5, 0, 1.5), energy=0.2, shadow_soft_size=0.01)
        add_profile(ob.data, file=new_path("ies"), strength=0.5)
        self.assertAlmostEqual(self.ratio(), 1, delta=0.02)

    def test_sun(self):
        for angle in (0, 0.2):
            ob = light("SUN", (1, 0, 2), energy=3, angle=angle, color=(1, 0.5, 0.2))
            self.assertAlmostEqual(self.ratio(), 1, delta=0.02)
            bpy.data.objects.remove(ob)

    def test_point(self):
        light("POINT", (0.5, 0, 1), energy=50, shadow_soft_size=0.01)
        self.assertAlmostEqual(self.ratio(), 1, delta=0.02)

    def test_a_large_point_is_a_sphere_here_and_a_disc_there(self):
        """Cycles 3.4 lights by a disc that faces the surface: less than by a sphere by d^2 / (d^2 + r^2) in its middle."""
        bpy.ops.object.select_all(action="DESELECT")
        plane = bpy.context.object
        plane.scale = (0.02, 0.02, 1)
        camera((0, -0.05, 0.3))
        light("POINT", (0, 0, 1), energy=50, shadow_soft_size=0.5)
        self.assertAlmostEqual(self.ratio(), 1.25, delta=0.025)

    def test_spot(self):
        for size, blend in ((50, 0), (120, 1)):
            ob = light("SPOT", (0.5, 0, 2), energy=200, shadow_soft_size=0.01, spot_size=math.radians(size), spot_blend=blend)
            self.assertAlmostEqual(self.ratio(), 1, delta=0.02)
            bpy.data.objects.remove(ob)

    def test_world(self):
        set_world(0.7, (0.5, 0.4, 0.3))
        self.assertAlmostEqual(self.ratio(), 1, delta=0.02)

    def test_world_image(self):
        image = bpy.data.images.new("sky", 32, 16, float_buffer=True)
        image.pixels.foreach_set((0.3 + np.random.default_rng(5).random((16, 32, 4)) ** 4).astype(np.float32).ravel())
        tree = bpy.context.scene.world.node_tree
        sky = tree.nodes.new("ShaderNodeTexEnvironment")
        sky.image = image
        tree.links.new(sky.outputs["Color"], tree.nodes["Background"].inputs["Color"])
        set_world(1)
        self.assertAlmostEqual(self.ratio(), 1, delta=0.02)

    def test_emitting_mesh(self):
        """The add-on leaves emitting surfaces out: a `mesh` light takes the place of the world in the scene."""
        path = new_path("obj")
        corners = [(x, y, z) for x in (0.2, 0.6) for y in (1.0, 1.4) for z in (-0.1, 0.1)]
        faces = ((1, 2, 4, 3), (5, 7, 8, 6), (1, 5, 6, 2), (3, 4, 8, 7), (1, 3, 7, 5), (2, 6, 8, 4))
        path.write_text("".join(f"v {x} {y} {z}\n" for x, y, z in corners) + "".join(f"f {a} {b} {c} {d}\n" for a, b, c, d in faces))
        bpy.ops.mesh.primitive_cube_add(size=1, location=(0.4, 0, 1.2), scale=(0.4, 0.2, 0.4))
        emitter = bpy.context.object
        emitter.data.materials.append(material("ShaderNodeEmission", "emission", Strength=9))
        emitter.visible_camera = False
        truth = render("CYCLES", 16)
        emitter.hide_render = True
        mesh = {"type": "mesh", "file": str(path), "radiance": 9}
        with unittest.mock.patch.object(scene_writer, "world_block", return_value=mesh):
            ours = render("PELAGE", 16)
        self.assertAlmostEqual(mean(ours) / mean(truth), 1, delta=0.02)


class Cameras(unittest.TestCase):
    """Silhouettes: less than 1 % of the pixels differ by more than half."""

    def differing(self, samples=4):
        ours, truth = render("PELAGE", samples), render("CYCLES", samples)
        self.assertGreater(truth["A"].mean(), 0.03)
        return float((np.abs(ours["A"] - truth["A"]) > 0.5).mean())

    def scene(self, width=80, height=48, **values):
        scene = empty_scene(width, height)
        scene.render.film_transparent = True
        set_world(1)
        ob = camera((3, -5, 2.5))
        for key, value in values.items():
            setattr(ob.data, key, value)

    def test_sensors_and_shift(self):
        for size, values in (((80, 48), {"shift_x": 0.1, "shift_y": -0.07}), ((80, 48), {"sensor_fit": "VERTICAL"}),
                             ((48, 80), {"sensor_fit": "HORIZONTAL"}), ((48, 80), {"type": "ORTHO", "ortho_scale": 4,
                                                                                   "shift_x": 0.1})):
            self.scene(*size, **values)
            bpy.ops.mesh.primitive_monkey_add(rotation=(0.3, 0.2, 0.1))
            bpy.context.object.scale = (1, 0.5, 1.5)
            self.assertLess(self.differing(), 0.01, (size, values))

    def test_a_cage_and_polygons(self):
        """A cage of two materials is one surface, and sharp corners are those of Blender."""
        for levels, sharp in ((0, False), (4, False), (4, True)):
            self.scene()
            bpy.ops.mesh.primitive_cube_add()
            ob = bpy.context.object
            ob.modifiers.new("smooth", "SUBSURF").render_levels = levels
            if sharp:
                made = bmesh.new()
                made.from_mesh(ob.data)
                crease = made.verts.layers.crease.verify()
                for vertex in made.verts:
                    vertex[crease] = 1.0
                made.to_mesh(ob.data)
            else:
                for name in ("one", "other"):
                    ob.data.materials.append(material(name=name))
                ob.data.polygons[5].material_index = 1
            self.assertLess(self.differing(), 0.01, (levels, sharp))

    def test_instances_text_and_hidden_emitters(self):
        self.scene()
        collection = bpy.data.collections.new("source")
        bpy.ops.mesh.primitive_uv_sphere_add(radius=0.5)
        ball = bpy.context.object
        hairy(ball, 60, 0.5, root_radius=8, brownian_factor=0.05)
        bpy.context.collection.objects.unlink(ball)
        collection.objects.link(ball)
        for x, scale in ((-1.5, (1, 1, 1)), (0, (-1, 1, 1)), (1.5, (1, 0.5, 1.4))):
            empty = bpy.data.objects.new("instance", None)
            empty.instance_type, empty.instance_collection = "COLLECTION", collection
            empty.location, empty.scale, empty.rotation_euler = (x, 0, 0), scale, (0, 0.3 * x, 0.2)
            bpy.context.collection.objects.link(empty)
        bpy.ops.object.text_add(location=(-1, 0, 1), rotation=(1.4, 0, 0))
        bpy.context.object.data.body = "Fell ü"
        bpy.context.object.data.extrude = 0.1
        bpy.ops.mesh.primitive_uv_sphere_add(radius=0.5, location=(0, 0, -1.2))
        hairy(bpy.context.object, 60, 0.5, root_radius=8)
        bpy.context.object.show_instancer_for_render = False
        bpy.context.scene.pelage.lod = False
        self.assertLess(self.differing(16), 0.01)

    def test_depth_of_field(self):
        self.scene()
        bpy.ops.mesh.primitive_monkey_add()
        dof = bpy.context.scene.camera.data.dof
        dof.use_dof, dof.focus_distance, dof.aperture_fstop = True, 3, 0.1
        ours, truth = render("PELAGE", 48), render("CYCLES", 48)
        dof.use_dof = False
        sharp = render("PELAGE", 4)
        blur = np.abs(truth["A"] - sharp["A"]).mean()
        # Binomial noise of both, 0.06 in blurred pixels, is a fifth of the blur.
        self.assertLess(np.abs(ours["A"] - truth["A"]).mean(), 0.3 * blur)


class Hair(unittest.TestCase):
    def furry(self, **inputs):
        scene = empty_scene(64, 64)
        scene.render.film_transparent = True
        set_world(1)
        camera((0, -5, 2))
        bpy.ops.mesh.primitive_uv_sphere_add(segments=24, ring_count=12)
        bpy.ops.object.shade_smooth()
        ob = bpy.context.object
        ob.data.materials.append(material(Color=(0.3, 0.3, 0.3, 1)))
        hair = material("ShaderNodeBsdfHairPrincipled", "fur", **inputs)
        ob.data.materials.append(hair)
        hairy(ob, 800, 0.6, slot=2, root_radius=4, tip_radius=1, brownian_factor=0.05)
        scene.pelage.lod = False
        scene.pelage.bounces = 12
        for kind in ("max", "diffuse", "glossy", "transmission"):
            setattr(scene.cycles, f"{kind}_bounces", 12)
        return hair.node_tree.nodes["Principled Hair BSDF"]

    def test_means_and_silhouettes(self):
        for kind, inputs in (("COLOR", {"Color": (0.5, 0.3, 0.15, 1), "Roughness": 0.2}),
                             ("MELANIN", {"Melanin": 0.4, "Melanin Redness": 0.7, "Random Color": 0})):
            self.furry(**inputs).parametrization = kind
            ours, truth = render("PELAGE", 24), render("CYCLES", 24)
            self.assertAlmostEqual(mean(ours) / mean(truth), 1, delta=0.05, msg=kind)
            for channel in "RGB":
                self.assertAlmostEqual(ours[channel].mean() / truth[channel].mean(), 1, delta=0.05, msg=(kind, channel))
            self.assertLess((np.abs(ours["A"] - truth["A"]) > 0.5).mean(), 0.01)


if __name__ == "__main__":
    run()
