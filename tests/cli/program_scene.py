# SPDX-License-Identifier: Apache-2.0
"""A furry cube for tests that run the program, and how they run it."""
import pathlib
import struct
import subprocess
import tempfile
import unittest

SCENE = """pelage: 1
camera: {position: [3, 2, 8], look_at: [0, 0, 0], fov: 40, shutter: [-0.25, 0.25]}
image: {width: 24, height: 16}
skins: {cube: {mesh: cube.obj}}
grooms:
  coat:
    skin: cube
    strands: 400
    points: 5
    operators: [{length: {value: 0.4}}, {width: {root: 0.02, tip: 0.005}}]
materials:
  hide: {model: lambert, color: 0.4}
  fur: {model: cone-shell, color: [0.6, 0.4, 0.2], diffuse: 0.6}
characters: {box: {parts: [{skin: cube, material: hide, grooms: {coat: fur}}]}}
lights: {sky: {type: environment, radiance: 0.3}}
render: {samples: 2, bounces: 1}
"""
CUBE = "\n".join(f"v {x} {y} {z}" for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)) + """
f 1 3 4 2
f 5 6 8 7
f 1 2 6 5
f 3 7 8 4
f 1 5 7 3
f 2 4 8 6
"""


def exr_pixels(path):
    """The compressed pixels of an EXR file, without its header."""
    data, at = path.read_bytes(), 8
    while data[at]:  # attributes: name, type, size, value
        at = data.index(0, data.index(0, at) + 1) + 1
        at += 4 + struct.unpack_from("<i", data, at)[0]
    first, = struct.unpack_from("<Q", data, at + 1)  # of the table of offsets
    assert at < first < len(data), (at, first, len(data))
    return data[first:]


class ProgramTest(unittest.TestCase):
    """Each test has a folder of its own with scene.yaml and cube.obj; PELAGE is the program."""
    PELAGE = None

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = pathlib.Path(folder.name)
        (self.path / "scene.yaml").write_text(SCENE)
        (self.path / "cube.obj").write_text(CUBE)

    def start(self, *arguments, **options):
        options = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True, **options}
        process = subprocess.Popen([self.PELAGE, *map(str, arguments)], cwd=self.path, **options)
        self.addCleanup(process.__exit__, None, None, None)
        self.addCleanup(process.kill)
        return process

    def run_pelage(self, *arguments, code=0, **options):
        process = self.start(*arguments, **options)
        out, err = process.communicate(timeout=240)
        self.assertEqual(process.returncode, code, err)
        return out, err

    def render(self, *arguments, code=0, **options):
        return self.run_pelage("render", "scene.yaml", "--quiet", *arguments, code=code, **options)

    def names(self):
        return sorted(p.name for p in self.path.iterdir())
