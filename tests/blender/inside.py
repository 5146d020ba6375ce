# SPDX-License-Identifier: Apache-2.0
"""Helpers of the tests that run inside Blender: the add-on, small scenes, pictures as arrays."""
import atexit
import math
import os
import pathlib
import shutil
import sys
import tempfile
import unittest

import bpy
import numpy as np
from mathutils import Vector

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "integrations" / "blender"))
import pelage_blender  # noqa: E402
from pelage_blender import exr, temporary_folders  # noqa: E402

OUTPUT = pathlib.Path(tempfile.mkdtemp(prefix="pelage-test-"))
atexit.register(shutil.rmtree, OUTPUT, ignore_errors=True)
shots = 0


def run():
    """Runs the tests of the main module, or those that the arguments name; the exit code of Blender says how they went."""
    pelage_blender.register()
    import __main__
    names = sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else []
    loader = unittest.defaultTestLoader
    suite = loader.loadTestsFromNames(names, __main__) if names else loader.loadTestsFromModule(__main__)
    result = unittest.TextTestRunner(verbosity=2).run(suite)
    sys.stdout.flush()
    sys.exit(0 if result.wasSuccessful() else 1)


def left_folders():
    """Folders that the add-on of this process has left behind."""
    mine = f"{temporary_folders.owner_prefix()}{os.getpid()}-"
    return [name for name in os.listdir(tempfile.gettempdir()) if name.startswith(mine)]


def empty_scene(width=48, height=48, new=True):
    """A scene without objects and light; with a window, Blender cannot make a new one from a timer."""
    if new:
        bpy.ops.wm.read_homefile(use_factory_startup=True)
    for ob in list(bpy.data.objects):
        bpy.data.objects.remove(ob)
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = width, height, 100
    set_world(0)
    scene.render.engine = "PELAGE"
    scene.pelage.samples = 16
    scene.cycles.use_denoising = False
    scene.cycles.use_adaptive_sampling = False
    return scene


def set_world(strength, color=(1, 1, 1)):
    inputs = bpy.context.scene.world.node_tree.nodes["Background"].inputs
    inputs["Strength"].default_value = strength
    inputs["Color"].default_value = (*color, 1)


def linked(ob, location, target=None):
    bpy.context.collection.objects.link(ob)
    ob.location = location
    if target is not None:
        ob.rotation_euler = (Vector(target) - Vector(location)).to_track_quat("-Z", "Y").to_euler()
    return ob


def camera(location=(0, -5, 2), target=(0, 0, 0), name="camera"):
    ob = linked(bpy.data.objects.new(name, bpy.data.cameras.new(name)), location, target)
    bpy.context.scene.camera = ob
    return ob


def light(kind, location=(1, 0, 2), target=(0, 0, 0), name="light", **values):
    data = bpy.data.lights.new(name, kind)
    for key, value in values.items():
        setattr(data, key, value)
    return linked(bpy.data.objects.new(name, data), location, target)


def material(shader="ShaderNodeBsdfDiffuse", name="grey", **inputs):
    result = bpy.data.materials.new(name)
    result.use_nodes = True
    tree = result.node_tree
    tree.nodes.clear()
    node, output = tree.nodes.new(shader), tree.nodes.new("ShaderNodeOutputMaterial")
    tree.links.new(node.outputs[0], output.inputs["Surface"])
    for key, value in inputs.items():
        node.inputs[key].default_value = value
    return result


def grey_plane(size=4.0, color=0.5):
    bpy.ops.mesh.primitive_plane_add(size=size)
    bpy.context.object.data.materials.append(material(Color=(color, color, color, 1)))
    return bpy.context.object


def hairy(ob, count=300, length=0.4, slot=1, **values):
    """Adds particle hair to an object."""
    ob.modifiers.new("hair", "PARTICLE_SYSTEM")
    settings = ob.particle_systems[-1].settings
    settings.type, settings.count, settings.hair_length, settings.material = "HAIR", count, length, slot
    for key, value in values.items():
        setattr(settings, key, value)
    bpy.context.view_layer.update()
    return settings


def new_path(ending):
    global shots
    shots += 1
    return OUTPUT / f"{shots}.{ending}"


def render(engine=None, samples=None, multilayer=False, animation=False):
    """Renders the scene; returns the channels of the picture by name, top row first.

    With `animation`: one such dict per frame.
    """
    scene = bpy.context.scene
    scene.render.engine = engine or scene.render.engine
    if samples is not None:
        scene.cycles.samples = scene.pelage.samples = samples
    settings = scene.render.image_settings
    settings.file_format = "OPEN_EXR_MULTILAYER" if multilayer else "OPEN_EXR"
    settings.color_depth, settings.exr_codec, settings.color_mode = "32", "ZIP", "RGBA"
    if animation:
        path = new_path("####.exr")
        scene.render.filepath = str(path)
        bpy.ops.render.render(animation=True)
        frames = range(scene.frame_start, scene.frame_end + 1)
        return [exr.read(str(path).replace("####", f"{frame:04d}"))[1] for frame in frames]
    path = new_path("exr")
    scene.render.filepath = str(path)
    bpy.ops.render.render(write_still=True)
    return exr.read(path)[1]


def mean(picture):
    return float(np.mean([picture[c].mean() for c in "RGB"]))


def radians(*angles):
    return tuple(math.radians(a) for a in angles)
