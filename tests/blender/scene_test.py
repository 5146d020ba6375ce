# SPDX-License-Identifier: Apache-2.0
"""Scenes that go to Pelage: instances, creases, particle hair, and objects of other files."""
import collections
import math
import os
import pathlib
import sys
import unittest
from unittest import mock

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import bpy
import numpy as np
from inside import OUTPUT, camera, empty_scene, exr, hairy, linked, render, run, set_world
from mathutils import Euler, Matrix
from pelage_blender import axes, meshes, particle_keys, surfaces
from pelage_blender.scene_folder import SceneFolder
from pelage_blender.scene_writer import SceneWriter


def written(frame_set=None):
    """The scene that goes to Pelage, and its folder."""
    folder = OUTPUT / f"scene{len(os.listdir(OUTPUT))}"
    folder.mkdir()
    return SceneWriter(SceneFolder(folder)).write(bpy.context.evaluated_depsgraph_get(), (32, 32), frame_set), folder


def points_of(path):
    return np.array([line.split()[1:4] for line in path.read_text().splitlines() if line.startswith("v ")], float)


def value_at(value, key):
    """The value of a block at a motion key, counted from 0."""
    return list(value["keys"].values())[key] if isinstance(value, dict) else value


def placed(points, transform, key=0):
    """Points of a mesh, as a character puts them into the scene."""
    turn = np.array(Euler(np.radians(value_at(transform["rotate"], key))).to_matrix())
    return points * value_at(transform.get("scale", 1), key) @ turn.T + value_at(transform["translate"], key)


def instances(ob, matrices):
    """Takes an object out of the scene, and puts instances of it there."""
    collection = bpy.data.collections.new("source")
    bpy.context.collection.objects.unlink(ob)
    collection.objects.link(ob)
    root, made = linked(bpy.data.objects.new("root", None), (0, 0, 0)), []
    for matrix in matrices:
        empty = bpy.data.objects.new("instance", None)
        empty.instance_type, empty.instance_collection = "COLLECTION", collection
        bpy.context.collection.objects.link(empty)
        empty.parent, empty.matrix_parent_inverse = root, matrix  # an object without parent cannot be sheared
        made.append(empty)
    bpy.context.view_layer.update()
    return made


def turned(x, scale, *angles):
    return Matrix.Translation((x, 0, 0)) @ Euler(angles).to_matrix().to_4x4() @ Matrix.Diagonal((*scale, 1))


SIMILAR = [turned(-1.5, (1, 1, 1), 0.1, 0.2, 0.3), turned(0, (0.5, 0.5, 0.5), 2, -1, 0.5), turned(1.5, (0.8, 0.8, 0.8), 0, 1.6, 3)]


