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
        return {f.stat().st_ino for f in folder.glob("frame-*")}

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
        script = self.run_pelage("farm", "plan", "scene.yaml", "-o", "a b.%04d.exr", "--frames", "1-2", "--regions", "2x1")[0]
        self.assertEqual(len(script.splitlines()), 6)
        subprocess.run(["sh", "-e"], input=script, text=True, cwd=self.path, env=self.environment, check=True,
                       stderr=subprocess.DEVNULL)
        self.assertTrue((self.path / "a b.0002.exr").exists())

    def test_caches_are_filled_first(self):
        plan = self.plan("--set", "grooms.coat.cache={directory: cache, freeze: width}", "--frames", "1-3")
        self.assertEqual(plan["tasks"][0]["name"], "grow")
        self.assertEqual([t["after"] for t in plan["tasks"][1:]], 3 * [["grow"]])

    def test_a_frame_is_a_task_where_regions_are_refused(self):
        for value in "adaptive={noise: 0.05}", "time_limit=5":
            task, = self.plan("--set", f"render.{value}", "--frames", "7")["tasks"]
            self.assertNotIn("--checkpoint", task["command"])
            self.assertEqual(self.start_task(task).wait(), 0)
            self.assertIn("exists, skipped", self.start_task(task).communicate()[1])
            (self.path / task["output"]).unlink()

    def test_uneven_regions_of_gather_and_of_splatted_samples(self):
        for value in "integrator=gather", "gather.cache=true":
            folder = value.partition("=")[0]
            settings = ["--set", "image={width: 75, height: 41, filter_samples: splatted}", "--set", "render.integrator=gather",
                        "--set", f"render.{value}"]
            tasks = self.plan(*settings, "--frames", "1", "--regions", "3x2", "--dir", folder)["tasks"]
            self.assertEqual([t["region"] for t in tasks[:-1]],
                             [[0, 0, 16, 16], [16, 0, 48, 16], [48, 0, 75, 16],
                              [0, 16, 16, 41], [16, 16, 48, 41], [48, 16, 75, 41]])
            for task in tasks:
                process = self.start_task(task)
                self.assertEqual(process.wait(), 0, process.stderr.read())
            self.render(*settings, "--frames", "1", "-o", "whole.exr")
            self.assertEqual(exr_pixels(self.path / "a.0001.exr"), exr_pixels(self.path / "whole.exr"))

    def test_flags_reach_the_tasks(self):
        tasks = self.plan("--frames", "1", "--regions", "2x1", "--threads", "2", "--memory", "300M", "--progress", "tractor")["tasks"]
        self.assertEqual(len(tasks), 3)
        for task in tasks:
            self.assertEqual(task["command"][-4:], ["--threads", "2", "--progress", "tractor"])
            self.assertEqual(task["threads"], 2)
        for task in tasks[:2]:
            self.assertEqual(task["memory"], 300 << 20)
            self.assertIn("render.memory=300M", task["command"])
        self.assertNotIn("memory", tasks[2])
        process = subprocess.run(tasks[0]["command"], cwd=self.path, env=self.environment, check=True, stdout=subprocess.PIPE)
        self.assertIn(b"TR_PROGRESS 100%", process.stdout)

    def refused(self, *arguments):
        return self.run_pelage("farm", *arguments, code=2)[1]

    def test_mistakes(self):
        plan = ["plan", "scene.yaml", "-o", "a.%04d.exr"]
        self.assertIn("farm: unknown action 'plam'; did you mean 'plan'?", self.refused("plam", *plan[1:]))
        self.assertIn("--regions: expected columns and rows such as 4x4, each at most 256, got '4'", self.refused(*plan, "--regions", "4"))
        self.assertIn("--time: expected minutes, or a time such as 2:30:00 or 1-12:00, got 'banana'",
                      self.refused("submit", *plan[1:], "--dry-run", "--time", "banana"))
        self.assertIn("--time: expected minutes", self.refused("submit", *plan[1:], "--dry-run", "--time", "1" * 100000))
        self.assertIn("cannot all be written to", self.refused("plan", "scene.yaml", "-o", "a.exr", "--frames", "1-2"))
        for value, why in ("adaptive={noise: 0.05}", "the sample count of a pixel depends on the whole picture"), (
                "time_limit=5", "regions would have different sample counts"):
            refused = self.refused(*plan, "--regions", "2x2", "--set", f"render.{value}")
            self.assertIn(why, refused)
            self.assertIn("without --regions, each frame is a task", refused)
        self.assertIn("all frames share the folder", self.refused(*plan, "--dir", "a_%d"))
        self.assertIn("more than 1000000 tasks", self.refused(*plan, "--regions", "256x256", "--frames", "1-16"))
        self.assertIn("when they are divided into regions", self.refused("plan", "scene.yaml", "-o", "a.png", "--regions", "2x1"))


if __name__ == "__main__":
    unittest.main()
