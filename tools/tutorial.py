#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""tutorial.py [PICTURE...]: renders the pictures of docs/TUTORIAL.md from the scenes in the page. Needs oiiotool."""
import pathlib
import re
import subprocess
import sys
import tempfile

import pictures

ROOT = pathlib.Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs" / "TUTORIAL.md"
MAX_BYTES = 60_000
NEW = re.compile(r"^pelage (new .*-o hamster.yaml.*)$", re.MULTILINE)   # the command that writes the first scene
BLOCK = re.compile(r"^```(\w+)\n(.*?)^```$|^!\[[^\]]*\]\(([^)]+)\)$", re.MULTILINE | re.DOTALL)


def blocks(text):
    """What a reader acts on, in order: (language, text) of each fenced block, ("picture", path) of each picture."""
    return [(found[1], found[2]) if found[1] else ("picture", found[3]) for found in BLOCK.finditer(text)]


def sections(text):
    """The top-level keys of a scene file, each with its lines."""
    parts = re.split(r"^(?=\w)", text, flags=re.MULTILINE)
    return {part.split(":")[0]: part.rstrip("\n") + "\n" for part in parts if part.strip()}


def scenes(text, first):
    """The scene as it is at each picture, from the sections `first` on. A section replaces the section of its name, as
    the page says."""
    scene, result = dict(first), {}
    for kind, content in blocks(text):
        if kind == "yaml":
            scene.update(sections(content))
        elif kind == "picture":
            result[content] = "\n".join(scene.values())
    return result


def small_picture(png, path):
    """Writes a JPEG of at most MAX_BYTES, without metadata."""
    for quality in (94, 90, 86, 82):
        subprocess.run(["oiiotool", png, "--compression", f"jpeg:{quality}", "-o", path], check=True)
        path.write_bytes(pictures.plain_jpeg(path.read_bytes()))
        if path.stat().st_size <= MAX_BYTES:
            break


def main(wanted):
    pelage = ROOT / "build/release/bin/pelage"
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        text = PAGE.read_text()
        subprocess.run([ROOT / "examples/make_hamster.py", folder], check=True)
        subprocess.run([pelage, *NEW.search(text)[1].split()], cwd=folder, check=True)
        for picture, scene in scenes(text, sections((folder / "hamster.yaml").read_text())).items():
            if wanted and not any(part in picture for part in wanted):
                continue
            (folder / "scene.yaml").write_text(scene)
            subprocess.run([pelage, "render", folder / "scene.yaml", "-o", folder / "scene.png", "--quiet"], check=True)
            small_picture(folder / "scene.png", PAGE.parent / picture)
            print(picture, (PAGE.parent / picture).stat().st_size, "bytes", flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
