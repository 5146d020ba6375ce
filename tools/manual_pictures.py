#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Renders the pictures of docs/MANUAL.md: one per operator and field, each before and after.

    tools/manual_pictures.py PELAGE [SECTION...]

PELAGE is the program, build/release/bin/pelage. The right half of a picture shows the example of the section, as the
manual prints it; the left half shows the same groom without it. docs/images/manual/pictures.txt records the hash of
the scenes of each picture, and a test compares it with the manual of today. Needs oiiotool.
"""
import hashlib
import pathlib
import re
import struct
import subprocess
import sys
import tempfile
import zlib

ROOT = pathlib.Path(__file__).resolve().parents[1]
FOLDER = ROOT / "docs" / "images" / "manual"
RECORD = FOLDER / "pictures.txt"
SIZE = 132  # pixels of each half
GAP = 4
COLORS = 24  # of the palette: a picture takes 20 kB at most

SCENE = """pelage: 1
camera: {{position: {position}, look_at: {look_at}, fov: 29}}
image: {{width: {size}, height: {size}}}
skins: {{patch: {{mesh: patch.obj}}}}
{regions}grooms:
  coat:
    skin: patch
    strands: {strands}
    points: 24
    seed: 3
    operators:
{operators}
materials:
  hide: {{model: lambert, color: [0.35, 0.28, 0.24]}}
  fur: {{model: lambert-cylinder, color: {color}}}
characters:
  patch: {{parts: [{{skin: patch, material: hide, grooms: {{coat: fur}}}}]}}
lights:
  key: {{type: rectangle, position: [-4, 7, 5], look_at: [0, 0.5, 0], size: [3, 3], intensity: 14}}
  sky: {{type: environment, intensity: 0.5, visible: false}}