class Instances(unittest.TestCase):
    def ball(self):
        empty_scene(32, 32).render.film_transparent = True
        set_world(1)
        camera((0, -6, 0))
        bpy.ops.mesh.primitive_uv_sphere_add(segments=12, ring_count=6, radius=0.5)
        bpy.ops.object.shade_smooth()
        return bpy.context.object

    def check_places(self, document, folder, ob, matrices):
        """Each matrix has a character whose mesh and transform give the points of the instance."""
        self.assertEqual(len(document["characters"]), len(matrices))
        local = meshes.vertices_of(ob.data)
        for matrix, character in zip(matrices, document["characters"].values()):
            points = points_of(folder / document["skins"][character["parts"][0]["skin"]]["mesh"])
            truth = axes.to_pelage(axes.transformed(local, matrix))
            np.testing.assert_allclose(placed(points, character["transform"]), truth, atol=1e-5)

    def test_instances_share_a_mesh(self):
        ball = self.ball()
        flat = turned(0, (1, 1, 0), 0, 0, 0)
        sheared = turned(0, (1, 2, 1), 0, 0, 0) @ turned(0, (1, 1, 1), 0, 0, 0.7)
        mirrored = turned(0, (-1, 1, 1), 0.4, 0, 0)
        for same in (SIMILAR, [turned(x, (1, 2, 3), x, 0, 0) for x in (0, 1)], [sheared, turned(1, (3, 3, 3), 1, 1, 1) @ sheared],
                     [mirrored, turned(0, (2, 2, 2), 1, 2, 3) @ mirrored]):
            made = instances(ball, same)
            document, folder = written()
            self.assertEqual([len(document["skins"]), len(list(folder.glob("*.obj")))], [1, 1])
            self.check_places(document, folder, ball, same)
            for empty in made:
                bpy.data.objects.remove(empty)
            bpy.context.collection.objects.link(ball)
        instances(ball, [flat, flat, sheared, mirrored, SIMILAR[0]])  # nothing in common: one mesh
        document, _ = written()
        self.assertEqual([list(document["characters"]), list(document["skins"])], [["scene"], ["grey"]])

    def test_a_thousand_instances_cost_one_mesh(self):
        ball = self.ball()
        instances(ball, [turned(i, (1 + 0.001 * i,) * 3, i, 0, 0) for i in range(1000)])
        document, folder = written()
        self.assertEqual([len(document["characters"]), len(document["skins"])], [1000, 1])
        self.assertLess(sum(path.stat().st_size for path in folder.iterdir()), 500_000)
        # A small mesh is repeated.
        with mock.patch.object(surfaces, "SHARED_FACES", len(ball.data.polygons) + 1):
            self.assertEqual(len(written()[0]["characters"]), 1)

    def test_shared_and_repeated_meshes_give_the_same_picture(self):
        ball = self.ball()
        ball.data.materials.append(None)
        ball.data.materials.append(bpy.data.materials.new("other"))
        for face in ball.data.polygons[:20]:
            face.material_index = 1
        made = instances(ball, SIMILAR)
        for frame, x in ((1, -1), (2, 0)):
            made[0].location.x, made[0].rotation_euler.y = x, x
            made[0].keyframe_insert("location", frame=frame)
            made[0].keyframe_insert("rotation_euler", frame=frame)
        bpy.context.scene.render.use_motion_blur = True
        shared = render(samples=4)
        with mock.patch.object(surfaces, "SHARED_FACES", 1 << 30):
            np.testing.assert_allclose(render()["A"], shared["A"], atol=0.01)  # rounding moves single samples of borders

    def test_a_moving_instance_turns_the_short_way(self):
        ball = self.ball()
        made = instances(ball, [Matrix(), *SIMILAR[1:]])
        for frame, angle in ((1, 170), (2, 190)):
            made[0].rotation_euler = (0, 0, math.radians(angle))
            made[0].keyframe_insert("rotation_euler", frame=frame)
        scene = bpy.context.scene
        scene.render.use_motion_blur, scene.render.motion_blur_shutter, scene.pelage.motion_keys = True, 2, 3
        document, folder = written(lambda frame, sub: scene.frame_set(frame, subframe=sub))
        moved, *still = document["characters"].values()
        angles = np.array([value_at(moved["transform"]["rotate"], key)[1] for key in range(3)])
        self.assertLess(np.abs(np.diff(angles)).max(), 21)
        self.assertTrue(all(isinstance(block["transform"]["rotate"], list) for block in still))
        points, local = points_of(folder / "Sphere.obj"), meshes.vertices_of(ball.data)
        for key, frame in enumerate((0, 1, 2)):
            scene.frame_set(frame)
            truth = axes.to_pelage(axes.transformed(local, made[0].matrix_world))
            np.testing.assert_allclose(placed(points, moved["transform"], key), truth, atol=1e-5)

    def test_instances_share_their_fur(self):
        ball = self.ball()
        bpy.ops.object.pelage_fur_add(preset="SHORT")
        ball.pelage.coats[0].strands = 200
        hairy(ball, 20)
        scales = [(1, 1, 1), (1, 1, 1), (2, 2, 2)]  # at rest, fur is as large as in the scene
        matrices = [turned(i, scale, i, 2 * i, 0) for i, scale in enumerate(scales)]
        instances(ball, matrices)
        document, folder = written()
        self.assertEqual([len(document["skins"]), len(document["grooms"])], [2, 4])  # a coat and particle hair of each size
        coats = {name: c for name, c in document["characters"].items() if "skin" in c["parts"][0]}
        self.assertEqual(len(document["characters"]), 6)
        self.check_places(document | {"characters": coats}, folder, ball, matrices)
        render(samples=1)

    def test_instances_of_particles_and_nodes_share_meshes(self):
        """Nodes instance two meshes under the name of one object."""
        ball = self.ball()
        bpy.ops.mesh.primitive_plane_add(location=(0, 0, 2))
        particles = hairy(bpy.context.object, 40)
        particles.render_type, particles.instance_object, particles.use_rotation_instance = "OBJECT", ball, True
        bpy.ops.mesh.primitive_grid_add(x_subdivisions=5, y_subdivisions=4)
        modifier = bpy.context.object.modifiers.new("nodes", "NODES")
        tree = modifier.node_group = bpy.data.node_groups.new("tree", "GeometryNodeTree")
        tree.inputs.new("NodeSocketGeometry", "Geometry")
        tree.outputs.new("NodeSocketGeometry", "Geometry")
        points, out = tree.nodes.new("NodeGroupInput"), tree.nodes.new("NodeGroupOutput")
        join = tree.nodes.new("GeometryNodeJoinGeometry")
        for kind in ("GeometryNodeMeshUVSphere", "GeometryNodeMeshIcoSphere"):
            mesh, on_points = tree.nodes.new(kind), tree.nodes.new("GeometryNodeInstanceOnPoints")
            if "Subdivisions" in mesh.inputs:
                mesh.inputs["Subdivisions"].default_value = 3
            tree.links.new(points.outputs[0], on_points.inputs["Points"])
            tree.links.new(mesh.outputs[0], on_points.inputs["Instance"])
            tree.links.new(on_points.outputs[0], join.inputs[0])
        tree.links.new(join.outputs[0], out.inputs[0])
        bpy.context.view_layer.update()
        document, folder = written()
        meshes_of = [document["skins"][character["parts"][0]["skin"]]["mesh"]
                     for name, character in document["characters"].items() if name != "scene"]
        self.assertEqual(sorted(collections.Counter(meshes_of).values()), [30, 30, 41])  # the ball itself is there, too


