# SPDX-License-Identifier: Apache-2.0
"""Renders from Blender: what goes to Pelage, and what comes back."""
import pathlib
import sys
import unittest
from unittest import mock

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import bpy
import numpy as np
from inside import (OUTPUT, camera, empty_scene, exr, grey_plane, hairy, left_folders, light, material, mean, new_path,
                    render, run, set_world)
from pelage_blender import hair_particles, images, meshes, particle_keys, scene_writer
from pelage_blender.scene_folder import SceneFolder


class Engine(unittest.TestCase):
    def tearDown(self):
        self.assertEqual(left_folders(), [])

    def test_the_default_cube_has_ten_thousand_hairs(self):
        bpy.ops.wm.read_homefile(use_factory_startup=True)
        scene = bpy.context.scene
        scene.render.engine = "PELAGE"
        scene.render.resolution_x, scene.render.resolution_y = 96, 54
        scene.pelage.samples = 1
        hairy(bpy.data.objects["Cube"], 10000, render_step=2)
        set_world(0)
        picture = render()
        self.assertEqual(picture["R"].shape, (54, 96))
        self.assertGreater(mean(picture), 0.005)
        self.assertEqual(picture["A"].min(), 1)

    def test_memory_and_calls_give_the_same_hair(self):
        empty_scene()
        bpy.ops.mesh.primitive_uv_sphere_add(location=(1, 2, 3), rotation=(0.3, 0.2, 0.1))
        ob = bpy.context.object
        for values in ({}, {"child_type": "INTERPOLATED", "rendered_child_count": 3, "child_nbr": 3},
                       {"child_type": "SIMPLE", "rendered_child_count": 3, "child_nbr": 3, "use_clump_noise": True}):
            ob.modifiers.clear()
            hairy(ob, 100, brownian_factor=0.1, display_step=3, **values)
            evaluated = ob.evaluated_get(bpy.context.evaluated_depsgraph_get())
            system = hair_particles.hair_systems(evaluated, False)[0][1]
            numbers, steps = hair_particles.strand_range(system, False), hair_particles.steps_of(system, False)
            slow, segments = particle_keys.keys_by_calls(evaluated, system, numbers, steps)
            fast, same = particle_keys._keys_from_memory(system, numbers, steps)
            np.testing.assert_array_equal(segments, same)
            np.testing.assert_allclose(slow, fast, atol=1e-5)  # two roundings of a matrix that is its own inverse

    def test_a_wrong_layout_of_memory_is_noticed(self):
        empty_scene()
        bpy.ops.mesh.primitive_uv_sphere_add()
        hairy(bpy.context.object, 20)
        evaluated = bpy.context.object.evaluated_get(bpy.context.evaluated_depsgraph_get())
        system = hair_particles.hair_systems(evaluated, False)[0][1]
        numbers, steps = hair_particles.strand_range(system, False), hair_particles.steps_of(system, False)
        with mock.patch.object(particle_keys, "KEY_FLOATS", 17):
            keys, segments = particle_keys.read_keys(evaluated, system, numbers, steps)
        np.testing.assert_array_equal(segments, steps)
        np.testing.assert_array_equal(keys, particle_keys.keys_by_calls(evaluated, system, numbers, steps)[0])

    def test_curves_are_strands(self):
        empty_scene()
        bpy.ops.object.curves_random_add()
        set_world(1)
        camera((0, -6, 1))
        scene = bpy.context.scene
        scene.render.film_transparent = True
        scene.pelage.lod = False
        picture = render(samples=16)
        self.assertGreater(picture["A"].mean(), 0.02)
        self.assertEqual(picture["A"][0, 0], 0)
        truth = render("CYCLES", 16)
        # Both draw the curve through the same points, Cycles in straight pieces; 16 samples of 600 pixels give 1 %.
        self.assertAlmostEqual(picture["A"].mean() / truth["A"].mean(), 1, delta=0.02)

    def test_curves_without_a_radius_are_as_wide_as_in_cycles(self):
        scene = empty_scene()
        scene.render.film_transparent, scene.pelage.lod = True, False
        set_world(1)
        camera((0, -4, 0))
        bpy.ops.mesh.primitive_uv_sphere_add(segments=16, ring_count=8, radius=0.5)
        hairy(bpy.context.object, 400, 1, display_step=2)
        bpy.ops.curves.convert_from_particle_system()
        bpy.data.objects.remove(bpy.data.objects["Sphere"])
        ours, truth = render(samples=16), render("CYCLES", 16)
        self.assertAlmostEqual(ours["A"].mean() / truth["A"].mean(), 1, delta=0.02)  # noise of 16 samples of 1000 pixels

    def test_objects_can_be_rendered_in_every_mode(self):
        empty_scene(16, 16)
        bpy.ops.mesh.primitive_uv_sphere_add(segments=8, ring_count=4)
        ob = bpy.context.object
        ob.modifiers.new("smooth", "SUBSURF")
        hairy(ob, 10)
        bpy.ops.object.pelage_fur_add(preset="SHORT")
        ob.pelage.coats[0].strands = 10
        ob.vertex_groups.new(name="group")
        camera()
        set_world(1)
        for mode in ("EDIT", "SCULPT", "PARTICLE_EDIT"):
            bpy.ops.object.mode_set(mode=mode)
            self.assertGreater(mean(render(samples=1)), 0.1, mode)

    def test_frames_differ_and_motion_is_blurred(self):
        scene = empty_scene()
        bpy.ops.mesh.primitive_cube_add(size=1)
        ob = bpy.context.object
        for frame, x in ((1, -1), (2, 1)):
            ob.location.x = x
            ob.keyframe_insert("location", frame=frame)
        for curve in ob.animation_data.action.fcurves:
            for key in curve.keyframe_points:
                key.interpolation = "LINEAR"
            curve.extrapolation = "LINEAR"
        camera((0, -6, 0))
        set_world(1)
        scene.frame_start, scene.frame_end = 1, 2
        scene.render.film_transparent = True
        first, second = render(samples=4, animation=True)
        columns = np.arange(48)
        self.assertLess(np.average(columns, weights=first["A"].sum(axis=0)), 20)
        self.assertGreater(np.average(columns, weights=second["A"].sum(axis=0)), 27)
        scene.render.use_motion_blur = True
        scene.frame_set(1)
        blurred = render(samples=64)
        self.assertEqual(scene.frame_current, 1)
        truth = render("CYCLES", 64)
        self.assertAlmostEqual(blurred["A"].sum(), first["A"].sum(), delta=0.02 * first["A"].sum())
        # Partly covered pixels of both are binomial with 64 samples: at most 0.06, and 0.02 on average over a column of 8.
        np.testing.assert_allclose(blurred["A"].mean(axis=0), truth["A"].mean(axis=0), atol=0.02)

    def test_a_mesh_with_another_topology_stays_where_it_is(self):
        empty_scene()
        bpy.ops.mesh.primitive_monkey_add()
        ob = bpy.context.object
        modifier = ob.modifiers.new("fewer", "DECIMATE")
        modifier.ratio = 0.3
        graph = bpy.context.evaluated_depsgraph_get()
        evaluated = ob.evaluated_get(graph)
        cage = meshes.cage_of(evaluated, evaluated.data, False, False, [])
        np.testing.assert_array_equal(meshes.pose_of(evaluated, evaluated.data, cage), cage.points)
        modifier.ratio = 1
        evaluated = ob.evaluated_get(bpy.context.evaluated_depsgraph_get())
        self.assertGreater(len(evaluated.data.vertices), cage.topology[0])
        self.assertIsNone(meshes.pose_of(evaluated, evaluated.data, cage))

    def test_smooth_polygons_of_two_materials_have_no_seam(self):
        pictures = []
        for slots in (1, 2):
            empty_scene(24, 24)
            camera((0, -4, 0))
            light("SUN", (3, -3, 3), energy=3)
            bpy.ops.mesh.primitive_uv_sphere_add(segments=12, ring_count=6)
            bpy.ops.object.shade_smooth()
            ob = bpy.context.object
            for name in "ab":
                ob.data.materials.append(material(name=name, Color=(0.5, 0.5, 0.5, 1)))
            for polygon in ob.data.polygons:
                polygon.material_index = int(polygon.center.z > 0) * (slots - 1)
            pictures.append(render(samples=4)["R"])
        np.testing.assert_allclose(*pictures, atol=1e-3)  # halves

    def test_every_motion_step_of_the_camera_and_the_lights_is_written(self):
        scene = empty_scene(8, 8)
        grey_plane()
        camera()
        light("SPOT", energy=100)
        for ob in (bpy.data.objects["camera"], bpy.data.objects["light"]):
            for frame, x in ((1, 0), (1.5, 1), (2, 0)):
                ob.location.x = x
                ob.keyframe_insert("location", frame=frame)
        scene.render.use_motion_blur, scene.render.motion_blur_shutter, scene.pelage.motion_keys = True, 1, 3
        scene.cycles.motion_blur_position = "START"
        document = scene_writer.SceneWriter(SceneFolder(OUTPUT)).write(
            bpy.context.evaluated_depsgraph_get(), (8, 8), lambda whole, part: scene.frame_set(whole, subframe=part))
        for block in (document["camera"], document["lights"]["light"]):
            places = {key: place[0] for key, place in block["position"]["keys"].items()}
            self.assertEqual(places, {"1": 0, "1.5": 1, "2": 0})
        self.assertGreater(mean(render(samples=1)), 0)

    def test_an_image_lights_the_world(self):
        scene = empty_scene()
        tree = scene.world.node_tree
        node, mapping = tree.nodes.new("ShaderNodeTexEnvironment"), tree.nodes.new("ShaderNodeMapping")
        across, up = np.meshgrid(np.linspace(0, 2 * np.pi, 64, endpoint=False), np.linspace(1, 0, 32))
        channels = {"R": 1 + np.sin(across), "G": up, "B": 1 + np.cos(across)}
        path = new_path("exr")
        path.write_bytes(exr.encode({name: values.astype(np.float32) for name, values in channels.items()}))
        node.image = bpy.data.images.load(str(path))
        tree.links.new(node.outputs["Color"], tree.nodes["Background"].inputs["Color"])
        tree.links.new(mapping.outputs["Vector"], node.inputs["Vector"])
        coordinates = tree.nodes.new("ShaderNodeTexCoord")
        tree.links.new(coordinates.outputs["Generated"], mapping.inputs["Vector"])
        tree.nodes["Background"].inputs["Strength"].default_value = 1
        mapping.inputs["Rotation"].default_value[2] = 1
        camera((0, 0, 0), (1, 2, 0.5))
        ours, truth = render("PELAGE", 8), render("CYCLES", 8)
        for channel in "RGB":
            # The same image is seen directly, so only the filter of the picture differs.
            self.assertAlmostEqual(ours[channel].mean() / truth[channel].mean(), 1, delta=0.02)
            self.assertGreater(np.corrcoef(ours[channel].ravel(), truth[channel].ravel())[0, 1], 0.99)

    def test_a_region_is_a_part_of_the_picture(self):
        scene = empty_scene(64, 48)
        bpy.ops.mesh.primitive_monkey_add()
        camera()
        set_world(1)
        whole = render(samples=4)
        render_settings, scene.render.use_border = scene.render, True
        render_settings.border_min_x, render_settings.border_max_x = 0.25, 0.75
        render_settings.border_min_y, render_settings.border_max_y = 0.5, 1.0
        framed = render()
        self.assertEqual(framed["R"].shape, (48, 64))
        np.testing.assert_array_equal(framed["R"][:24, 16:48], whole["R"][:24, 16:48])
        self.assertEqual(framed["R"][24:].max(), 0)
        render_settings.use_crop_to_border = True
        np.testing.assert_array_equal(render()["R"], whole["R"][:24, 16:48])

    def test_sizes_are_rounded_as_in_blender(self):
        scene = empty_scene(100, 90)
        camera()
        set_world(1)
        for percentage in (29, 57):
            scene.render.resolution_percentage = percentage
            render(samples=1)  # Blender refuses another size
        scene.render.resolution_percentage = 100
        scene.render.use_border = True
        scene.render.border_min_x, scene.render.border_max_x = 0.29, 0.7
        scene.render.border_min_y, scene.render.border_max_y = 0.1, 0.57
        ours, truth = render(samples=1), render("CYCLES", 1)
        np.testing.assert_array_equal(ours["R"] > 0, truth["R"] > 0)

    def test_layers_of_lights_add_up(self):
        scene = empty_scene(24, 24)
        grey_plane()
        camera()
        light("SUN", energy=2, name="Sonne über 'Köln' \"1\", hinter den Häusern am anderen Ufer")  # 62 bytes
        light("POINT", (0, 1, 1), energy=20, name="point.001")
        set_world(0.3)
        scene.pelage.light_layers = scene.pelage.data_layers = True
        scene.view_layers[0].use_pass_z = scene.view_layers[0].use_pass_normal = True
        picture = render(samples=4, multilayer=True)
        names = {name.rsplit(".", 1)[0] for name in picture}
        self.assertIn("ViewLayer.point_001.diffuse", names)
        self.assertTrue(any("Köln" in name for name in names), names)
        total = sum(picture[name] for name in picture if name.endswith((".diffuse.R", ".primary.R", ".secondary.R",
                                                                        ".emission.R")))
        np.testing.assert_allclose(total, picture["ViewLayer.Combined.R"], rtol=0.01, atol=0.01)  # halves, five of them
        centre = [picture[f"ViewLayer.Normal.{c}"][12, 12] for c in "XYZ"]
        np.testing.assert_allclose(centre, [0, 0, 1], atol=1e-5)  # z is up in Blender
        # The depth is that of the front-most sample: up to one of 24 pixels of 0.029 radians in front of the centre, on a
        # plane that is seen at tan = 2 / 5.
        self.assertAlmostEqual(float(picture["ViewLayer.Depth.Z"][12, 12]), 29 ** 0.5, delta=29 ** 0.5 * 0.029 * 2.5)

    def test_materials_and_images_reach_the_picture(self):
        empty_scene(16, 16)
        plane = grey_plane(8)
        image = bpy.data.images.new("Bild mit 'Umlaut ä'", 4, 4, float_buffer=True)
        image.pixels.foreach_set(np.tile(np.array([0.6, 0.3, 0.1, 1], np.float32), 16))
        node = plane.data.materials[0].node_tree.nodes.new("ShaderNodeTexImage")
        node.image = image
        tree = plane.data.materials[0].node_tree
        tree.links.new(node.outputs["Color"], tree.nodes["Diffuse BSDF"].inputs["Color"])
        camera((0, 0, 3))
        set_world(1)
        picture = render(samples=16)
        # In a white room, a diffuse surface has its own colour; the half floats of the picture have 11 bits.
        for channel, value in zip("RGB", (0.6, 0.3, 0.1)):
            self.assertAlmostEqual(picture[channel].mean(), value, delta=0.004)

    def test_a_sequence_of_images_follows_the_frame(self):
        scene = empty_scene(8, 8)
        for frame, value in ((1, 0.2), (2, 0.8)):
            (OUTPUT / f"seq{frame:04d}.exr").write_bytes(exr.encode({c: np.full((4, 4), value, np.float32) for c in "RGB"}))
        plane = grey_plane(8)
        tree = plane.data.materials[0].node_tree
        node = tree.nodes.new("ShaderNodeTexImage")
        node.image = bpy.data.images.load(str(OUTPUT / "seq0001.exr"))
        node.image.source = "SEQUENCE"
        user = node.image_user
        user.frame_duration, user.frame_start, user.use_auto_refresh = 2, 1, True
        tree.links.new(node.outputs["Color"], tree.nodes["Diffuse BSDF"].inputs["Color"])
        camera((0, 0, 3))
        set_world(1)
        for frame, number, cyclic in ((1, 1, False), (2, 2, False), (5, 1, True), (0, 1, False), (3, 2, False)):
            file = images.sequence_file(OUTPUT / "seq0001.exr", frame, start=1, count=2, offset=0, cyclic=cyclic)
            self.assertEqual(file.name, f"seq{number:04d}.exr")
        for frame, value, cyclic in ((2, 0.8, False), (5, 0.2, True)):
            user.use_cyclic = cyclic
            scene.frame_set(frame)
            # In a white room, a diffuse surface has its own colour; four samples of 64 pixels have a noise of 0.01.
            self.assertAlmostEqual(mean(render(samples=4)), value, delta=0.05)

    def test_tiles_of_an_image(self):
        empty_scene(16, 16)
        plane = grey_plane(8)
        for number, color in ((1001, "R"), (1002, "G")):
            tile = {name: np.full((4, 4), 0.5 * (name == color), np.float32) for name in "RGB"}
            (OUTPUT / f"tile.{number}.exr").write_bytes(exr.encode(tile))
        for corner in plane.data.uv_layers[0].data:
            corner.uv = (2 * corner.uv[0], corner.uv[1])
        image = bpy.data.images.load(str(OUTPUT / "tile.1001.exr"))
        image.source, image.filepath = "TILED", str(OUTPUT / "tile.<UDIM>.exr")
        tree = plane.data.materials[0].node_tree
        node = tree.nodes.new("ShaderNodeTexImage")
        node.image = image
        tree.links.new(node.outputs["Color"], tree.nodes["Diffuse BSDF"].inputs["Color"])
        camera((0, 0, 3))
        set_world(1)
        picture = render(samples=4)
        for channel, place in (("R", 4), ("G", 12)):
            self.assertAlmostEqual(float(picture[channel][8, place]), 0.5, delta=0.05)  # four samples
        self.assertEqual(picture["G"][8, 4], 0)

    def test_a_mesh_with_two_materials_and_hair(self):
        empty_scene(32, 32)
        bpy.ops.mesh.primitive_cube_add()
        ob = bpy.context.object
        ob.data.materials.append(material(name="rot", Color=(0.8, 0, 0, 1)))
        ob.data.materials.append(material(name="grün", Color=(0, 0.8, 0, 1)))
        ob.data.polygons[5].material_index = 1  # +z
        camera((0, 0, 5))
        set_world(1)
        hairy(ob, 4, length=0.01, root_radius=0.001)
        picture = render(samples=4)
        self.assertGreater(picture["G"][16, 16], 0.6)
        self.assertLess(picture["R"][16, 16], 0.05)

    def test_an_unsaved_file_and_odd_names(self):
        empty_scene(16, 16)
        self.assertEqual(bpy.data.filepath, "")
        bpy.ops.mesh.primitive_cube_add()
        bpy.context.object.name = "Würfel 'mit' \"Fell\" #: {x}.001"
        bpy.context.object.data.materials.append(material(name="Haut: ä, [1]"))
        hairy(bpy.context.object, 10).name = "Haare ß & {0}"
        camera(name="Kamera é")
        set_world(1, (1, 0.5, 0.25))
        self.assertGreater(mean(render(samples=1)), 0.1)


