#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the example rat: cages, walk cycle and coat maps. Needs only Python 3."""
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE / "rat"))

import cage  # noqa: E402
import eyes  # noqa: E402
import idle  # noqa: E402
import maps  # noqa: E402
import mesh  # noqa: E402
import walk  # noqa: E402
from charts import Atlas  # noqa: E402

COMMENT = ["Written by examples/make_rat.py. Centimetres, +y up, the nose toward +z, the animal's left is +x.",
           "Catmull-Clark control cage, closed, counter-clockwise seen from outside."]


def write_poses(name, motion, files, skins, atlases):
    for pose, shapes in enumerate(motion.cycle(skins), 1):
        for skin, points in shapes.items():
            mesh.write_obj(HERE / "poses" / ("%s.%04d.obj" % (files[skin], pose)), skins[skin], points,
                           COMMENT + ["Pose %d of the %s." % (pose, name)], atlases[skin].uv)


def main():
    skins = {"rat": cage.build(), "eyes": eyes.build()}
    atlases = {"rat": Atlas(skins["rat"]), "eyes": Atlas(skins["eyes"], texels_per_cm=120)}
    for name, skin in skins.items():
        mesh.write_obj(HERE / (name + ".obj"), skin, skin.points, COMMENT, atlases[name].uv)
    (HERE / "poses").mkdir(exist_ok=True)
    write_poses("walk", walk, {"rat": "walk", "eyes": "eyes"}, skins, atlases)
    write_poses("idle", idle, {"rat": "idle", "eyes": "idle_eyes"}, skins, atlases)
    maps.write(HERE / "maps", skins["rat"], atlases["rat"])


if __name__ == "__main__":
    main()
