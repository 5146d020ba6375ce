# SPDX-License-Identifier: Apache-2.0
"""Scenes for other programs. Run: export_test.py PROGRAM

tinyusdz, an independent reader of USD, judges our files if it is installed: PELAGE_TINYUSDZ is the folder
`node_modules/tinyusdz` that `npm i tinyusdz@0.9.0-rc10` makes."""
import os
import pathlib
import re
import shutil
import struct
import subprocess
import sys

from program_scene import ProgramTest

import unittest

ProgramTest.PELAGE = sys.argv.pop(1)
JUDGE = os.environ.get("PELAGE_TINYUSDZ", "")


def arrays(text):
    """The numbers of all arrays of a USD text by the name of the prim and the attribute, as floats of 32 bits."""
    found, prim, samples = {}, "", ""
    for line in text.splitlines():
        if match := re.match(r'\s*def \w+ "(.*?)"', line):
            prim = match[1]
        if match := re.match(r"\s*(?:uniform )?\w+\[\] ([\w:]+)\.timeSamples = \{", line):
            samples = match[1]
        elif re.match(r"\s*\}", line):
            samples = ""
        elif samples and (match := re.match(r"\s*([-\d.e+]+): (\[.*)", line)):
            found[prim, samples, round(float(match[1]), 4)] = match[2]
        elif match := re.match(r"\s*(?:custom )?(?:uniform )?\w+\[\] ([\w:]+) = (\[.*)", line):
            found[prim, match[1]] = re.sub(r"\] \(.*", "]", match[2])
    number = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
    return {name: [struct.unpack("f", struct.pack("f", float(n)))[0] for n in number.findall(values)]
            for name, values in found.items()}


class ExportTest(ProgramTest):
    def export(self, form, *arguments):
        self.run_pelage("export", "scene.yaml", "-o", form, "--format", form, "--quiet", *arguments)
        return self.path / form

    def test_what_is_exported_can_be_rendered_again(self):
        folder = self.export("usd")
        coats = sorted(folder.glob("coats/*.usda"))
        self.assertTrue(coats)
        self.run_pelage("validate", str(folder / "scene.usda"))
        self.run_pelage("convert", str(coats[0]), "back.hair")
        self.assertTrue((self.path / "back.hair").stat().st_size > 0)

    def test_every_format_has_a_readme(self):
        for form, stage in (("usd", "scene.usda"), ("pbrt", "scene.pbrt"), ("mitsuba", "scene.xml"), ("alembic", "scene.abc")):
            folder = self.export(form)
            self.assertTrue((folder / stage).exists())
            self.assertIn(stage, (folder / "README.md").read_text())

    def test_inputs_stay_and_scripts_can_be_allowed(self):
        (self.path / "README.md").write_text("mine")
        said = self.run_pelage("export", "scene.yaml", "-o", ".", "--format", "usd", "--quiet", code=2)[1]
        self.assertIn("`pelage export` did not write it", said)
        self.assertEqual((self.path / "README.md").read_text(), "mine")
        self.export("pbrt", "--allow-scripts", "--allow-procedurals")

    @unittest.skipUnless(JUDGE and shutil.which("node"), "needs Node.js and tinyusdz")
    def test_tinyusdz_reads_the_same_numbers(self):
        files = sorted(self.export("usd").rglob("*.usda"))
        judge = pathlib.Path(__file__).parent / "usd_judge.mjs"
        subprocess.run(["node", judge, JUDGE, *files], check=True, timeout=300)
        compared = 0
        for file in files:
            ours, read = arrays(file.read_text()), arrays(pathlib.Path(f"{file}.read").read_text())
            for name, numbers in ours.items():
                # The judge prints floats with about seven digits.
                self.assertEqual(len(numbers), len(read.get(name, [])), (file, name))
                for a, b in zip(numbers, read[name]):
                    self.assertAlmostEqual(a, b, delta=2e-6 * max(1, abs(a)), msg=(file, name))
                compared += len(numbers)
        self.assertGreater(compared, 1000)


if __name__ == "__main__":
    unittest.main()