class Mistakes(unittest.TestCase):
    def tearDown(self):
        self.assertEqual(left_folders(), [])

    def failed(self):
        path = new_path("png")
        bpy.context.scene.render.filepath = str(path)
        bpy.context.scene.render.image_settings.file_format = "PNG"
        with self.assertRaises(RuntimeError) as caught:
            bpy.ops.render.render(write_still=True)
        self.assertFalse(path.exists())
        return str(caught.exception)

    def test_a_scene_without_a_picture_names_the_value(self):
        scene = empty_scene(16, 16)
        grey_plane()
        camera()
        scene.pelage.memory = 64
        scene.render.resolution_x = scene.render.resolution_y = 4000
        self.assertIn("memory", self.failed())

    def test_a_missing_image_is_named(self):
        empty_scene(16, 16)
        plane = grey_plane()
        camera()
        tree = plane.data.materials[0].node_tree
        node = tree.nodes.new("ShaderNodeTexImage")
        node.image = bpy.data.images.new("fehlt ö", 4, 4)
        node.image.source = "FILE"
        node.image.filepath = "//nicht da.png"
        tree.links.new(node.outputs["Color"], tree.nodes["Diffuse BSDF"].inputs["Color"])
        self.assertIn("fehlt ö", self.failed())

    def test_a_scene_without_camera_says_so(self):
        empty_scene(16, 16)
        grey_plane()
        with self.assertRaises(RuntimeError) as caught:
            bpy.ops.render.render()
        self.assertIn("camera", str(caught.exception).lower())

    def test_a_missing_program_and_a_crash_are_errors(self):
        empty_scene(16, 16)
        grey_plane()
        camera()
        with mock.patch.dict("os.environ", {"PELAGE_PROGRAM": "", "PATH": ""}):
            self.assertIn("preferences", self.failed())
        crash = new_path("sh")
        crash.write_text("#!/bin/sh\nkill -SEGV $$\n")
        crash.chmod(0o755)
        with mock.patch.dict("os.environ", {"PELAGE_PROGRAM": str(crash)}):
            self.assertIn("signal 11", self.failed())


if __name__ == "__main__":
    run()
