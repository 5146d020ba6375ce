# SPDX-License-Identifier: Apache-2.0
"""Flags of `pelage render` that concern the picture as a whole. Run: picture_flags_test.py PROGRAM"""
import os
import struct
import sys
import unittest

from program_scene import ProgramTest

ProgramTest.PELAGE = sys.argv.pop(1)


def exr_windows(path):
    """Data and display window of an EXR file, each as (x0, y0, x1, y1) with x1 and y1 included."""
    data, at, windows = path.read_bytes(), 8, {}
    while data[at]:
        end = data.index(0, at)
        name, at = data[at:end].decode(), data.index(0, end + 1) + 1
        size, = struct.unpack_from("<i", data, at)
        if name in ("dataWindow", "displayWindow"):
            windows[name] = struct.unpack_from("<4i", data, at + 4)
        at += 4 + size
    return windows["dataWindow"], windows["displayWindow"]


def png_size(path):
    data = path.read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n", data[:8]
    return struct.unpack_from(">2i", data, 16)


class PictureFlagsTest(ProgramTest):
    def size(self, name):
        x0, y0, x1, y1 = exr_windows(self.path / name)[0]
        return x1 - x0 + 1, y1 - y0 + 1

    def note(self, *arguments):
        return self.run_pelage("render", "scene.yaml", "--progress", "plain", *arguments)[1]

    def test_samples_and_scale(self):
        self.assertIn("3 samples", self.note("-o", "a.exr", "--samples", "3", "--scale", "0.5"))
        self.assertEqual(self.size("a.exr"), (12, 8))
        # The flag wins over --set, and scaling gives the same pixels as setting the size.
        self.render("-o", "b.exr", "--set", "image.width=12", "--set", "image.height=8", "--samples", "3",
                    "--set", "render.samples=9")
        tail = lambda name: (self.path / name).read_bytes()[-200:]  # rows of the last block
        self.assertEqual(tail("a.exr"), tail("b.exr"))

    def test_preview(self):
        self.assertIn("4 samples", self.note("-o", "a.exr", "--preview", "--set", "render.samples=100"))
        self.assertEqual(self.size("a.exr"), (6, 4))
        self.assertIn("2 samples", self.note("-o", "a.exr", "--preview"))
        self.assertIn("7 samples", self.note("-o", "a.exr", "--preview", "--samples", "7", "--scale", "1"))
        self.assertEqual(self.size("a.exr"), (24, 16))

    def test_a_region_lies_in_the_frame_of_the_whole_picture(self):
        self.render("-o", "a.exr", "--region", "3,2,20,13")
        self.assertEqual(exr_windows(self.path / "a.exr"), ((3, 2, 19, 12), (0, 0, 23, 15)))
        self.run_pelage("info", "a.exr")
        self.render("-o", "a.png", "--region", "3,2,20,13")
        self.assertEqual(png_size(self.path / "a.png"), (17, 11))

    def test_a_wrong_region_is_refused_in_one_line(self):
        for region, says in (("1,2,3", "expected four pixels"), ("1,2,3,4,5", "expected four pixels"),
                             ("a", "expected four pixels"), ("0,0,25,16", "the picture has 24 x 16 pixels"),
                             ("-1,0,3,3", "the picture has"), ("5,5,5,9", "it has no pixels"),
                             ("0,0,99999999999,1", "expected four pixels")):
            _, err = self.render("-o", "a.exr", "--region=" + region, code=2)
            self.assertIn(says, err)
            self.assertEqual(err.count("\n"), 1, err)
        _, err = self.render("-o", "a.exr", "--region", "0,0,8,8", "--set", "render.adaptive={}", code=2)
        self.assertIn("needs the whole picture", err)
        self.assertEqual(self.names(), ["cube.obj", "scene.yaml"])

    def test_pictures_for_a_screen(self):
        self.render("-o", "out/a.png")
        self.assertEqual(png_size(self.path / "out/a.png"), (24, 16))
        self.render("-o", "a.jpg")
        self.assertEqual((self.path / "a.jpg").read_bytes()[:3], b"\xff\xd8\xff")
        _, err = self.render("-o", "a.gif", code=2)
        self.assertIn("pictures are written as .exr, .png or .jpg", err)

    def test_a_time_limit(self):
        err = self.note("-o", "a.exr", "--time-limit", "0.3", "--samples", "1000000")
        self.assertNotIn("1000000 samples", err)
        self.render("-o", "a.exr", "--time-limit", "0", code=2)

    def test_frames_that_exist_are_skipped(self):
        self.render("-o", "a.%02d.exr", "--frames", "1-3")
        os.remove(self.path / "a.02.exr")
        (self.path / "a.03.exr").write_bytes(b"cut")
        before = (self.path / "a.01.exr").stat().st_mtime_ns
        err = self.note("-o", "a.%02d.exr", "--frames", "1-3", "--skip-existing")
        self.assertIn("a.01.exr  exists, skipped", err)
        self.assertEqual((self.path / "a.01.exr").stat().st_mtime_ns, before)
        self.assertEqual(self.size("a.02.exr"), (24, 16))
        self.assertEqual(self.size("a.03.exr"), (24, 16))
        self.render("-o", "a.%02d.exr", "--frames", "1-3", "--skip-existing")

    def test_a_partial_picture_does_not_count_as_existing(self):
        self.render("-o", "a.exr")
        data = (self.path / "a.exr").read_bytes()
        at = data.index(b"pelage:partial\0") + len(b"pelage:partial\0int\0") + 4
        (self.path / "a.exr").write_bytes(data[:at] + b"\1" + data[at + 1:])
        self.assertNotIn("skipped", self.note("-o", "a.exr", "--skip-existing"))
        self.assertIn("skipped", self.note("-o", "a.exr", "--skip-existing"))


if __name__ == "__main__":
    unittest.main()
