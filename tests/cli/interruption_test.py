# SPDX-License-Identifier: Apache-2.0
"""Signals sent to a running program: what it leaves, and with which exit code. No test waits for a time: signals are
sent when the program says that it is in the stage that is to be interrupted, which lasts far longer."""
import json
import signal
import sys
import unittest

from program_scene import ProgramTest

ProgramTest.PELAGE = sys.argv.pop(1)
LONG = ["--set", "render.samples=3000", "--set", "image={width: 640, height: 360}"]


class Interruption(ProgramTest):
    def start_render(self, *arguments, stage, **options):
        """A render that says it is in `stage`."""
        process = self.start("render", "scene.yaml", "--progress", "json", *arguments, **options)
        said = []
        for line in process.stderr:
            said.append(line)
            event = json.loads(line) if line.startswith("{") else {}
            if event.get("stage") == stage and not event["ended"]:
                return process
        self.fail("ended before: " + "".join(said))

    def interrupt(self, process, *signals):
        for number in signals:
            process.send_signal(number)
        _, err = process.communicate(timeout=120)
        return process.returncode, err

    def test_each_signal_has_its_exit_code_and_leaves_a_picture(self):
        for number, code in ((signal.SIGINT, 130), (signal.SIGTERM, 143), (signal.SIGHUP, 129)):
            (self.path / "a.exr").unlink(missing_ok=True)
            process = self.start_render("-o", "a.exr", "--stats", "a.json", *LONG, stage="render")
            got, err = self.interrupt(process, number)
            self.assertEqual(got, code, err)
            self.assertIn("pelage:partial", self.run_pelage("info", "a.exr")[0])
            stats = json.loads((self.path / "a.json").read_text())
            self.assertGreater(stats["rays"]["camera"], 0)
            self.assertGreater(stats["strands_generated"], 0)
            self.assertGreater(stats["cpu_s_by"]["camera_rays"], 0)
            self.assertAlmostEqual(sum(stats["cpu_s_by"].values()), stats["cpu_s"])

    def test_an_interrupted_picture_for_a_screen_has_another_name(self):
        for name in ("a.png", "a.jpg"):
            partial = name.replace(".", ".partial.")
            process = self.start_render("-o", name, *LONG, stage="render")
            got, err = self.interrupt(process, signal.SIGINT)
            self.assertEqual(got, 130, err)
            self.assertIn(partial, err)
            self.assertEqual([n for n in self.names() if n.startswith("a.")], [partial])
            self.render("-o", name, "--skip-existing")
            whole = (self.path / name).read_bytes()
            got, err = self.interrupt(self.start_render("-o", name, *LONG, stage="render"), signal.SIGINT)
            self.assertIn("kept, because", err)
            self.assertEqual((self.path / name).read_bytes(), whole)
            (self.path / name).unlink()
            (self.path / partial).unlink()

    def test_a_request_that_comes_twice_at_once_is_one_except_from_the_keyboard(self):
        process = self.start_render("-o", "a.exr", *LONG, stage="render")
        got, err = self.interrupt(process, signal.SIGTERM, signal.SIGTERM)
        self.assertEqual(got, 143, err)
        self.assertTrue((self.path / "a.exr").exists())

    def test_ignored_signals_stay_ignored(self):
        ignore = lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN)
        process = self.start_render("-o", "a.exr", *LONG, stage="render", preexec_fn=ignore)
        got, err = self.interrupt(process, signal.SIGHUP, signal.SIGINT)
        self.assertEqual(got, 130, err)

    def keeps(self, *arguments, stage):
        self.render("-o", "a.exr")
        before = (self.path / "a.exr").read_bytes()
        process = self.start_render("-o", "a.exr", *arguments, stage=stage)
        got, err = self.interrupt(process, signal.SIGINT)
        self.assertEqual(got, 130, err)
        self.assertEqual((self.path / "a.exr").read_bytes(), before)
        self.assertIn("nothing was written", err)
        self.assertEqual(self.names(), ["a.exr", "cube.obj", "scene.yaml"])

    def test_a_picture_of_no_samples_replaces_nothing_when_tables_are_made(self):
        self.keeps("--set", "materials.fur={model: yan}", stage="medulla tables")

    def test_a_picture_of_no_samples_replaces_nothing_when_boxes_are_measured(self):
        self.keeps("--set", "grooms.coat.strands=60000", "--set", "grooms.coat.points=60", "--set",
                   "grooms.coat.leaf_strands=200",
                   "--set", "render.lod.enabled=false", "--threads", "1", stage="grow")

    def test_what_a_killed_run_left_is_swept_by_the_next(self):
        process = self.start_render("-o", "a.exr", "--set", "image={width: 3000, height: 2000, light_layers: false}",
                                    "--set", "render.samples=1", "--set", "grooms.coat.strands=1", stage="render")
        while not [name for name in self.names() if name.startswith(".pelage-")]:
            self.assertIsNone(process.poll())
        process.kill()
        process.communicate()
        left = [name for name in self.names() if name.startswith(".pelage-")]
        self.assertTrue(left)
        self.render("-o", "b.exr")
        self.assertEqual([name for name in self.names() if name.startswith(".")], [])


if __name__ == "__main__":
    unittest.main()