class Libraries(unittest.TestCase):
    def test_a_furry_object_of_another_file(self):
        """Its image is beside its own file, and its coats cannot be edited here."""
        empty_scene()
        folder = OUTPUT / "library"
        (folder / "maps").mkdir(parents=True)
        (folder / "maps" / "density.exr").write_bytes(exr.encode({"R": np.ones((4, 4), np.float32)}))
        bpy.ops.mesh.primitive_uv_sphere_add(segments=12, ring_count=6)
        ob = bpy.context.object
        bpy.ops.object.pelage_fur_add(preset="SHORT")
        coat = ob.pelage.coats[0]
        coat.strands, coat.use_density, coat.density.source = 200, True, "IMAGE"
        coat.density.image = bpy.data.images.load(str(folder / "maps" / "density.exr"))
        bpy.ops.wm.save_as_mainfile(filepath=str(folder / "animal.blend"))
        bpy.ops.file.make_paths_relative()
        bpy.ops.wm.save_mainfile()
        empty_scene(32, 32).render.film_transparent = True
        with bpy.data.libraries.load(str(folder / "animal.blend"), link=True) as (_, wanted):
            wanted.objects = ["Sphere"]
        bpy.context.collection.objects.link(wanted.objects[0])
        bpy.context.view_layer.objects.active = wanted.objects[0]
        camera()
        set_world(1)
        self.assertEqual(wanted.objects[0].pelage.coats[0].density.image.filepath_raw, "//maps/density.exr")
        density = next(iter(written()[0]["grooms"].values()))["density"]
        self.assertEqual(pathlib.Path(density["map"]), folder / "maps" / "density.exr")
        self.assertGreater(render(samples=1)["A"].mean(), 0.05)
        for operator in (bpy.ops.object.pelage_fur_add, bpy.ops.object.pelage_fur_remove, bpy.ops.object.pelage_operator_edit,
                         bpy.ops.object.pelage_value_set):
            self.assertFalse(operator.poll())


class ParticleKeys(unittest.TestCase):
    def test_a_layout_of_memory_with_other_points_is_noticed(self):
        keys = np.zeros((30, 5, 3), np.float32)
        system = mock.Mock()
        system.co_hair.return_value = (0, 0, 0)
        particle_keys._checked(None, system, range(30), keys, np.full(30, 4))
        for value in (1, np.nan):
            wrong = keys.copy()
            wrong[0, 2, 1] = value
            with self.assertRaises(OSError):
                particle_keys._checked(None, system, range(30), wrong, np.full(30, 4))


class Creases(unittest.TestCase):
    def cube(self):
        empty_scene(32, 32)
        camera()
        bpy.ops.mesh.primitive_cube_add()
        ob = bpy.context.object
        ob.modifiers.new("smooth", "SUBSURF").levels = 3
        for edge in ob.data.edges[:4]:
            edge.crease = 0.5
        return ob

    def test_a_creased_cage_is_a_cage(self):
        ob = self.cube()
        document, folder = written()
        skin = next(iter(document["skins"].values()))
        self.assertEqual(skin["scheme"], "catmull-clark")
        found = [line for line in (folder / skin["mesh"]).read_text().splitlines() if line.startswith("t ")]
        ends = [tuple(edge.vertices) for edge in ob.data.edges[:4]]
        self.assertEqual(found, [f"t crease 2/1/0 {a} {b} 2.5" for a, b in ends])
        ob.modifiers["smooth"].use_creases = False
        document, folder = written()
        self.assertNotIn("t crease", (folder / next(iter(document["skins"].values()))["mesh"]).read_text())


if __name__ == "__main__":
    run()
