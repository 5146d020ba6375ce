# SPDX-License-Identifier: Apache-2.0
"""Pelage grows fur on demand and renders it.

    import pelage
    scene = pelage.open("tuft.yaml")
    hair = scene.grow("coat")               # hair.points (p, 3), hair.offsets, hair.ids, hair.widths
    scene.set("render.samples", 8)
    picture = scene.render()                # picture["RGBA"] (height, width, 4), and all other layers

open, Scene        scenes: set values, grow coats, render frames
Strands, Mesh      strands and meshes as arrays, from and to files; Poses of a mesh
Map                an image as an array, for fields and lights
Picture, Pass      layers of a frame, finished or between two passes
Fibre              fibre models: evaluate, sample, integrate
schema             all keys of a scene, for tools that build panels
measure            experiments of the program `pelage`
Error              every mistake, with file, line, column and nearest name

Arrays are numpy arrays, read-only where Pelage shares its memory; they outlive the objects they come from. Lengths are
in scene units, colours are linear RGB. docs/PYTHON.md is the guide, docs/MANUAL.md lists the keys of a scene.
"""

from __future__ import annotations

from typing import Any

from . import _pelage
from ._errors import Cancelled, Error, PelageWarning, Problem
from ._fibre import Fibre
from ._geometry import Mesh, Poses
from ._map import Map
from ._measure import measure
from ._picture import Pass, Picture
from ._scene import Progress, Scene, open
from ._strands import Strands, read_strands

__version__: str = _pelage.version


def schema() -> dict[str, Any]:
    """Returns all blocks of a scene file, by name; the whole file is the block "scene".

    A block has `name`, `help`, `example` (YAML) and `keys`. A key has `name`, `type`, `default`, `unit`, `help`,
    `required`, `min`, `max` (None: no limit), `above_min` (the value must exceed min), and `blocks`: the names of the
    blocks that its value may hold.
    """
    return _pelage.schema()


__all__ = [
    "Cancelled",
    "Error",
    "Fibre",
    "Map",
    "Mesh",
    "Pass",
    "PelageWarning",
    "Picture",
    "Poses",
    "Problem",
    "Progress",
    "Scene",
    "Strands",
    "measure",
    "open",
    "read_strands",
    "schema",
]
