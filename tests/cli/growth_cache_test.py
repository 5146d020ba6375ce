# SPDX-License-Identifier: Apache-2.0
"""The user's cache of growth changes no pixel, whatever state it is in."""
import os
import sys
import unittest

from program_scene import ProgramTest, exr_pixels

ProgramTest.PELAGE = sys.argv.pop(1)


class GrowthCache(ProgramTest):
    def setUp(self):
        super().setUp()
        self.cache = self.path / "cache"
        self.environment = {**os.environ, "PELAGE_CACHE": str(self.cache)}

    def pixels(self, *arguments):
        """The pixels of a render, and what it wrote to the terminal."""
        _, err = self.render("-o", "a.exr", "--set", "grooms.coat.strands=6000", *arguments, env=self.environment)
        return exr_pixels(self.path / "a.exr"), err

    def test_pixels(self):
        none = self.pixels("--no-cache")
        self.assertFalse(self.cache.exists())
        self.assertEqual(self.pixels(), none)
        file, = self.cache.iterdir()
        whole = file.read_bytes()
        self.assertEqual(self.pixels(), none)
        file.write_bytes(whole[:1000] + bytes([whole[1000] ^ 1]) + whole[1001:])
        pixels, err = self.pixels()
        self.assertEqual(pixels, none[0])
        self.assertEqual(err.count("\n"), 1, err)
        self.assertIn(file.name, err)
        self.assertEqual(file.read_bytes(), whole)
        self.assertEqual(self.pixels(), none)

    def test_a_folder_that_cannot_be_made(self):
        self.environment["PELAGE_CACHE"] = str(self.path / "cube.obj" / "cache")
        self.assertEqual(self.pixels(), self.pixels("--no-cache"))

    def test_size_and_prune(self):
        self.pixels("--cache-size", "1K")
        self.assertEqual(list(self.cache.iterdir()), [])
        self.pixels()
        self.assertEqual(len(list(self.cache.iterdir())), 1)
        out, _ = self.run_pelage("grow", "scene.yaml", "--quiet", "--prune", env=self.environment)
        self.assertIn(f"{self.cache}: 1 file removed", out)
        self.assertEqual(list(self.cache.iterdir()), [])
        _, err = self.render("--cache-size", "much", code=2)
        self.assertIn("--cache-size: expected bytes such as 500M or 2G, got 'much'", err)


if __name__ == "__main__":
    unittest.main()
