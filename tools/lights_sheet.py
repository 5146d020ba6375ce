#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Renders the pictures of docs/LIGHTS.md: the same coat in each kind of light, and a room with and without a magnet.

    tools/lights_sheet.py PELAGE

PELAGE is the program, build/release/bin/pelage. Needs oiiotool.
"""
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[1]
IMAGES = ROOT / "docs" / "images"
SIZE = 180

COAT = """pelage: 1
camera: {{position: [0, 2.4, 5.6], look_at: [0, 0.35, 0], fov: 27}}
image: {{width: {size}, height: {size}, light_layers: false}}
skins: {{patch: {{mesh: {examples}/patch.obj}}}}
grooms:
  coat:
    skin: patch
    strands: 9000
    points: 12
    seed: 3
    operators:
      - length: {{value: 0.5}}
      - comb: {{direction: [1, 0, 0.3], lift: 0.5}}
      - clump: {{spacing: 0.25, amount: 0.6}}
      - width: {{root: 0.016, tip: 0.006}}
materials:
  hide: {{model: lambert, color: [0.35, 0.28, 0.24]}}
  fur: {{model: lambert-cylinder, color: [0.6, 0.4, 0.24]}}
characters: {{patch: {{parts: [{{skin: patch, material: hide, grooms: {{coat: fur}}}}]}}}}
lights:
  light: {light}
  fill: {{type: environment, radiance: [0.03, 0.035, 0.045], visible: false}}
render: {{samples: 64, bounces: 3, lod: {{enabled: false}}}}
"""
LIGHTS = [
    "{type: rectangle, position: [-4, 5, 3], look_at: [0, 0.3, 0], size: [3, 3], radiance: 9}",
    "{type: disk, position: [-4, 5, 3], look_at: [0, 0.3, 0], radius: 1.7, power: 260}",
    "{type: sphere, position: [-2.2, 1.6, 1], radius: 0.5, power: 150, temperature: 4000}",
    "{type: point, position: [-1.2, 1.6, 1.4], power: 70, temperature: 2700}",
    "{type: spot, position: [-2, 6, 2], look_at: [0, 0.3, 0], power: 4500, cone: 16, softness: 0.4}",
    "{type: spot, position: [-2, 6, 2], look_at: [0, 0.3, 0], power: 4500, cone: 26, file: GOBO}",
    "{type: sun, direction: [2, -1.1, -0.6], irradiance: 3.5, temperature: 5000}",
    "{type: mesh, file: TUBES, power: 220, temperature: 9000}",
    "{type: rectangle, position: [-4, 5, 3], look_at: [0, 0.3, 0], size: [0.5, 0.5], spread: 14, power: 4}",
    "{type: rectangle, position: [-2.4, 3, 1.8], look_at: [0, 0.3, 0], size: [0.6, 0.6], power: 330, "
    "barn_doors: {length: 1, left: -5, right: -5, top: 60, bottom: 60}}",
    "{type: point, position: [0, 1.75, 0], profile: PROFILE, power: 14, temperature: 3000}",
    "{type: environment, file: SKY, rotate: [0, 60, 0], intensity: 1, visible: false}",
]

ROOM = """pelage: 1
camera: {{position: [0, 1.2, 2.8], look_at: [0, 0.6, 0], fov: 50}}
image: {{width: {size}, height: {size}, light_layers: false}}
skins:
  room: {{mesh: ROOM, scheme: none}}
  patch: {{mesh: {examples}/patch.obj, transform: {{scale: 0.5, translate: [0, 0.02, 0]}}}}
grooms:
  coat:
    skin: patch
    strands: 4000
    points: 8
    seed: 3
    operators: [{{length: {{value: 0.35}}}}, {{comb: {{direction: [1, 0, 0.3], lift: 0.5}}}}, {{width: {{root: 0.012, tip: 0.005}}}}]
materials:
  wall: {{model: lambert, color: 0.75}}
  fur: {{model: lambert-cylinder, color: [0.62, 0.4, 0.22]}}
characters:
  room: {{parts: [{{skin: room, material: wall}}, {{skin: patch, material: wall, grooms: {{coat: fur}}}}]}}
lights:
  sky: {{type: environment, radiance: [22, 25, 30]}}
{magnets}render: {{samples: {samples}, bounces: 4, integrator: {integrator}, seed: {seed}, lod: {{enabled: false}}}}
"""
MAGNET = """magnets:
  window: {type: rectangle, position: [-3, 1.75, 0], look_at: [0, 1.75, 0], size: [0.8, 0.5]}
