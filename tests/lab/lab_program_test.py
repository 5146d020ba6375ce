# SPDX-License-Identifier: Apache-2.0
"""`pelage measure` is `pelage-lab measure`, with everything that a caller can see. Run: lab_program_test.py PELAGE"""
import os
import pathlib
import shutil
import signal
import stat
import subprocess
import sys
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "cli"))
from program_scene import ProgramTest

ProgramTest.PELAGE = sys.argv.pop(1)
LAB = str(pathlib.Path(ProgramTest.PELAGE).with_name("pelage-lab"))
# Says what it was given.
STAND_IN = """#!/bin/sh
for word; do echo "[$word]"; done
cat
echo noise >&2
[ "$2" != wait ] || { echo ready; exec sleep 1000; }
exit 42
"""


class LabProgram(ProgramTest):
    def program(self, lab=None):
        """A copy of the program in a folder of its own, with this laboratory."""
        folder = self.path / "bin dir"
        folder.mkdir()
        self.PELAGE = str(shutil.copy(self.PELAGE, folder / "pelage"))
        if lab:
            (folder / "pelage-lab").write_text(lab)
            (folder / "pelage-lab").chmod(stat.S_IRWXU)

    def test_help_is_that_of_the_laboratory(self):
        for command, flag in ("measure", "--repeat"), ("compare", "--models"):
            ours = self.run_pelage(command, "--help")[0]
            self.assertEqual(ours, subprocess.run([LAB, command, "--help"], capture_output=True, text=True).stdout)
            self.assertIn(f"pelage-lab {command}", ours)
            self.assertIn(flag, ours)
            self.assertIn(f"  {command} ", self.run_pelage("--help")[0])

    def test_arguments_streams_and_exit_code_pass_through(self):
        self.program(STAND_IN)
        process = self.start("measure", "it's", "", "--set", "a=b c", stdin=subprocess.PIPE)
        out, err = process.communicate("input\n")
        self.assertEqual(out, "[measure]\n[it's]\n[]\n[--set]\n[a=b c]\ninput\n")
        self.assertEqual((err, process.returncode), ("noise\n", 42))

    def test_signals_reach_the_laboratory(self):
        self.program(STAND_IN)
        process = self.start("measure", "wait", stdin=subprocess.DEVNULL)
        while process.stdout.readline() != "ready\n":
            pass
        process.send_signal(signal.SIGTERM)
        self.assertEqual(process.wait(60), -signal.SIGTERM)

    def test_a_laboratory_of_an_older_build_is_named(self):
        self.program(STAND_IN)
        lab = pathlib.Path(self.PELAGE).with_name("pelage-lab")
        os.utime(lab, (1, 1))
        err = self.run_pelage("measure", "bounds", stdin=subprocess.DEVNULL, code=42)[1]
        self.assertIn(f"{lab} is older than pelage", err)

    def test_a_missing_laboratory_is_one_line(self):
        self.program()
        out, err = self.run_pelage("measure", "bounds", "scene.yaml", code=1)
        self.assertEqual(out, "")
        self.assertEqual(len(err.splitlines()), 1)
        self.assertIn("pelage-lab, which is not in", err)
        self.assertIn("./dev build", err)
        out, err = self.run_pelage("compare", "--help")
        self.assertIn("every fibre model", out)
        self.assertIn("./dev build", out)

    def test_the_laboratory_needs_the_program(self):
        alone = self.path / "pelage-lab"
        shutil.copy(LAB, alone)
        self.PELAGE = str(alone)
        out, err = self.run_pelage("measure", "bounds", "scene.yaml", "-o", "out", code=1)
        self.assertIn("the program pelage, which every run starts, is not in", err)
        self.assertFalse((self.path / "out").exists())
        os.unlink(alone)

    def test_an_interrupted_experiment_reports_what_it_has(self):
        process = self.start("measure", "bounds", "scene.yaml", "-o", "out", "--repeat", "100", "--progress", "plain",
                             "--set", "render.samples=64")
        while not list(self.path.glob("out/*.2.json")) and process.poll() is None:
            time.sleep(0.05)
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=120)
        self.assertEqual(process.returncode, 130)
        self.assertIn("Interrupted: only some variants ran.", (self.path / "out/report.html").read_text())


if __name__ == "__main__":
    unittest.main()
