# SPDX-License-Identifier: Apache-2.0
"""Scenes written as RIB, and replies to a renderer's requests. Run: rib_test.py PROGRAM"""
import gzip
import json
import re
import subprocess
import sys

from program_scene import ProgramTest

import unittest

ProgramTest.PELAGE = sys.argv.pop(1)


class RibTest(ProgramTest):
    def strands(self, text):
        """Number of strands in RIB as text."""
        return sum(len(counts.split()) for counts in re.findall(r'^Curves "cubic" \[([^\]]*)\]', text, re.MULTILINE))

    def rib(self, *arguments, **options):
        return self.run_pelage("rib", "scene.yaml", "--quiet", *arguments, **options)

    def test_procedurals_are_the_default(self):
        self.rib("-o", "a.rib", "--ascii")
        text = (self.path / "a.rib").read_text()
        self.assertTrue(text.startswith("##RenderMan RIB\n"))
        self.assertIn(f'Procedural "DynamicLoad" ["libpelage_ri.so" "{self.path}/scene.yaml', text)
        self.assertEqual(self.strands(text), 0)

    def test_expanded_and_compressed(self):
        self.rib("-o", "a.rib.gz", "--ascii", "--expand")
        self.assertEqual(self.strands(gzip.decompress((self.path / "a.rib.gz").read_bytes()).decode()), 400)

    def test_pelage_grows_its_own_procedurals(self):
        self.rib("-o", "a.rib")
        tiny = ("--quiet", "--set", "image.width=24", "--set", "image.height=16", "--stats", "s.json")
        self.run_pelage("render", "a.rib", "-o", "a.exr", *tiny)
        of_rib = json.loads((self.path / "s.json").read_text())
        self.run_pelage("render", "scene.yaml", "-o", "b.exr", *tiny)
        of_scene = json.loads((self.path / "s.json").read_text())
        self.assertEqual(of_rib["strands_described"], 400)
        self.assertEqual(of_rib["strands_described"], of_scene["strands_described"])
        self.assertEqual(of_rib["strands_generated"], of_scene["strands_generated"])

    def test_programs_run_only_when_they_are_allowed(self):
        (self.path / "gen").write_text("""#!/bin/sh
while read -r detail arguments; do
  echo "ran $arguments" >> log
  echo 'Curves "linear" [2 2] "nonperiodic" "P" [0 0 0 0 1 0 1 0 0 1 1 0] "constantwidth" 0.1'
  printf '\\377'
done
""")
        (self.path / "gen").chmod(0o755)
        (self.path / "a.rib").write_text('Format 8 8 1 Projection "perspective" Translate 0 0 5 WorldBegin\n'
                                         'LightSource "ambientlight" 1\nSurface "straw" "float gloss" 0.25\n'
                                         'Procedural "RunProgram" ["gen" "hay"] [0 1 0 1 0 1]\nWorldEnd\n')
        render = ("render", "a.rib", "-o", "a.exr", "--set", "render.samples=1", "--progress", "plain")
        err = self.run_pelage(*render, "--stats", "s.json")[1]
        self.assertIn("runs code; skipped (--allow-procedurals", err)
        self.assertEqual(json.loads((self.path / "s.json").read_text())["strands_described"], 0)
        self.assertFalse((self.path / "log").exists())
        (self.path / "t.yaml").write_text("straw: {model: cone-shell, color: $Color, diffuse: $gloss}\n")
        err = self.run_pelage(*render, "--stats", "s.json", "--allow-procedurals", "--materials", "t.yaml",
                              "--preview")[1]
        self.assertNotIn(".rib:", err)
        self.assertEqual(json.loads((self.path / "s.json").read_text())["strands_described"], 2)
        self.assertEqual((self.path / "log").read_text(), "ran hay\n")

    def test_archives_are_beside_the_file(self):
        self.rib("-o", "a.rib", "--ascii", "--archives", "--set", "grooms.coat.leaf_strands=100")
        text = (self.path / "a.rib").read_text()
        names = re.findall(r'"DelayedReadArchive" \["([^"]*)"\]', text)
        self.assertGreater(len(names), 3)
        self.assertEqual(sum(self.strands((self.path / name).read_text()) for name in names), 400)
        self.assertEqual(self.strands(text), 0)

    def test_frames(self):
        self.rib("-o", "a.%02d.rib", "--frames", "1-3")
        self.assertEqual(sorted(path.name for path in self.path.glob("*.rib")), ["a.01.rib", "a.02.rib", "a.03.rib"])

    def test_level_of_detail_on_request(self):
        far = ("--set", "camera.position=[60, 40, 160]", "--ascii", "--expand")
        self.rib("-o", "all.rib", *far)
        self.rib("-o", "few.rib", *far, "--lod")
        self.assertEqual(self.strands((self.path / "all.rib").read_text()), 400)
        few = self.strands((self.path / "few.rib").read_text())
        self.assertTrue(0 < few < 300, few)

    def test_mistakes(self):
        self.assertIn("RIB files are named .rib", self.rib("-o", "a.png", code=2)[1])
        self.assertIn("--lod needs", self.rib("-o", "a.rib", "--lod", code=2)[1])
        self.rib("-o", "a.rib", "--expand", "--archives", code=2)
        self.assertFalse((self.path / "a.rib").exists())
        err = self.rib("-o", "a.rib", "--set", "grooms.coat.strnds=3", code=3)[1]
        self.assertIn("did you mean 'strands'", err)


class ProceduralTest(ProgramTest):
    def test_one_process_answers_many_requests(self):
        scene = self.path / "scene.yaml"
        requests = [f"1e38 {scene} character=box coat=coat detail=full", f"7 {scene} character=bax", f"1e38 {scene}"]
        done = subprocess.run([self.PELAGE, "procedural"], input="\n".join(requests) + "\n", capture_output=True,
                              cwd=self.path, encoding="latin-1", timeout=300)
        self.assertEqual(done.returncode, 0)
        replies = done.stdout.split("\xff")
        self.assertEqual(len(replies), 4)
        self.assertEqual(replies[3], "")
        self.assertIn("Curves", replies[0])
        self.assertEqual(replies[1], "")
        self.assertEqual(replies[2], replies[0])
        self.assertEqual(done.stderr,
                         "pelage: error: procedural: there is no character 'bax'; did you mean 'box'?\n")


if __name__ == "__main__":
    unittest.main()