"""


def write_room(path):
    """A closed room of 6 x 3 x 6 whose left wall has a window of 0.8 x 0.5."""
    lines, count = [], 0

    def face(*corners):
        nonlocal count
        lines.extend(f"v {x} {y} {z}" for x, y, z in corners)
        lines.append("f " + " ".join(str(count + i + 1) for i in range(4)))
        count += 4

    face((-3, 0, 3), (3, 0, 3), (3, 0, -3), (-3, 0, -3))
    face((-3, 3, -3), (3, 3, -3), (3, 3, 3), (-3, 3, 3))
    face((-3, 0, -3), (3, 0, -3), (3, 3, -3), (-3, 3, -3))
    face((3, 0, 3), (-3, 0, 3), (-3, 3, 3), (3, 3, 3))
    face((3, 0, -3), (3, 0, 3), (3, 3, 3), (3, 3, -3))
    for z0, z1, y0, y1 in ((-3, -0.4, 0, 3), (0.4, 3, 0, 3), (-0.4, 0.4, 0, 1.5), (-0.4, 0.4, 2, 3)):
        face((-3, y0, z1), (-3, y0, z0), (-3, y1, z0), (-3, y1, z1))
    path.write_text("\n".join(lines) + "\n")


def write_tubes(path):
    """Two tubes of six sides along z."""
    lines, count = [], 0
    ring = [(1, 0), (0.5, 0.866), (-0.5, 0.866), (-1, 0), (-0.5, -0.866), (0.5, -0.866)]
    for center in (-1.1, 0.9):
        for z in (-1.4, 1.4):
            lines.extend(f"v {center + 0.06 * x} {1.5 + 0.06 * y} {z}" for x, y in ring)
        for i in range(6):
            j = (i + 1) % 6
            lines.append(f"f {count + i + 1} {count + j + 1} {count + j + 7} {count + i + 7}")
        count += 12
    path.write_text("\n".join(lines) + "\n")


def write_profile(path):
    """A luminaire with a narrow bright beam and a ring around it."""
    angles = [0, 8, 12, 20, 30, 36, 42, 48, 90]
    candela = [1000, 1000, 300, 60, 40, 400, 400, 40, 0]
    numbers = [1, -1, 1, len(angles), 1, 1, 2, 0, 0, 0, 1, 1, 50, *angles, 0, *candela]
    path.write_text("IESNA:LM-63-1995\nTILT=NONE\n" + "\n".join(map(str, numbers)) + "\n")


def write_sky(path):
    """A blue sky with an orange glow at the centre column, above a dark ground, in linear colours."""
    half = ["oiiotool", "--pattern", "fill:topleft=0.1,0.15,0.3:topright=0.1,0.15,0.3:bottomleft=0.5,0.6,0.75:bottomright=0.5,0.6,0.75",
            "128x32", "3", "--pattern", "fill:color=0.1,0.09,0.08", "128x32", "3", "--mosaic", "1x2"]
    glow = ["--create", "128x64", "3", "--box:color=1,0.85,0.6:fill=1", "52,16,76,30", "--blur", "9x9"]
    subprocess.run([*half, *glow, "--mulc", "6", "--add", "-d", "float", "-o", path], check=True)


def render(pelage, text, folder, name):
    files = {"GOBO": "gobo.png", "TUBES": "tubes.obj", "ROOM": "room.obj", "PROFILE": "lamp.ies", "SKY": "sky.exr"}
    for key, value in files.items():
        text = text.replace(key, str(folder / value))
    (folder / "scene.yaml").write_text(text)
    subprocess.run([pelage, "render", folder / "scene.yaml", "-o", folder / (name + ".exr"), "--quiet"], check=True)
    subprocess.run([ROOT / "tools" / "exr_to_png", folder / (name + ".exr"), folder / (name + ".png")], check=True)
    return folder / (name + ".png")


def mosaic(pictures, columns, path, quality):
    rows = len(pictures) // columns
    subprocess.run(["oiiotool", "--nosoftwareattrib", *map(str, pictures), f"--mosaic:pad=4", f"{columns}x{rows}",
                    "--ch", "R,G,B", "--compression", f"jpeg:{quality}", "-o", path], check=True)
    subprocess.run([sys.executable, ROOT / "tools" / "pictures.py", path], check=True)


def main(pelage):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        write_room(folder / "room.obj")
        write_tubes(folder / "tubes.obj")
        write_profile(folder / "lamp.ies")
        write_sky(folder / "sky.exr")
        subprocess.run(["oiiotool", "--pattern", "checker:width=32:height=256:color1=0.02,0.02,0.02:color2=1,1,1",
                        "256x256", "3", "-d", "uint8", "-o", folder / "gobo.png"], check=True)
        lights = [render(pelage, COAT.format(size=SIZE, examples=ROOT / "examples", light=light), folder, f"light{i}")
                  for i, light in enumerate(LIGHTS)]
        mosaic(lights, 4, IMAGES / "lights.jpg", 74)
        room = {"size": SIZE, "examples": ROOT / "examples", "samples": 64, "integrator": "path", "seed": 1}
        rooms = [render(pelage, ROOM.format(magnets=magnets, **room), folder, f"room{i}")
                 for i, magnets in enumerate(("", MAGNET))]
        mosaic(rooms, 2, IMAGES / "magnets.jpg", 80)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(pathlib.Path(sys.argv[1]).resolve())
