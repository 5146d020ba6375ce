# SPDX-License-Identifier: Apache-2.0
"""A furry cube without any file, in a picture of 24 x 16 pixels."""
import struct
import zlib

import numpy as np

import pelage

CUBE = np.array([[x, y, z] for z in (-0.5, 0.5) for y in (-0.5, 0.5) for x in (-0.5, 0.5)], np.float32)
FACES = np.array([[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]])


def cube_obj():
    """The same cube as the text of an OBJ file."""
    lines = ["v %.9g %.9g %.9g" % tuple(point) for point in CUBE]
    return "\n".join(lines + ["f %d %d %d %d" % tuple(face + 1) for face in FACES]) + "\n"


def png_of(pixels):
    """The bytes of a PNG file with pixels (height, width, 3) of uint8."""
    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    header = struct.pack(">IIBBBBB", pixels.shape[1], pixels.shape[0], 8, 2, 0, 0, 0)
    rows = zlib.compress(b"".join(b"\0" + row.tobytes() for row in pixels))
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", rows) + chunk(b"IEND", b"")


def scene_values(mesh=None, **groom):
    """The scene as a dict. `mesh`: in place of the cube in memory. `groom`: more keys of the groom."""
    grown = {} if "strands_file" in groom else {"strands": 300, "points": 5}
    return {
        "pelage": 1,
        "camera": {"position": [1.5, 1, 4], "look_at": [0, 0, 0], "fov": 30},
        "image": {"width": 24, "height": 16},
        "skins": {"cube": {"mesh": pelage.Mesh(CUBE, FACES) if mesh is None else mesh, "scheme": "none"}},
        "grooms": {"coat": {"skin": "cube", **grown, **groom, "operators": [
            {"length": {"value": 0.4, "variation": 0.25}}, {"clump": {"spacing": 0.2, "amount": 0.5}},
            {"width": {"root": 0.02, "tip": 0.005}}] if grown else []}},
        "materials": {"hide": {"model": "lambert", "color": 0.4}, "fur": {"model": "chiang", "color": [0.6, 0.4, 0.2]}},
        "characters": {"one": {"parts": [{"skin": "cube", "material": "hide", "grooms": {"coat": "fur"}}]}},
        "lights": {"key": {"type": "sphere", "position": [5, 8, 5], "radius": 1.0, "intensity": 30},
                   "sky": {"type": "environment", "radiance": 0.3}},
        "render": {"samples": 1, "bounces": 2, "lod": {"enabled": False}},
    }


def same_layers(a, b):
    return list(a) == list(b) and all(np.array_equal(a[layer], b[layer]) for layer in a)
