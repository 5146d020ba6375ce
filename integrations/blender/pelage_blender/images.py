# SPDX-License-Identifier: Apache-2.0
"""Images of Blender as files that Pelage reads."""
from __future__ import annotations

import hashlib
import pathlib
import re

import bpy
import numpy as np

from . import exr
from .scene_folder import SceneFolder

LINEAR = {"Linear", "Non-Color", "Raw", "Linear Rec.709", "Linear ACES", "scene_linear"}


def sequence_file(path: pathlib.Path, frame: int, *, start: int, count: int, offset: int, cyclic: bool) -> pathlib.Path:
    """The file of an image sequence at a frame of the scene, as Blender chooses it. path: any file of the sequence."""
    number = frame - start + 1
    if cyclic:
        number = (number - 1) % max(count, 1) + 1
    number = min(max(number, 1), max(count, 1)) + offset
    found = re.fullmatch(r"(.*?)(\d+)(\D*)", path.stem)
    if found is None:
        return path
    return path.with_name(f"{found[1]}{number:0{len(found[2])}d}{found[3]}{path.suffix}")


def image_file(image: bpy.types.Image, folder: SceneFolder, user: bpy.types.ImageUser | None = None,
               frame: int = 0) -> tuple[pathlib.Path, str]:
    """Path of an image, and its colour space as Pelage names it: `linear` or `srgb`. Raises ValueError.

    A packed, generated or edited image is written to the folder as EXR. user: chooses the file of a sequence at `frame`.
    """
    space = "linear" if image.colorspace_settings.name in LINEAR else "srgb"
    path = pathlib.Path(bpy.path.abspath(image.filepath_raw, library=image.library)).absolute()
    if image.source == "MOVIE" or (image.source == "SEQUENCE" and user is None):
        raise ValueError(f"the image '{image.name}' is a movie or a sequence, which cannot be read here")
    if image.source == "SEQUENCE":
        path = sequence_file(path, frame, start=user.frame_start, count=user.frame_duration, offset=user.frame_offset,
                             cyclic=user.use_cyclic)
        if not path.is_file():
            raise ValueError(f"the image '{image.name}' cannot be read: {path}")
        return path, space
    tiled = image.source == "TILED"
    on_disk = image.source in ("FILE", "TILED") and image.packed_file is None and not image.is_dirty
    if on_disk and (tiled or path.is_file()):
        return path, space
    return _written(image, folder), "linear" if image.is_float or space == "linear" else "srgb"


def _written(image: bpy.types.Image, folder: SceneFolder) -> pathlib.Path:
    width, height = image.size
    if width * height == 0:
        raise ValueError(f"the image '{image.name}' cannot be read: {bpy.path.abspath(image.filepath_raw) or 'it is empty'}")
    name = hashlib.blake2b(image.name_full.encode(), digest_size=8).hexdigest()
    pixels = np.empty(width * height * image.channels, np.float32)
    image.pixels.foreach_get(pixels)
    rows = pixels.reshape(height, width, image.channels)[::-1]
    names = {1: "Y", 2: "YA", 3: "RGB", 4: "RGBA"}[image.channels]
    return folder.path / folder.put(f"image_{name}.exr", exr.encode({letter: rows[..., i] for i, letter in enumerate(names)}))
