# SPDX-License-Identifier: Apache-2.0
"""Makes a ball, curls on it and a scene from numpy alone, and renders them. numpy_groom.py [PICTURE [WIDTH]]"""
import sys

import numpy as np
import pelage


def ball(rows: int = 12) -> pelage.Mesh:
    """A unit sphere of quads, without its poles."""
    height, turn = np.meshgrid(np.linspace(-0.99, 0.99, rows + 1), np.arange(2 * rows) * np.pi / rows, indexing="ij")
    ring = np.sqrt(1 - height**2)
    points = np.stack([ring * np.cos(turn), height, ring * np.sin(turn)], axis=-1).reshape(-1, 3)
    i = np.arange(rows * 2 * rows)
    right = i // (2 * rows) * 2 * rows + (i + 1) % (2 * rows)
    return pelage.Mesh(points, np.stack([i, i + 2 * rows, right + 2 * rows, right], axis=-1))


def curls(count: int = 6000, points: int = 24) -> pelage.Strands:
    """Strands that leave the sphere and wind about their own axis, in two colours."""
    random = np.random.default_rng(1)
    out = random.normal(size=(count, 3))
    out /= np.linalg.norm(out, axis=1, keepdims=True)
    across = np.cross(out, [0.3, 1, 0.2])
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    along = np.linspace(0, 1, points)[:, None]
    angle = (random.random((count, 1, 1)) + 1.5 * along) * 2 * np.pi
    radius = 0.12 * along
    curves = (1 + 0.5 * along) * out[:, None] + radius * (
        np.cos(angle) * across[:, None] + np.sin(angle) * np.cross(out, across)[:, None])
    color = np.where(out[:, 1:2] > 0.2, [[0.7, 0.35, 0.1]], [[0.25, 0.1, 0.05]])
    widths = np.broadcast_to(0.012 * (1 - 0.7 * along[:, 0]), (count, points))
    return pelage.Strands(curves, widths=widths, attributes={"color": color})


def scene(width: int) -> pelage.Scene:
    return pelage.Scene({
        "camera": {"position": [0, 1, 6], "look_at": [0, 0, 0], "fov": 34},
        "image": {"width": width, "height": width * 3 // 4},
        "skins": {"ball": {"mesh": ball()}},
        "grooms": {"curls": {"skin": "ball", "strands_file": curls()}},
        "materials": {"skin": {"model": "lambert", "color": [0.2, 0.1, 0.05]},
                      "hair": {"model": "chiang", "color": {"attribute": "color"}}},
        "characters": {"poodle": {"parts": [{"skin": "ball", "material": "skin", "grooms": {"curls": "hair"}}]}},
        "lights": {"key": {"type": "sphere", "position": [4, 6, 5], "radius": 1.5, "intensity": 12},
                   "sky": {"type": "environment", "radiance": 0.5, "visible": False}},
        "render": {"samples": 8, "bounces": 3},
    })


if __name__ == "__main__":
    picture = scene(int(sys.argv[2]) if len(sys.argv) > 2 else 320).render(
        output=sys.argv[1] if len(sys.argv) > 1 else "numpy_groom.png")
    print(picture, f"{picture.stats['wall_s']:.1f} s")
