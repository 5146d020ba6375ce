#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""tutorial.py [PICTURE...]: renders the pictures of docs/TUTORIAL.md from the scenes in the page."""
import pathlib
import re
import subprocess
import sys
import tempfile

import pictures

ROOT = pathlib.Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs" / "TUTORIAL.md"
MAX_BYTES = 60_000
BLOCK = re.compile(r"^```(\w+)\n(.*?)^```$|^!\[[^\]]*\]\(([^)]+)\)$", re.MULTILINE | re.DOTALL)


def blocks(text):
    """What a reader acts on, in order: (language, text) of each fenced block, ("picture", path) of each picture."""
    return [(found[1], found[2]) if found[1] else ("picture", found[3]) for found in BLOCK.finditer(text)]


def sections(text):
    """The top-level keys of a scene file, each with its lines."""
    parts = re.split(r"^(?=\w)", text, flags=re.MULTILINE)
    return {part.split(":")[0]: part.rstrip("\n") + "\n" for part in parts if part.strip()}


def scenes(text):
    """The scene as it is at each picture. A section replaces the section of its name, as the page says."""
    scene, result = {}, {}
    for kind, content in blocks(text):
        if kind == "yaml":
            scene.update(sections(content))
        elif kind == "picture":
            result[content] = "\n".join(scene.values())
    return result


def small_picture(ppm):
    """With as many colours as MAX_BYTES have room for."""
    for colors in (128, 96, 64, 48):
        png = pictures.small_png(ppm, colors)
        if len(png) <= MAX_BYTES:
            break
    return png


def main(wanted):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        scene, image, screen = (folder / file for file in ("scene.yaml", "scene.exr", "scene.ppm"))
        subprocess.run([ROOT / "examples/make_hamster.py", folder], check=True)
        for picture, text in scenes(PAGE.read_text()).items():
            if wanted and not any(part in picture for part in wanted):
                continue
            scene.write_text(text)
            subprocess.run([ROOT / "build/release/bin/pelage", "render", scene, "-o", image, "--quiet"], check=True)
            subprocess.run([ROOT / "tools/exr_to_png", image, screen], check=True)
            (PAGE.parent / picture).write_bytes(small_picture(screen.read_bytes()))
            print(picture, (PAGE.parent / picture).stat().st_size, "bytes", flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
