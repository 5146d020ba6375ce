# SPDX-License-Identifier: Apache-2.0
"""`pelage farm plan`: its tasks, run in an order that it allows, some of them killed, give the pictures of one run.
Run: farm_test.py PROGRAM"""
import json
import os
import pathlib
import subprocess
import sys
import unittest

from program_scene import ProgramTest, exr_pixels

ProgramTest.PELAGE = sys.argv.pop(1)
SMALL = ["--set", "image={width: 64, height: 48}", "--set", "render.samples=60"]


class Farm(ProgramTest):
    def setUp(self):
        super().setUp()
        # Commands of a plan begin with "pelage".
        (self.path / "bin").mkdir()
        (self.path / "bin" / "pelage").symlink_to(self.PELAGE)
        self.environment = {**os.environ, "PATH": f"{self.path / 'bin'}:{os.environ['PATH']}"}

    def plan(self, *arguments):
        return json.loads(self.run_pelage("farm", "plan", "scene.yaml", "-o", "a.%04d.exr", "--json", *arguments)[0])

    def start_task(self, task):
        process = subprocess.Popen(task["command"], cwd=self.path, env=self.environment, stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.__exit__, None, None, None)
        self.addCleanup(process.kill)
        return process

    def checkpoints(self):
        folder = self.path / "farm" / "checkpoints"
        return {f.stat().st_ino for f in folder.iterdir()} if folder.exists() else set()

    def test_killed_tasks_run_again_and_give_the_pictures_of_one_run(self):
        plan = self.plan(*SMALL, "--frames", "1-2", "--regions", "2x1", "--every", "0.1s")
        self.assertEqual(plan["plan"], 1)
        self.assertEqual(pathlib.Path(plan["folder"]).resolve(), self.path.resolve())
        done = set()
        for number, task in enumerate(plan["tasks"]):
            self.assertLessEqual(set(task["after"]), done)
            if number % 2 == 0 and "region" in task:
                before = self.checkpoints()
                process = self.start_task(task)
                while process.poll() is None and self.checkpoints() <= before:
                    pass
                process.kill()
                process.wait()
            process = self.start_task(task)
            _, err = process.communicate(timeout=240)
            self.assertEqual(process.returncode, 0, err)
            self.assertTrue((self.path / task["output"]).exists())
            done.add(task["name"])
        self.assertEqual(len(done), 2 * 3)
        self.render(*SMALL, "--frames", "1-2", "-o", "whole.%04d.exr")
        for frame in (1, 2):
            self.assertEqual(exr_pixels(self.path / f"a.{frame:04}.exr"), exr_pixels(self.path / f"whole.{frame:04}.exr"))
        # Nothing that is finished is computed again.
        for task in plan["tasks"]:
            if "region" in task:
                before = (self.path / task["output"]).stat().st_ino
                self.assertIn("is finished, skipped", self.start_task(task).communicate()[1])
                self.assertEqual((self.path / task["output"]).stat().st_ino, before)

    def test_the_shell_runs_a_plan(self):
        script = self.run_pelage("farm", "plan", "scene.yaml", "-o", "a b.%04d.exr", "--frames", "1-2", "--regions", "1x2")[0]
        self.assertEqual(len(script.splitlines()), 6)
        subprocess.run(["sh", "-e"], input=script, text=True, cwd=self.path, env=self.environment, check=True,
                       stderr=subprocess.DEVNULL)
        self.assertTrue((self.path / "a b.0002.exr").exists())

    def test_caches_are_filled_first(self):
        plan = self.plan("--set", "grooms.coat.cache={directory: cache}", "--frames", "1-3")
        self.assertEqual(plan["tasks"][0]["name"], "grow")
        self.assertEqual([t["after"] for t in plan["tasks"][1:]], 3 * [["grow"]])

    def refused(self, *arguments):
        return self.run_pelage("farm", *arguments, code=2)[1]

    def test_mistakes(self):
        plan = ["plan", "scene.yaml", "-o", "a.%04d.exr"]
        self.assertIn("farm: unknown action 'plam'; did you mean 'plan'?", self.refused("plam", *plan[1:]))
        self.assertIn("--regions: expected columns and rows such as 4x4, got '4'", self.refused(*plan, "--regions", "4"))
        self.assertIn("cannot all be written to", self.refused("plan", "scene.yaml", "-o", "a.exr", "--frames", "1-2"))
        self.assertIn("`adaptive` sampling needs the whole picture",
                      self.refused(*plan, "--regions", "2x2", "--set", "render.adaptive={rule: two-stage}"))
        self.assertIn("when they are divided into regions", self.refused("plan", "scene.yaml", "-o", "a.png", "--regions", "2x1"))


if __name__ == "__main__":
    unittest.main()
