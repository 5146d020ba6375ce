# SPDX-License-Identifier: Apache-2.0
"""`pelage render --estimate` against the memory that the same render takes. Run: estimate_test.py PROGRAM"""
import json
import sys
import unittest

from program_scene import ProgramTest

ProgramTest.PELAGE = sys.argv.pop(1)
ALL = ["--set", "render.lod.enabled=false"]  # strands are grown
FURRY = [*ALL, "--set", "grooms.coat.strands=60000", "--set", "grooms.coat.points=8",
         "--set", "image={width: 320, height: 240}"]
LARGE = [*FURRY, "--set", "grooms.coat.strands=200000", "--memory", "60M"]  # more than its budget
# Law of the estimate: at most 5 % below the peak, and at most 1.5 times as much; docs/lab/FARM.md has the examples.
BELOW, ABOVE = 0.95, 1.5


class Estimate(ProgramTest):
    def estimate(self, *arguments):
        return json.loads(self.run_pelage("render", "scene.yaml", "--estimate", "--json", "--threads", "2", "--quiet",
                                          *arguments)[0])

    def peak(self, *arguments):
        self.render("-o", "a.%04d.exr", "--threads", "2", "--stats", "stats.json", *arguments)
        return json.loads((self.path / "stats.json").read_text())["peak_rss_bytes"]

    def test_memory_is_near_the_peak(self):
        path = ["--set", "render.integrator=path"]
        # `gather` reserves memory for tiles that are full of fur, up to 15 MiB per thread.
        cases = {"a few hairs": path, "fur": FURRY, "path": [*FURRY, *path],
                 "embree": [*FURRY, "--set", "render.accel=embree"],
                 "a large picture": [*path, "--set", "image={width: 1600, height: 900}", "--set", "render.samples=1"],
                 "a region": ["--set", "image={width: 1600, height: 900}", "--region", "0,0,320,320"],
                 "a small budget": LARGE}
        for name, arguments in cases.items():
            with self.subTest(name):
                ratio = self.estimate(*arguments)["peak_bytes"] / self.peak(*arguments)
                self.assertGreater(ratio, BELOW)
                self.assertLess(ratio, ABOVE)

    def test_nothing_is_rendered(self):
        before = self.names()
        text = self.run_pelage("render", "scene.yaml", "--estimate", "-o", "sub/a.exr", "--checkpoint", "ck")[0]
        self.assertEqual(self.names(), before)
        self.assertRegex(text, r"^frame 1: \S+ MiB of memory: scene .*\nframe 1: about .* of CPU time")
        text = self.run_pelage("render", "scene.yaml", "--estimate", "--threads", "1", "--set", "grooms.coat.strands=1", *ALL)[0]
        self.assertRegex(text, r"on 1 thread; .*, 1 strand\n")

    def test_frames_and_their_parts(self):
        answer = self.estimate("--frames", "1-3", *ALL)
        self.assertEqual([f["frame"] for f in answer["frames"]], [1, 2, 3])
        self.assertEqual(answer["peak_bytes"], max(f["peak_bytes"] for f in answer["frames"]))
        for frame in answer["frames"]:
            self.assertGreater(frame["chunks"], 0)
            self.assertEqual(frame["strands"], 400)
            self.assertGreater(frame["cpu_s"], 0)

    def test_more_needs_more(self):
        small, large = self.estimate(), self.estimate(*FURRY)
        self.assertGreater(large["frames"][0]["bytes"]["chunks"], 10 * small["frames"][0]["bytes"]["chunks"])
        self.assertGreater(large["frames"][0]["bytes"]["film"], small["frames"][0]["bytes"]["film"])
        self.assertGreater(large["cpu_s"], small["cpu_s"])

    def test_a_budget_limits_the_chunks(self):
        frame, = self.estimate(*LARGE)["frames"]
        self.assertFalse(frame["fits"])
        self.assertLess(frame["bytes"]["chunks"], 60 << 20)
        self.assertTrue(self.estimate(*FURRY)["frames"][0]["fits"])

    def test_boxes_in_a_cache_are_not_measured(self):
        cached = [*FURRY, "--set", "grooms.coat.cache={directory: cache, freeze: width}"]
        self.assertGreater(self.estimate(*cached)["frames"][0]["cpu_s_by"]["measuring"], 0)
        self.run_pelage("grow", "scene.yaml", *cached)
        self.assertEqual(self.estimate(*cached)["frames"][0]["cpu_s_by"]["measuring"], 0)

    def test_mistakes(self):
        _, err = self.run_pelage("render", "scene.yaml", "--estimate", *FURRY, "--memory", "1M", code=4)
        self.assertIn("give at least --memory", err)
        _, err = self.run_pelage("render", "scene.yaml", "--json", code=2)
        self.assertIn("--estimate", err)
        _, err = self.run_pelage("render", "scene.yaml", "--estimate", "--region", "0,0,99,99", code=2)
        self.assertIn("the picture has 24 x 16 pixels", err)


if __name__ == "__main__":
    unittest.main()
