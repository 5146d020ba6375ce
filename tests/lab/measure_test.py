# SPDX-License-Identifier: Apache-2.0
"""`pelage measure` from end to end, on a scene of a few hundred strands: what it writes is read by other readers."""
import base64
import csv
import json
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "cli"))
import program_scene

PELAGE = sys.argv.pop(1)
SCENE = program_scene.SCENE.replace("    operators:", """    leaf_strands: 50
    cache: {directory: cache, freeze: width}
    operators:""")
CUBE = program_scene.CUBE


def check_png(data):
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    at, pixels, header = 8, b"", None
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + length]
        assert zlib.crc32(kind + body) == struct.unpack(">I", data[at + 8 + length:at + 12 + length])[0]
        header = struct.unpack(">IIBBBBB", body) if kind == b"IHDR" else header
        pixels += body if kind == b"IDAT" else b""
        at += 12 + length
    width, height, channels = header[0], header[1], 3 if header[3] == 2 else 1
    assert len(zlib.decompress(pixels)) == height * (1 + width * channels)


class Measure(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.path = pathlib.Path(self.folder.name)
        (self.path / "scene.yaml").write_text(SCENE)
        (self.path / "cube.obj").write_text(CUBE)

    def tearDown(self):
        self.folder.cleanup()

    def measure(self, *arguments, code=0):
        done = subprocess.run([PELAGE, "measure", *arguments], cwd=self.path, capture_output=True, text=True, timeout=240)
        self.assertEqual(done.returncode, code, done.stderr)
        return done

    def page(self, folder):
        """What the page of a report shows."""
        text = (self.path / folder / "report.html").read_text()
        return json.loads(text.split('type="application/json">')[1].split("</script>")[0])

    def read(self, folder):
        for block in (block for section in self.page(folder)["sections"] for block in section["blocks"]):
            if block["kind"] == "picture":
                check_png(base64.b64decode(block["source"].removeprefix("data:image/png;base64,"), validate=True))
        report = json.loads((self.path / folder / "report.json").read_text())
        with open(self.path / folder / "report.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), len(report["rows"]))
        for row, values in zip(rows, report["rows"]):
            for key, value in values.items():
                if isinstance(value, (int, float)):
                    self.assertEqual(float(row[key]), value)
        return report

    def test_bounds(self):
        self.measure("bounds", "scene.yaml", "-o", "out", "--repeat", "1", "--quiet")
        report = self.read("out")
        rows = {row["variant"]: row for row in report["rows"]}
        self.assertEqual(len(rows), 9)
        self.assertEqual({row["status"] for row in rows.values()}, {"done"})
        for name, row in rows.items():
            if name != "exact, attributes not compacted":
                self.assertEqual(row["lost_pixels"], 0, name)
            if name != "none":
                self.assertGreater(row["bounds_area"], 0, name)
        self.assertGreater(rows["conservative"]["bounds_area"], rows["exact"]["bounds_area"])
        self.assertGreaterEqual(rows["exact"]["bounds_area"], rows["exact-shutter"]["bounds_area"])
        for row in rows.values():  # stages do not overlap
            self.assertLess(sum(v for k, v in row.items() if k.startswith("stage_") and v), 1.02 * row["wall_s"])
        kinds = [block["kind"] for section in self.page("out")["sections"] for block in section["blocks"]]
        self.assertGreater(kinds.count("lines") + kinds.count("bars"), 5)
        self.assertFalse((self.path / "cache").exists(), "the scene's own cache was touched")

    def test_samplers(self):
        self.measure("samplers", "scene.yaml", "-o", "out", "--repeat", "1", "--quiet", "--set", "render.samples=256",
                     "--set", "render.bounces=0", "--set", "grooms.coat.strands=20000")
        rows = {row["variant"]: row for row in self.read("out")["rows"]}
        self.assertEqual(len(rows), 12)
        for samples in 16, 64:
            plain, frame = rows[f"plain, {samples}"], rows[f"adaptive, frame, {samples}"]
            self.assertEqual(plain["samples"], samples)
            self.assertLess(plain["rel_mse_4"], plain["rel_mse"])
            self.assertGreater(plain["top_error"], plain["rel_mse"] ** 0.5)
            self.assertAlmostEqual(plain["gain"], 1, 6)
            self.assertGreater(frame["samples"], 3)
            self.assertGreater(plain["rel_mse"], 0)
            self.assertLess(abs(frame["bias"]), 0.05)
            gather, rejecting = rows[f"gather, {samples}"], rows[f"gather, rejecting, {samples}"]
            self.assertEqual(rejecting["samples"], samples)
            self.assertLess(abs(gather["bias"]), 0.01)
            self.assertLess(rejecting["bias"], gather["bias"] - 0.01)

    def test_bounces(self):
        self.measure("bounces", "scene.yaml", "-o", "out", "--repeat", "1", "--quiet", "--samples", "8",
                     "--set", "image.width=32", "--set", "image.height=24", "--set", "render.gather.cache_paths=64")
        rows = {row["variant"]: row for row in self.read("out")["rows"]}
        methods = "path", "gather, cache: false", "gather, cache: true"
        counts = ["0 bounces", "1 bounce"] + [f"{n} bounces" for n in (2, 4, 8, 16, 32, 64)]
        self.assertEqual(list(rows), ["warm-up"] + [f"{method}, {count}" for count in counts for method in methods])
        self.assertEqual(rows["path, 64 bounces"]["light"], 1)
        for method in methods:
            self.assertEqual(rows[f"{method}, 1 bounce"]["of_one_bounce"], 1)
            lights = [rows[f"{method}, {count}"]["light"] for count in counts]
            self.assertGreater(lights[1], lights[0])
            self.assertAlmostEqual(sum(rows[f"{method}, {count}"]["light_of_last_bounces"] for count in counts), lights[-1])
            self.assertLess(abs(rows[f"{method}, 64 bounces"]["light_off"]), 0.1)
        for key in "cells", "lookups":
            self.assertGreater(rows["gather, cache: true, 8 bounces"][key], 0)
        self.assertGreater(rows["gather, cache: true, 8 bounces"]["cache_bytes"], 0)
        self.assertEqual(rows["gather, cache: false, 8 bounces"]["cells"], 0)

    def test_shading(self):
        self.measure("shading", "scene.yaml", "-o", "out", "--repeat", "1", "--quiet", "--samples", "16,4",
                     "--reference-samples", "128", "--flicker-samples", "16", "--parts", "splatted,adaptive,gather,reuse,cache,no_cache,skin_ball", "--set", "image.width=48",
                     "--set", "image.height=32", "--set", "render.gather.cache_paths=32")
        rows = {row["variant"]: row for row in self.read("out")["rows"]}
        curves = ["path", "path, splatted", "path, adaptive", "gather", "gather, reuse: false", "gather, cache: true",
                  "path, skin_ball: exact"]
        self.assertIn("no_cache is left out", (self.path / "out/report.html").read_text())  # a single bounce has none
        names = ["warm-up", "reference-a", "reference-b", "reference-a, 8 frames", "reference-b, 8 frames"]
        for curve in curves:
            names += [f"{curve}, 4", f"{curve}, 16", f"{curve}, 16, other seed", f"{curve}, 16, 8 frames"]
        self.assertEqual(list(rows), names)
        self.assertEqual({row["status"] for row in rows.values()}, {"done"})
        for curve in curves:
            few, many = rows[f"{curve}, 4"], rows[f"{curve}, 16"]
            self.assertGreater(many["cpu_s"], 0)
            self.assertIsNone(few["gain_at_5"])
            self.assertLess(abs(many["bias"]), 0.2)
            for row in few, many:
                self.assertGreater(row["rel_mse"], 0)
                self.assertLess(row["rel_mse_4"], row["rel_mse"])
                self.assertGreater(row["top_error"], row["rel_mse"] ** 0.5)
                self.assertGreater(row["rays_camera"], 0)
                self.assertEqual(row["curve"], curve)
            if curve != "path, adaptive":
                self.assertEqual([few["samples"], many["samples"]], [4, 16])
                self.assertLess(many["rel_mse"], few["rel_mse"])
            if "gather" in curve:
                self.assertGreater(many["gather_points"], 0)
            else:
                self.assertEqual(many["gather_points"], 0)
            self.assertGreater(many["reuse_bias_deviation"], 0)
            self.assertIsNone(few["reuse_bias"])
            self.assertLess(many["systematic_8"], 0.1)
            self.assertLess(abs(many["worst_8"]), 0.5)
            self.assertIsNone(few["systematic_8"])
            self.assertTrue(0 <= many["flicker"] < 0.3)  # few blocks: noise of the estimate may make it zero
            self.assertIsNone(few["flicker"])
            self.assertGreater(many["equal_cpu_s"], 0)
            self.assertIsNone(few["equal_gain_4"])
        for key in "equal_gain", "equal_gain_4":
            self.assertEqual(rows["path, 16"][key], 1)
        headings = [section["heading"] for section in self.page("out")["sections"]]
        self.assertEqual(headings[2:5], ["At equal CPU time", "Systematic error", "Flicker"])
        self.assertEqual(rows["gather, reuse: false, 16"]["samples_per_gather_point"], 1)
        self.assertGreater(rows["gather, 16"]["samples_per_gather_point"], 1)
        cached = rows["gather, cache: true, 16"]
        self.assertEqual(cached["reflection_lookups"], 0)  # a single bounce does not reach a third surface
        self.assertEqual(rows["gather, 16"]["reflection_lookups"], 0)
        for row in rows.values():  # where both reach an error, the gain is the ratio of their times
            if row["gain_at_5"] is not None:
                self.assertAlmostEqual(row["gain_at_5"] * row["cpu_s_to_5"], rows["path, 16"]["cpu_s_to_5"], 9)
        differences = sorted(path.name for path in (self.path / "out").glob("difference-*.png"))
        self.assertEqual(differences, ["difference-cache.png", "difference-gather.png", "difference-path.png",
                                       "difference-reuse.png"])
        for name in differences:
            check_png((self.path / "out" / name).read_bytes())
        self.assertFalse((self.path / "cache").exists(), "the scene's own cache was touched")

    def test_lod_of_a_crowd(self):
        crowd = ("crowds.herd={of: [box], count: 8, spacing: 3, area: {type: polygon, points: "
                 "[[-4, -3], [4, -3], [30, -60], [-30, -60]]}}")
        self.measure("lod", "scene.yaml", "-o", "out", "--repeat", "1", "--quiet", "--parts", "crowd",
                     "--set", crowd, "--set", "image.width=96", "--set", "image.height=64", "--set", "grooms.coat.strands=4000",
                     "--set", "render.bounds=none")
        rows = {row["variant"]: row for row in self.read("out")["rows"]}
        self.assertEqual(list(rows), ["warm-up", "reduced detail", "all at full detail"])
        grown = {name: row["strands_generated"] for name, row in rows.items()}
        self.assertEqual(grown["all at full detail"], 8 * 4000)
        self.assertLess(grown["reduced detail"], 0.7 * grown["all at full detail"])
        self.assertFalse((self.path / "cache").exists(), "the scene's own cache was touched")
        sections = [section["heading"] for section in self.page("out")["sections"]]
        self.assertEqual([s for s in sections if s in ("Crowd", "Wedge", "Dolly", "Detail")], ["Crowd"])

    def test_residency(self):
        self.measure("residency", "scene.yaml", "-o", "out", "--repeat", "1", "--quiet", "--threads", "1")
        rows = self.read("out")["rows"]
        self.assertEqual([row["status"] for row in rows[:3]], ["done"] * 3)
        for row in rows:
            self.assertIn(row["status"], ("done", "refused"))
            if row["status"] == "done":
                self.assertEqual(row["pixels"], "identical")
            else:
                self.assertIn("render.memory", row["message"])
        stored = {row["variant"]: row for row in rows if row["variant"].startswith("stored")}
        self.assertEqual(list(stored), ["stored, first run", "stored", "stored, 25 %", "stored, 10 %", "stored, 5 %"])
        self.assertGreater(stored["stored"]["chunks_read"], 0)
        self.assertEqual(stored["stored"]["strands_generated"], 0)
        self.assertEqual(list((self.path / "out").glob("pelage-*")), [], "the stored fur was left behind")

    def test_growth(self):
        self.measure("growth", "scene.yaml", "-o", "out", "--repeat", "1", "--quiet")
        rows = self.read("out")["rows"]
        self.assertEqual([row["variant"] for row in rows[:3]], ["coat, uncached", "coat, cold", "coat, warm"])
        self.assertEqual([row["variant"] for row in rows[3:]], ["coat, length edited", "coat, width edited"])
        self.assertEqual({row["status"] for row in rows}, {"done"})
        self.assertGreater(rows[1]["stage_cache_s"], 0)
        self.assertEqual([rows[0]["strands_generated"], rows[2]["strands_generated"]], [400, 400])
        self.assertFalse((self.path / "cache").exists(), "the scene's own cache was touched")

    def test_a_variant_that_fails_is_reported(self):
        self.measure("bounds", "scene.yaml", "-o", "out", "--repeat", "1", "--quiet", "--memory", "1K", code=1)
        self.assertEqual({row["status"] for row in self.read("out")["rows"]}, {"refused"})

    def test_a_run_that_takes_too_long_is_shown_as_such(self):
        self.measure("bounds", "scene.yaml", "-o", "out", "--repeat", "3", "--quiet", "--time-limit", "0.1",
                     "--set", "render.samples=1000000", code=1)
        rows = self.read("out")["rows"]
        self.assertEqual({(row["status"], row["runs"]) for row in rows}, {("time-out", 1)})

    def test_mistakes_are_found_before_anything_is_run(self):
        self.measure("bounds", "none.yaml", code=3)
        self.measure("bounds", "scene.yaml", "-o", "/proc/none", code=1)


if __name__ == "__main__":
    unittest.main()
