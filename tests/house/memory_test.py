# SPDX-License-Identifier: Apache-2.0
"""memory_test.py PELAGE: a render stays within render.memory, or is refused before it begins.

What the kernel counts as this process's own pages (heap, stacks), less those of a process that has done nothing yet,
is at most render.memory plus the modules' share (the ledger's tag `libraries`), plus a tenth. Pages of mapped files, the
code of shared libraries among them, can be dropped at any moment and are not counted.
"""
import json
import pathlib
import re
import struct
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PELAGE = sys.argv.pop(1)
MIB = 1 << 20
LIMIT = 64 * MIB
SOAKS = {"colony.yaml", "colony_100.yaml", "half_billion.yaml", "bear.yaml", "presets.yaml",
         "windy.yaml", "mane.yaml"}  # minutes, or need a simulation; colony_small is one in little, rat.yaml is windy.yaml
MORE_MEMORY = {"rat.yaml": 128 * MIB}  # with 64 MiB, every part grows several times
SAME_COAT = {"rat_flat.yaml", "rack_focus.yaml"}  # as rat.yaml: panning_shot.yaml is the one that moves

SCENE = """pelage: 1
camera: {{position: [0, 6, 12], look_at: [0, 0, 0]}}
image: {{width: 64, height: 36}}
skins: {{patch: {{mesh: {patch}}}}}
grooms: {{coat: {groom}}}
materials: {{m: {{model: lambert}}, f: {{model: cone-shell, color: [0.5, 0.4, 0.3], diffuse: 0.6}}}}
characters: {{a: {{parts: [{{skin: patch, material: m, grooms: {{coat: f}}}}]}}}}
{more}
lights: {{sky: {{type: environment}}}}
render: {{samples: 1}}
"""


def grown(strands, points=8, operator=""):
    return (f"{{skin: patch, strands: {strands}, points: {points}, "
            f"operators: [{{length: {{value: 0.5}}}}, {operator}{{width: {{root: 0.01, tip: 0.002}}}}]}}")


# Scenes that once took hundreds of times their budget: the groom, and what else the scene holds.
HOSTILE = {
    "clump centres": (grown(20000, 20, "{clump: {spacing: 0.0022}}, "), ""),
    "five million follicles": (grown(5_000_000), ""),
    "a hundred million follicles": (grown(100_000_000), ""),
    "long strands": (grown(3000, 1024), ""),
    "a million animals": (grown(1000), "crowds: {c: {of: [a], count: 1000000, area: {type: rectangle, size: [9000, 9000]}}}"),
}


def hair_file(path, strands, points):
    """Straight strands in Cem Yuksel's format."""
    header = struct.pack("<4sIIIIfffff", b"HAIR", strands, strands * points, 2, points - 1, 0.01, 0, 0.5, 0.4, 0.3)
    with open(path, "wb") as file:
        file.write(header + bytes(128 - len(header)))
        for strand in range(strands):
            x, z = strand % 100 / 50 - 1, strand // 100 % 100 / 50 - 1
            file.write(b"".join(struct.pack("<3f", x, p / points, z) for p in range(points)))


class Memory(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def render(self, scene, *overrides, limit=LIMIT):
        stats = self.folder / "stats.json"
        command = [PELAGE, "render", scene, "-o", self.folder / "x.exr", "--quiet", "--stats", stats,
                   "--memory", f"{limit // MIB}M"]
        for override in overrides:
            command += ["--set", override]
        run = subprocess.run(command, capture_output=True, text=True, timeout=250)
        if run.returncode == 4:
            self.assertRegex(run.stderr, r"needs .*render\.memory|render\.memory .*needs")
            self.assertNotIn("0.0 MiB", run.stderr)
            return run.stderr
        self.assertEqual((run.returncode, run.stderr), (0, ""))
        seen = json.loads(stats.read_text())
        own = seen["peak_anonymous_bytes"] - seen["baseline_anonymous_bytes"]
        self.assertLessEqual(own, 1.1 * (limit + seen["memory_bytes"]["libraries"]), json.dumps(seen["memory_bytes"]))
        return ""

    def scene(self, groom, more=""):
        file = self.folder / "scene.yaml"
        file.write_text(SCENE.format(patch=ROOT / "examples" / "patch.obj", groom=groom, more=more))
        return file

    def test_examples(self):
        """Each example either keeps to the limit, or is refused and renders with more memory."""
        scenes = [path for path in sorted((ROOT / "examples").glob("*.yaml")) if path.name not in SOAKS | SAME_COAT]
        small = "image.width=96", "image.height=54", "render.samples=1", "frames=1"
        for path in scenes:
            with self.subTest(scene=path.name):
                if self.render(path, *small, limit=MORE_MEMORY.get(path.name, LIMIT)):
                    self.assertEqual(self.render(path, *small, limit=1024 * MIB), "")

    def test_scenes_that_do_not_fit(self):
        for name, (groom, more) in HOSTILE.items():
            with self.subTest(case=name):
                self.render(self.scene(groom, more))

    def test_one_long_imported_strand(self):
        hair_file(self.folder / "long.hair", 1, 60_000)
        self.render(self.scene("{strands_file: long.hair}"))

    def test_advice_for_one_long_strand_does(self):
        """What the first refusal says it takes at least is enough."""
        hair_file(self.folder / "long.hair", 1, 20_000)
        scene = self.scene("{strands_file: long.hair}")
        scene.write_text(scene.read_text().replace("{samples: 1}", "{samples: 1, integrator: path}"))  # takes little later
        refusal = self.render(scene)
        self.assertNotEqual(refusal, "")
        least = int(re.search(r"at least --memory (\d+)M", refusal).group(1))
        self.assertEqual(self.render(scene, limit=least * MIB), "")

    def test_many_imported_strands(self):
        hair_file(self.folder / "many.hair", 100_000, 8)
        self.render(self.scene("{strands_file: many.hair}"))

    def test_many_long_imported_strands(self):
        """Small parts of the strands fit, so they are not refused, in reduced and in full detail."""
        hair_file(self.folder / "strings.hair", 1000, 1024)
        for lod in ("true", "false"):
            with self.subTest(lod=lod):
                self.assertEqual(self.render(self.scene("{strands_file: strings.hair}"), f"render.lod.enabled={lod}"), "")

    def test_strings_among_short_strands(self):
        """One block of strands takes as many rows as its longest strand has points."""
        with open(self.folder / "uneven.hair", "wb") as file:
            lengths = [6000 if strand % 1000 == 500 else 8 for strand in range(8000)]
            points = sum(lengths)
            header = struct.pack("<4sIIIIfffff", b"HAIR", len(lengths), points, 3, 0, 0.01, 0, 0.5, 0.4, 0.3)
            file.write(header + bytes(128 - len(header)))
            file.write(struct.pack(f"<{len(lengths)}H", *(length - 1 for length in lengths)))
            for strand, length in enumerate(lengths):
                x = strand % 90 / 45 - 1
                file.write(b"".join(struct.pack("<3f", x, p / length, strand / 8000) for p in range(length)))
        self.render(self.scene("{strands_file: uneven.hair}"))


if __name__ == "__main__":
    unittest.main()
