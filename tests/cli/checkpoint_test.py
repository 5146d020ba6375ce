# SPDX-License-Identifier: Apache-2.0
"""Renders that are killed, interrupted and resumed from checkpoints. No test waits for a time: a process is signalled
when it has written, or is writing, a checkpoint. PELAGE_SOAK=N kills N renders instead of a few."""
import os
import random
import resource
import signal
import sys
import unittest

from program_scene import ProgramTest, exr_pixels

ProgramTest.PELAGE = sys.argv.pop(1)
KILLS = int(os.environ.get("PELAGE_SOAK", 0)) or 8
SMALL = ["--set", "image={width: 96, height: 64}", "--set", "render.samples=150"]
LONGER = [*SMALL[:3], "render.samples=600"]  # several checkpoints, also after a first one
ENDLESS = ["--set", "image={width: 96, height: 64}", "--set", "render.samples=100000"]
FILE = "ck/frame-0001.checkpoint"


class Checkpoints(ProgramTest):
    def start_render(self, *arguments, output="a.exr", **options):
        return self.start("render", "scene.yaml", "-o", output, "--checkpoint", "ck", "--threads", "2",
                          "--progress", "plain", *arguments, **options)

    def inode(self, name=FILE):
        try:
            return (self.path / name).stat().st_ino
        except FileNotFoundError:
            return None

    def is_writing(self):
        folder = self.path / "ck"
        return folder.exists() and any(n.name.startswith(".pelage-") for n in folder.iterdir())

    def after_checkpoint(self, process):
        """Returns when the process has written a checkpoint, or has ended."""
        before = self.inode()
        while self.inode() in (None, before) and process.poll() is None:
            pass

    def end(self, process, code=0):
        _, err = process.communicate(timeout=240)
        self.assertEqual(process.returncode, code, err)
        return err

    def pixels(self, name):
        return exr_pixels(self.path / name)

    def whole(self, *arguments):
        self.render("-o", "whole.exr", *arguments)
        return self.pixels("whole.exr")

    def test_a_killed_render_always_continues(self):
        whole = self.whole(*SMALL)
        chance = random.Random(7)
        continued = 0
        for kill in range(KILLS):
            process = self.start_render(*SMALL, "--every", "0.1s", "--resume")
            if kill % 2:
                while process.poll() is None and not self.is_writing():
                    pass
            else:
                self.after_checkpoint(process)
            for _ in range(chance.randrange(20000)):
                process.poll()
            process.kill()
            _, err = process.communicate()
            self.assertNotIn("damaged", err)
            continued += "is continued" in err
        self.assertGreater(continued, 0)
        err = self.end(self.start_render(*SMALL, "--resume"))
        self.assertTrue("is continued" in err or "is finished" in err, err)
        self.assertEqual(self.pixels("a.exr"), whole)
        self.assertEqual([p.name for p in (self.path / "ck").iterdir()], ["frame-0001.checkpoint"])
        self.assertIn("a.exr  is finished, skipped", self.end(self.start_render(*SMALL, "--resume")))

    def test_a_run_with_nothing_to_do_keeps_the_statistics(self):
        arguments = ["-o", "a.exr", "--checkpoint", "ck", "--resume", "--stats", "s.json"]
        self.render(*arguments)
        before = (self.path / "s.json").read_bytes()
        self.render(*arguments)
        self.assertEqual((self.path / "s.json").read_bytes(), before)
        (self.path / "s.json").unlink()
        self.render(*arguments)
        self.assertTrue((self.path / "s.json").exists())

    def test_a_folder_that_cannot_be_read(self):
        (self.path / "circle").symlink_to("circle")
        (self.path / "file").write_text("")
        for name in "circle", "file":
            err = self.render("-o", "a.exr", "--checkpoint", name, "--resume", code=3)[1]
            self.assertRegex(err, f"^{name}: cannot read: ")
            self.assertEqual(err.count("\n"), 1)

    def test_sigterm_leaves_a_checkpoint_and_no_picture(self):
        process = self.start_render(*ENDLESS, "--every", "0.1s")
        self.after_checkpoint(process)
        before = self.inode()
        process.send_signal(signal.SIGTERM)
        self.assertIn(FILE + "  holds ", self.end(process, 143))
        self.assertNotEqual(self.inode(), before)
        self.assertFalse((self.path / "a.exr").exists())

    def test_ctrl_c_leaves_a_checkpoint_and_a_picture(self):
        process = self.start_render(*SMALL, "--every", "0.1s")
        self.after_checkpoint(process)
        process.send_signal(signal.SIGINT)
        if self.end(process, process.wait()) and process.returncode == 130:
            self.assertIn("pelage:partial", self.run_pelage("info", "a.exr")[0])
        self.end(self.start_render(*SMALL, "--resume"))
        self.assertEqual(self.pixels("a.exr"), self.whole(*SMALL))

    def test_sigusr1_makes_a_checkpoint_and_goes_on(self):
        process = self.start_render(*ENDLESS, "--every", "0.1s")
        self.after_checkpoint(process)
        self.end_by(process)
        process = self.start_render(*ENDLESS, "--every", "1h", "--resume")
        for line in process.stderr:
            if "is continued" in line:
                break
        process.send_signal(signal.SIGUSR1)
        for line in process.stderr:
            if FILE + "  saved" in line:
                break
        self.assertIsNone(process.poll())
        self.end_by(process)

    def end_by(self, process):
        process.send_signal(signal.SIGTERM)
        self.end(process, 143)

    def test_gather_continues_too(self):
        gather = [*SMALL, "--set", "render.integrator=gather"]
        process = self.start_render(*gather, "--every", "0.1s")
        self.after_checkpoint(process)
        process.kill()
        process.wait()
        self.end(self.start_render(*gather, "--resume"))
        self.assertEqual(self.pixels("a.exr"), self.whole(*gather))

    def test_each_frame_has_its_own(self):
        frames = ["--frames", "1-3", "--resume"]
        err = self.end(self.start_render(*frames, output="a.%04d.exr"))
        self.assertEqual(err.count("has no state to continue from; the frame starts from the beginning"), 3)
        (self.path / "a.0002.exr").unlink()
        err = self.end(self.start_render(*frames, output="a.%04d.exr"))
        self.assertEqual(err.count("is finished, skipped"), 2)
        self.assertIn("a.0002.exr: missing or changed since it was finished", err)
        self.assertTrue((self.path / "a.0002.exr").exists())

    def test_another_render_is_refused_and_a_damaged_file_is_not(self):
        self.end(self.start_render("--resume"))
        err = self.end(self.start_render("--resume", "--samples", "3"), 3)
        self.assertIn(f"{FILE}: cannot continue this render, because these differ: `render.samples`;", err)
        fewer = {**os.environ, "GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX2,-FMA"}
        _, err = self.start("render", "scene.yaml", "-o", "a.exr", "--checkpoint", "ck", "--resume",
                            env=fewer).communicate()
        if "these differ" in err:  # not on processors without these instructions
            self.assertIn("instructions (x86-64 FMA before, x86-64 now)", err)
        data = (self.path / FILE).read_bytes()
        (self.path / FILE).write_bytes(data[:-9])
        err = self.end(self.start_render("--resume"))
        self.assertIn(FILE + ": damaged cache file: it is truncated; the frame is rendered from the beginning", err)

    def test_a_full_disk_keeps_the_last_checkpoint_and_stops_nothing(self):
        process = self.start_render(*LONGER, "--every", "0.1s")
        self.after_checkpoint(process)
        process.kill()
        process.wait()
        size = (self.path / FILE).stat().st_size
        before = self.inode()
        limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size - 1, size - 1))
        process = self.start_render(*LONGER, "--every", "0.1s", "--resume", preexec_fn=limit)
        warned = False
        for line in process.stderr:
            if FILE + ": cannot write: File too large" in line:
                warned = True
                self.assertEqual(self.inode(), before)
                break
        self.assertTrue(warned)
        self.end(process)
        self.assertEqual(self.pixels("a.exr"), self.whole(*LONGER))

    def test_what_cannot_have_checkpoints_is_refused_at_once(self):
        for setting in ("render.adaptive={noise: 0.05}", "render.time_limit=5"):
            err = self.end(self.start_render("--set", setting), 2)
            self.assertIn("checkpoints do not work with", err)
        (self.path / "ck").write_text("a file")
        self.end(self.start_render(), 1)


if __name__ == "__main__":
    unittest.main()