render: {{samples: 48, bounces: 2, lod: {{enabled: false}}}}
"""
FUR = "[0.62, 0.36, 0.16]"
LENGTH = "- length: {value: 0.9}"
BENT = LENGTH + "\n- comb: {direction: [1, 0, 0], lift: 0.1}\n- bend: {direction: [0, -1, 0], angle: 120}"
WIDTH = "- width: {root: 0.03, tip: 0.012}"

ABOVE = {"position": "[0, 4.2, 5]", "look_at": "[0, 0.3, 0]", "strands": 800}

# Sections with a picture: the operators of the left half, and settings of both.
PICTURES = {
    "map field": {"before": "- length: {value: {map: length.png, channel: r, range: [0.1, 1]}}", **ABOVE},
    "ramp field": {"before": LENGTH, **ABOVE},
    "noise field": {"before": LENGTH, **ABOVE},
    "attribute field": {"before": LENGTH + "\n- clump: {spacing: 0.5, amount: 0.8}\n- color: {value: 0.5}",
                        "first": LENGTH, "strands": 2000, "color": "{attribute: color}"},
    "product field": {"before": "- length: {value: {ramp: {along: x, knots: [[-1.5, 0.15], [1.5, 1]]}}}", **ABOVE},
    "length": {"before": "- length: {value: 0.8}"},
    "add field": {"before": "- length: {value: {ramp: {along: x, knots: [[-1.5, 0.15], [1.5, 1]]}}}", **ABOVE},
    "min field": {"before": "- length: {value: {ramp: {along: x, knots: [[-1.5, 0.15], [1.5, 1]]}}}", **ABOVE},
    "mix field": {"before": LENGTH + "\n- color: {value: [0.3, 0.18, 0.1]}", "first": LENGTH, **ABOVE, "strands": 2000,
                  "color": "{attribute: color}"},
    "sphere field": {"before": LENGTH, **ABOVE},
    "distance field": {"before": "- length: {value: 0.5}", **ABOVE},
    "height field": {"before": LENGTH, **ABOVE},
    "region field": {"before": "- length: {value: 0.4}", "first": "- length: {value: 0.4}",
                     "regions": "regions: {spots: {threshold: {noise: {frequency: 1.5}}, at: 0}}\n", **ABOVE},
    "operator mask": {"before": LENGTH + "\n- comb: {direction: [1, 0, 0], lift: 0.1}", "first": LENGTH},
    "comb": {"before": LENGTH, "first": LENGTH},
    "part": {"before": LENGTH, "first": LENGTH, **ABOVE, "strands": 900},
    "swirl": {"before": LENGTH, "first": LENGTH, **ABOVE, "strands": 900},
    "wet": {"before": LENGTH, "first": LENGTH, "strands": 2500},
    "braid": {"before": LENGTH, "first": LENGTH, "strands": 1500},
    "avoid": {"before": LENGTH, "first": LENGTH, **ABOVE, "strands": 900},
    "bend": {"before": LENGTH, "first": LENGTH},
    "clump": {"before": LENGTH, "first": LENGTH, "strands": 2000},
    "curl": {"before": LENGTH, "first": LENGTH, "strands": 150},
    "frizz": {"before": LENGTH, "first": LENGTH, "strands": 150},
    "noise": {"before": LENGTH, "first": LENGTH},
    "guides": {"before": LENGTH, "first": LENGTH},
    "push_out": {"before": BENT, "first": LENGTH, **ABOVE, "strands": 120},
    "width": {"before": LENGTH + "\n- width: {root: 0.012, tip: 0.004}", "first": LENGTH, "strands": 150},
    "color": {"before": LENGTH + "\n- color: {value: [0.6, 0.35, 0.15]}", "first": LENGTH,
              "color": "{attribute: color}"},
}


def example_operators(manual, section):
    """The operators of the example of a section, without their indentation."""
    text = re.search(rf"^## {re.escape(section)}\n(.*?)(?=^## |\Z)", manual, re.MULTILINE | re.DOTALL).group(1)
    example = re.search(r"```yaml\n(.*?)\n```", text, re.DOTALL).group(1)
    return "\n".join(line[6:] for line in example.split("    operators:\n")[1].splitlines())


def scene(operators, settings):
    if "width:" not in operators:
        operators += "\n" + WIDTH
    return SCENE.format(size=SIZE, strands=settings.get("strands", 600), color=settings.get("color", FUR),
                        regions=settings.get("regions", ""),
                        position=settings.get("position", "[0, 2.1, 5.6]"),
                        look_at=settings.get("look_at", "[0, 0.55, 0]"),
                        operators="\n".join("      " + line for line in operators.splitlines()))


def scenes(manual, section):
    """The scenes of the left and the right half."""
    settings = PICTURES[section]
    after = example_operators(manual, section)
    return scene(settings["before"], settings), scene("\n".join(filter(None, [settings.get("first"), after])), settings)


def scene_hash(manual, section):
    return hashlib.sha256("\0".join(scenes(manual, section)).encode()).hexdigest()


def picture_path(section):
    return FOLDER / (section.replace(" ", "_") + ".png")


def recorded():
    """Hash of the scenes by section, as the last run wrote them."""
    return dict(line.rsplit(" ", 1) for line in RECORD.read_text().splitlines()) if RECORD.exists() else {}


def render(pelage, text, folder):
    """Rows of RGB pixels of a scene."""
    (folder / "scene.yaml").write_text(text)
    subprocess.run([pelage, "render", folder / "scene.yaml", "-o", folder / "half.exr", "--quiet"], check=True)
    subprocess.run([ROOT / "tools" / "exr_to_png", folder / "half.exr", folder / "half.png"], check=True)
    subprocess.run(["oiiotool", folder / "half.png", "--ch", "R,G,B", "-o", folder / "half.ppm"], check=True)
    data = (folder / "half.ppm").read_bytes()
    pixels = data[-3 * SIZE * SIZE:]
    return [[tuple(pixels[3 * (y * SIZE + x):3 * (y * SIZE + x) + 3]) for x in range(SIZE)] for y in range(SIZE)]


def palette_of(pixels):
    """Median cut: the colours of at most COLORS boxes that hold equally many pixels."""
    boxes = [sorted(pixels)]
    while len(boxes) < COLORS:
        spans = [max(max(p[c] for p in box) - min(p[c] for p in box) for c in range(3)) * len(box) ** 0.5
                 for box in boxes]
        widest = max(range(len(boxes)), key=spans.__getitem__)
        if spans[widest] == 0:
            break
        box = boxes.pop(widest)
        channel = max(range(3), key=lambda c: max(p[c] for p in box) - min(p[c] for p in box))
        box.sort(key=lambda p: p[channel])
        half = len(box) // 2
        boxes += [box[:half], box[half:]]
    return [tuple(sum(p[c] for p in box) // len(box) for c in range(3)) for box in boxes]


def write_png(path, rows):
    """A PNG with a palette and nothing but its size and pixels."""
    palette = palette_of([pixel for row in rows for pixel in row])
    nearest = {}

    def index(pixel):
        if pixel not in nearest:
            nearest[pixel] = min(range(len(palette)),
                                 key=lambda i: sum((a - b) ** 2 for a, b in zip(pixel, palette[i])))
        return nearest[pixel]

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    raw = b"".join(b"\0" + bytes(index(pixel) for pixel in row) for row in rows)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" +
                     chunk(b"IHDR", struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, 3, 0, 0, 0)) +
                     chunk(b"PLTE", b"".join(bytes(color) for color in palette)) +
                     chunk(b"IDAT", zlib.compress(raw, 9)) + chunk(b"IEND", b""))


def prepare(pelage, folder):
    """The files that the examples name."""
    (folder / "patch.obj").write_text((ROOT / "examples" / "patch.obj").read_text())
    subprocess.run(["oiiotool", "--pattern", "checker:width=64:height=64:color1=0.1,0.1,0.1:color2=1,1,1", "128x128",
                    "3", "-d", "uint8", "-o", folder / "length.png"], check=True)
    corners = [f"v {x} {y} {z}" for x in (-1.2, 0.1) for y in (0.5, 1.6) for z in (-0.8, 0.8)]
    faces = ["f 1 2 4 3", "f 5 7 8 6", "f 1 5 6 2", "f 3 4 8 7", "f 1 3 7 5", "f 2 6 8 4"]
    (folder / "block.obj").write_text("\n".join(corners + faces) + "\n")
    guides = scene("- length: {value: 1.1}\n- bend: {direction: [1, 0.3, 0], angle: 120}\n- width: {root: 0.01}",
                   {"strands": 40})
    (folder / "scene.yaml").write_text(guides)
    subprocess.run([pelage, "grow", folder / "scene.yaml", "-o", folder / "guides.hair", "--quiet"], check=True,
                   stdout=subprocess.DEVNULL)


def main(pelage, sections):
    manual = (ROOT / "docs" / "MANUAL.md").read_text()
    hashes = recorded()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        prepare(pelage, folder)
        for section in sections or PICTURES:
            before, after = (render(pelage, text, folder) for text in scenes(manual, section))
            rows = [left + [(255, 255, 255)] * GAP + right for left, right in zip(before, after)]
            write_png(picture_path(section), rows)
            hashes[section] = scene_hash(manual, section)
            print(f"{section}: {picture_path(section).stat().st_size} bytes")
    RECORD.write_text("".join(f"{section} {hashes[section]}\n" for section in sorted(hashes) if section in PICTURES))


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    main(sys.argv[1], sys.argv[2:])
