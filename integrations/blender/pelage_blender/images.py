# SPDX-License-Identifier: Apache-2.0
"""Images of Blender as files that Pelage reads."""
from __future__ import annotations

import hashlib
import pathlib

import bpy
import numpy as np

from . import exr
from .files import SceneFolder

LINEAR = {"Linear", "Non-Color", "Raw", "Linear Rec.709", "Linear ACES", "scene_linear"}


def image_file(image: bpy.types.Image, folder: SceneFolder) -> tuple[pathlib.Path, str]:
    """Path of an image, and its colour space as Pelage names it: `linear` or `srgb`.

    A packed, generated or edited image is written to the folder as EXR.
    """
    space = "linear" if image.colorspace_settings.name in LINEAR else "srgb"
    path = pathlib.Path(bpy.path.abspath(image.filepath_raw, library=image.library)).absolute()
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
