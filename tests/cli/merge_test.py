# SPDX-License-Identifier: Apache-2.0
"""Regions of a picture, rendered by separate runs and merged. Run: merge_test.py PROGRAM"""
import os
import platform
import sys
import unittest

from program_scene import ProgramTest

ProgramTest.PELAGE = sys.argv.pop(1)

REGIONS = ("0,0,10,16", "10,0,24,7", "10,7,24,16")


def attribute(path, name):
    """Text of a string attribute of an EXR file."""
    data = path.read_bytes()
    at = data.index(name.encode() + b"\0string\0") + len(name) + 8
    size = int.from_bytes(data[at:at + 4], "little")
    return data[at + 4:at + 4 + size].decode()


class MergeTest(ProgramTest):
    def pieces(self, *arguments):
        names = []
        for i, region in enumerate(REGIONS):
            names.append(f"piece{i}.exr")
            self.render("-o", names[-1], "--region", region, *arguments)
        return names

    def pixels(self, name):
        """The compressed pixels: all bytes after the header."""
        data, at = (self.path / name).read_bytes(), 8
        while data[at]:
            at = data.index(0, data.index(0, at) + 1) + 1
            at += 4 + int.from_bytes(data[at:at + 4], "little")
        offsets = 8 * -(-16 // 16)  # one block of 16 rows; its offset depends on the header's length
        return data[at + 1 + offsets:]

    def test_merged_regions_equal_the_whole(self):
        for name in ("image.filter_samples=drawn", "image.filter_samples=splatted", "render.integrator=gather"):
            setting = ("--set", name)
            self.render("-o", "whole.exr", *setting)
            self.run_pelage("merge", *self.pieces(*setting), "-o", "merged.exr")
            self.assertEqual(self.pixels("merged.exr"), self.pixels("whole.exr"), name)

    def test_a_missing_piece_is_named(self):
        err = self.run_pelage("merge", *self.pieces()[:2], "-o", "merged.exr", code=3)[1]
        self.assertIn("no piece contains the pixels 10,7,24,16", err)
        self.assertFalse((self.path / "merged.exr").exists())

    def test_another_scene_is_named(self):
        names = self.pieces()
        self.render("-o", names[1], "--region", REGIONS[1], "--set", "render.seed=9")
        self.assertIn("piece1.exr: `pelage:sceneHash`", self.run_pelage("merge", *names, "-o", "m.exr", code=3)[1])

    def test_a_finished_picture_is_left(self):
        names = self.pieces()
        merge = ("merge", *names, "-o", "m.exr")
        self.assertNotIn("skipped", self.run_pelage(*merge)[1])
        inode = (self.path / "m.exr").stat().st_ino
        self.assertIn("m.exr  is finished, skipped", self.run_pelage(*merge)[1])
        self.assertEqual((self.path / "m.exr").stat().st_ino, inode)
        self.render("-o", names[0], "--region", REGIONS[0])  # a piece is newer
        self.assertNotIn("skipped", self.run_pelage(*merge)[1])

    def test_a_piece_is_not_overwritten(self):
        names = self.pieces()
        self.run_pelage("merge", *names, "-o", names[0], code=2)
        self.run_pelage("merge", *names, "-o", "m.png", code=2)

    @unittest.skipUnless(platform.machine() == "x86_64", "x86-64 only")
    def test_other_instructions_are_named(self):
        names = self.pieces()
        if attribute(self.path / names[1], "pelage:instructions") != "x86-64 FMA":
            self.skipTest("a processor without FMA")
        slow = {**os.environ, "GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX2,-FMA"}
        self.render("-o", names[1], "--region", REGIONS[1], env=slow)
        self.assertEqual(attribute(self.path / names[1], "pelage:instructions"), "x86-64")
        err = self.run_pelage("merge", *names, "-o", "m.exr", code=3)[1]
        self.assertIn("--any-instructions", err)
        self.run_pelage("merge", *names, "-o", "m.exr", "--any-instructions")
        self.assertEqual(attribute(self.path / "m.exr", "pelage:instructions"), "mixed")


if __name__ == "__main__":
    unittest.main()
