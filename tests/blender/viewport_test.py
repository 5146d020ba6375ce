# SPDX-License-Identifier: Apache-2.0
"""The viewport, with a window: pictures while one looks, edits, undo, and what is left when it closes.

Timers run the steps, because Blender draws between them. A failed step ends Blender with code 1.
"""
import os
import pathlib
import signal
import subprocess
import sys
import time
import traceback
from unittest import mock

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import bpy
import inside
import numpy as np
from inside import light, pelage_blender
from pelage_blender import viewport_sessions

PATIENCE_S = 80
pelage_blender.register()


def area():
    return next(a for a in bpy.context.window_manager.windows[0].screen.areas if a.type == "VIEW_3D")


def session():
    found = list(viewport_sessions._sessions)
    return found[0] if found else None


def finished():
    """Whether the picture of the present edit is complete."""
    current = session()
    if current is None or current.client is None or current.client.picture is None:
        return False
    assert not current.status().startswith("pelage") or "timed out" in current.status(), current.status()
    state, picture = current.client.state, current.client.picture
    return state.get("done") and picture.version == state["version"] and current.shown == picture.version


def children(parent):
    """Numbers of the programs pelage that a process runs."""
    listed = subprocess.run(["ps", "-o", "pid=,comm=", "--ppid", str(parent)], stdout=subprocess.PIPE, text=True, check=True)
    return [int(line.split()[0]) for line in listed.stdout.splitlines() if line.split()[1].startswith("pelage")]


def seen(x, y):
    """Colour of the window at fractions of the viewport."""
    path = str(inside.new_path("png"))
    bpy.ops.screen.screenshot(filepath=path)
    image = bpy.data.images.load(path)
    image.colorspace_settings.name = "Non-Color"
    width, height = image.size
    pixels = np.empty(width * height * 4, np.float32)
    image.pixels.foreach_get(pixels)
    bpy.data.images.remove(image)
    region = next(r for r in area().regions if r.type == "WINDOW")
    return pixels.reshape(height, width, 4)[region.y + int(y * region.height), region.x + int(x * region.width), :3]


def steps():
    """Each `yield` waits until the function that it gives is true."""
    scene = inside.empty_scene(new=False)
    scene.pelage.viewport_samples, scene.pelage.bounces = 1, 0
    scene.pelage.integrator = "path"  # the cheapest for one sample
    scene.pelage.lod = False  # with level of detail, strands follow the camera
    scene.view_settings.view_transform = "Standard"
    inside.set_world(0.5)
    space = area().spaces[0]
    space.overlay.show_overlays = space.show_gizmo = space.show_region_toolbar = False
    space.region_3d.view_location, space.region_3d.view_distance = (0, 0, 0), 6
    bpy.ops.mesh.primitive_uv_sphere_add(segments=16, ring_count=8)
    space.shading.type = "RENDERED"
    area().tag_redraw()
    yield finished
    first = session()
    folder, process = first.folder, first.client.process
    assert os.path.isdir(folder)
    # The world of 0.5 is 188 of 255 in sRGB, and the ball reflects 0.8 of it.
    for place, linear, noise in (((0.05, 0.05), 0.5, 0.005), ((0.5, 0.5), 0.4, 0.08)):  # one sample
        expected = 1.055 * linear ** (1 / 2.4) - 0.055
        np.testing.assert_allclose(seen(*place), expected, atol=noise)

    bpy.ops.ed.undo_push(message="before")
    bpy.ops.object.pelage_fur_add(preset="SHORT")
    bpy.context.object.pelage.coats[0].strands = 500
    bpy.ops.ed.undo_push(message="strands")
    yield lambda: session().client.state.get("edits", 0) >= 1 and finished()
    assert session() is first
    assert len(first.document["grooms"]) == 1

    edits = first.client.state["edits"]
    comb = next(o for o in bpy.context.object.pelage.coats[0].operators if o.kind == "comb")
    comb["lift"] = 0.9
    bpy.context.object.update_tag()
    yield lambda: first.client.state["edits"] > edits and finished()
    assert 0 < first.client.state["strands_regrown"] <= 500, first.client.state

    edits = first.client.state["edits"]
    light("SUN", energy=3)
    space.region_3d.view_distance = 4
    area().tag_redraw()
    yield lambda: first.client.state["edits"] > edits and finished()
    assert first.client.state["strands_regrown"] == 0, first.client.state["strands_regrown"]

    with bpy.context.temp_override(window=bpy.context.window_manager.windows[0], area=area()):
        bpy.ops.ed.undo()
        while len(bpy.data.objects["Sphere"].pelage.coats):
            bpy.ops.ed.undo()  # until before the coat; Blender says when there is nothing left
        bpy.ops.ed.redo()
        assert len(bpy.data.objects["Sphere"].pelage.coats) == 1
    yield finished
    assert session() is first  # the program is still the same

    coat = bpy.data.objects["Sphere"].pelage.coats[0]
    coat.use_density, coat.density.group = True, "gone"
    bpy.data.objects["Sphere"].update_tag()
    yield lambda: "'gone'" in session().status()
    coat.use_density = False
    bpy.data.objects["Sphere"].update_tag()
    yield lambda: not session().problem and finished()
    # A class: the traceback of a single exception would keep the engine alive.
    with mock.patch.object(type(first), "follow_view", side_effect=RuntimeError) as failing:
        area().tag_redraw()
        yield lambda: failing.called
        drawn, since = failing.call_count, time.monotonic()
        yield lambda: time.monotonic() - since > 0.5
        assert failing.call_count - drawn < 5, failing.call_count  # Blender does not draw again and again
    area().tag_redraw()
    yield finished
    assert session() is first and first.client.process is process
    os.kill(children(process.pid)[0], signal.SIGSEGV)
    yield lambda: first.client.ended and "signal 11" in session().status()
    bpy.data.objects["Sphere"].update_tag()  # an edit starts the program again
    yield lambda: first.client.process is not process and finished()
    process = first.client.process

    space.shading.type = "SOLID"
    yield lambda: session() is None
    assert process.poll() is not None and not os.path.exists(folder)
    space.shading.type = "RENDERED"  # Blender ends while this one renders
    yield lambda: session() is not None and session().client is not None
    print("pelage viewport test: folder", session().folder, "process", session().client.process.pid, flush=True)


running = None
waiting = lambda: True
began = time.monotonic()


def tick():
    global running, waiting, began
    try:
        if running is None:
            running = steps()
        if waiting():
            waiting, began = next(running), time.monotonic()
            print("pelage viewport test: next step", flush=True)
        elif time.monotonic() - began > PATIENCE_S:
            current = session()
            raise AssertionError(f"nothing happens: {current and current.status()} {current and current.client.state}")
    except StopIteration:
        print("pelage viewport test: passed", flush=True)
        bpy.ops.wm.quit_blender()
        return None
    except Exception:
        traceback.print_exc()
        sys.stdout.flush()
        viewport_sessions.close_all()
        os._exit(1)
    return 0.05


bpy.context.preferences.view.show_splash = False
bpy.app.timers.register(tick, first_interval=0.5)
